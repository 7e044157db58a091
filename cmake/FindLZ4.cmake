# LZ4 as Debian packs it ships no CMake package. Defines LZ4::lz4.
include(${CMAKE_CURRENT_LIST_DIR}/SlabhullFindLibrary.cmake)
slabhull_find_library(LZ4 LZ4::lz4 HEADER lz4.h NAMES lz4)
