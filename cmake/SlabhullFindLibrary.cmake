# slabhull_find_library(<package> <target> HEADER <file> NAMES <names of the library> [SUFFIXES <folders of the header>])
# The whole of a find module for one library with headers: defines <target>.
include(FindPackageHandleStandardArgs)
function(slabhull_find_library package target)
    cmake_parse_arguments(PARSE_ARGV 2 find "" "HEADER" "NAMES;SUFFIXES")
    find_path(${package}_INCLUDE_DIR ${find_HEADER} PATH_SUFFIXES ${find_SUFFIXES})
    find_library(${package}_LIBRARY NAMES ${find_NAMES})
    find_package_handle_standard_args(${package} REQUIRED_VARS ${package}_LIBRARY ${package}_INCLUDE_DIR)
    set(${package}_FOUND ${${package}_FOUND} PARENT_SCOPE)
    if(${package}_FOUND AND NOT TARGET ${target})
        add_library(${target} UNKNOWN IMPORTED)
        set_target_properties(${target} PROPERTIES
            IMPORTED_LOCATION ${${package}_LIBRARY}
            INTERFACE_INCLUDE_DIRECTORIES ${${package}_INCLUDE_DIR})
    endif()
endfunction()
