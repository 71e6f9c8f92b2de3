# ax_page(VARIABLE FOLDER): builds the studio's page with npm whenever its sources change, and puts its files into the program. The
# path of the generated source goes to VARIABLE. Without npm the program is whole but for the page, and says so when asked for it.
function(ax_page variable folder)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/page.c)
  find_program(NPM npm)
  if(NPM)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/src/* ${folder}/public/*)
    list(APPEND sources ${folder}/index.html ${folder}/vite.config.ts ${folder}/tsconfig.json ${folder}/package-lock.json)
    set(page ${PROJECT_SOURCE_DIR}/build/page)
    set(build COMMAND ${PROJECT_SOURCE_DIR}/tools/build_page.sh)
  else()
    message(STATUS "The studio's page is left out: npm is missing")
    set(page ${CMAKE_CURRENT_BINARY_DIR}/page)
  endif()
  add_custom_command(OUTPUT ${output} ${build}
    COMMAND ${CMAKE_COMMAND} -DPAGE=${page} -DOUTPUT=${output} -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${sources} ${PROJECT_SOURCE_DIR}/tools/build_page.sh ${PROJECT_SOURCE_DIR}/cmake/embed.cmake VERBATIM)
  set(${variable} ${output} PARENT_SCOPE)
endfunction()
