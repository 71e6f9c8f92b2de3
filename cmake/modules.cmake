# ax_module(NAME [DEPENDS module...] [LIBRARIES target...]): one folder of src/ as a target of its own. It sees the
# public headers, its own folder and the modules it names, so an include that points up the layers does not compile.
function(ax_module name)
  cmake_parse_arguments(M "" "" "DEPENDS;LIBRARIES;SOURCES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.c)
  add_library(ax_${name} STATIC ${sources} ${M_SOURCES})
  target_include_directories(ax_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  foreach(module IN LISTS M_DEPENDS)
    target_link_libraries(ax_${name} PUBLIC ax_${module})
  endforeach()
  target_link_libraries(ax_${name} PUBLIC ${M_LIBRARIES})
  set_property(GLOBAL APPEND PROPERTY AX_OBJECTS $<TARGET_OBJECTS:ax_${name}>)
endfunction()

# ax_registry(VARIABLE FOLDER TYPE PREFIX): writes a table of every `const TYPE PREFIX<file name>` found in FOLDER, sorted, so
# that adding one file adds one entry and no list is edited. The path of the generated source goes to VARIABLE.
function(ax_registry variable folder type prefix header)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.c)
  list(SORT files)
  set(declarations "")
  set(rows "")
  foreach(file IN LISTS files)
    get_filename_component(stem ${file} NAME_WE)
    string(APPEND declarations "extern const ${type} ${prefix}${stem};\n")
    string(APPEND rows "    &${prefix}${stem},\n")
  endforeach()
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${prefix}registry.c)
  file(CONFIGURE OUTPUT ${output} CONTENT
"// Written by the build from the files in ${folder}.
#include \"${header}\"
@declarations@
static const ${type}* const types[] = {
@rows@};
const ${type}* const* ${type}s(int* count)
{
    *count = (int)(sizeof types / sizeof *types);
    return types;
}
" @ONLY)
  set(${variable} ${output} ${files} PARENT_SCOPE)
endfunction()
