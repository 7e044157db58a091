# HDF5's C library, the serial one: defines HDF5C::HDF5C. CMake's own module wants a C compiler, also of those who use ours.
include(${CMAKE_CURRENT_LIST_DIR}/SlabhullFindLibrary.cmake)
slabhull_find_library(HDF5C HDF5C::HDF5C HEADER hdf5.h SUFFIXES hdf5/serial NAMES hdf5_serial hdf5)
