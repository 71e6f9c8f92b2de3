# cmake --install build/release: the command, its reader of meshes, the examples, and the library with its headers for other programs, which find
# it by pkg-config or find_package(auxshell).
include(CMakePackageConfigHelpers)

get_property(objects GLOBAL PROPERTY AX_OBJECTS)
add_library(auxshell_archive STATIC ${objects})
set_target_properties(auxshell_archive PROPERTIES OUTPUT_NAME auxshell)

# What the archive's users link besides, and what knows where that is.
set(packages cairo expat jansson libpng libwebsockets minizip sqlite3 zlib)
set(libraries -lcholmod -pthread -ldl -lm)
list(JOIN packages " " AX_PACKAGES)
list(JOIN libraries " " AX_LIBRARIES)
file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" AX_PREFIX_FROM_PC "${up}")
configure_file(${PROJECT_SOURCE_DIR}/cmake/auxshell.pc.in ${PROJECT_BINARY_DIR}/auxshell.pc @ONLY)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/auxshell)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/auxshell-config.cmake.in ${PROJECT_BINARY_DIR}/auxshell-config.cmake
                              INSTALL_DESTINATION ${package} PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/auxshell-config-version.cmake COMPATIBILITY SameMinorVersion)

install(TARGETS auxshell_command auxshell_read_mesh RUNTIME)
install(TARGETS auxshell_archive ARCHIVE)
install(DIRECTORY include/ax TYPE INCLUDE)
install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/auxshell/examples REGEX "examples/CMakeLists.txt$" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/auxshell.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_BINARY_DIR}/auxshell-config.cmake ${PROJECT_BINARY_DIR}/auxshell-config-version.cmake
        DESTINATION ${package})
