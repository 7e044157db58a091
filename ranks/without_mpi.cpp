// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/ranks/mpi.h"

#include "slabhull/core/error.h"

namespace slabhull {

bool has_mpi() {
    return false;
}

int run_in_mpi(const std::function<int(Communicator&)>&, double) {
    throw UsageError{
        "this build has no MPI: install libopenmpi-dev and configure again with SLABHULL_MPI=ON; or "
        "run without mpirun, on one machine"};
}

} // namespace slabhull
