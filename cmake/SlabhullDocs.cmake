# The target "docs": pages from the public headers, by Doxygen if it is there. A warning is an error.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
    message(STATUS "Doxygen is not installed: no target \"docs\"")
    return()
endif()
set(doxygen_inputs "${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/bench/README.md ${PROJECT_SOURCE_DIR}/bench/RESULTS.md")
set(doxygen_include_paths)
set(doxygen_rooms core topology geometry io slab edit cases)
foreach(room IN LISTS doxygen_rooms)
    string(APPEND doxygen_inputs " ${PROJECT_SOURCE_DIR}/${room}/include")
    string(APPEND doxygen_include_paths " ${PROJECT_SOURCE_DIR}/${room}/include")
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${PROJECT_BINARY_DIR}/docs/Doxyfile @ONLY)
add_custom_target(docs
    COMMAND ${DOXYGEN_EXECUTABLE} ${PROJECT_BINARY_DIR}/docs/Doxyfile
    COMMENT "Pages of the public headers: ${PROJECT_BINARY_DIR}/docs/html/index.html" VERBATIM)
