# TetGen ships no CMake package. Defines TetGen::tet.
include(${CMAKE_CURRENT_LIST_DIR}/SlabhullFindLibrary.cmake)
slabhull_find_library(TetGen TetGen::tet HEADER tetgen.h NAMES tet)
if(TetGen_FOUND)
    set_target_properties(TetGen::tet PROPERTIES INTERFACE_COMPILE_DEFINITIONS TETLIBRARY)
endif()
