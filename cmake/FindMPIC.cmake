# MPI's C library: defines MPIC::MPIC. CMake's own module asks a compiler's wrapper, and stops where that is there but the headers
# are not, as with openmpi-bin alone.
include(${CMAKE_CURRENT_LIST_DIR}/SlabhullFindLibrary.cmake)
slabhull_find_library(MPIC MPIC::MPIC HEADER mpi.h SUFFIXES mpi openmpi mpich NAMES mpi mpich)
