// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/communicator.h"

#include <functional>
#include <optional>

namespace slabhull {

/// Where this process stands among those that mpirun started.
struct StartedRank {
    int rank = 0;
    int size = 1;
    int on_this_machine = 1; ///< how many of them
};

/// What mpirun (of OpenMPI, MPICH or Slurm) says in the environment; empty for a process that it did not
/// start.
std::optional<StartedRank> started_by_mpirun();

/// Whether this build has MPI.
bool has_mpi();

/// Runs `work` with the communicator of this process's rank and returns its result, an exit code, when all
/// ranks have come to the end. `work` returns on all ranks, or throws on all: see together(). A process without an answer from a rank that has not been heard of for `silence` seconds ends
/// all ranks, with a message. Throws UsageError where this build has no MPI.
int run_in_mpi(const std::function<int(Communicator&)>& work, double silence = 600);

} // namespace slabhull
