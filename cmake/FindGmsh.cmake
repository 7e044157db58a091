# Gmsh as Debian packs it ships no CMake package. Defines Gmsh_INCLUDE_DIR and Gmsh_SONAME, what the library is called
# at run time: it is opened when a cap is to be meshed with it, not linked, for it brings ninety others along.
find_path(Gmsh_INCLUDE_DIR gmshc.h)
find_library(Gmsh_LIBRARY gmsh)
if(Gmsh_LIBRARY)
    get_filename_component(Gmsh_real_file ${Gmsh_LIBRARY} REALPATH)
    get_filename_component(Gmsh_real_name ${Gmsh_real_file} NAME)
    # libgmsh.so.4.8.4 has the soname libgmsh.so.4.8
    string(REGEX REPLACE "^(libgmsh\\.so\\.[0-9]+\\.[0-9]+).*" "\\1" Gmsh_SONAME ${Gmsh_real_name})
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Gmsh REQUIRED_VARS Gmsh_SONAME Gmsh_INCLUDE_DIR)
