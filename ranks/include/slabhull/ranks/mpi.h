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

/// Seconds after which a silent rank counts as dead: SLABHULL_RANK_TIMEOUT of the environment, else 600.
/// Throws UsageError for what is not a number of at least 4.
double rank_timeout();

/// Runs `work` with the communicator of this process's rank and returns its result, an exit code, when all
/// ranks have come to the end. `work` returns on all ranks, or throws on all: see together(). A process that
/// waits for a rank which has not been heard of for `timeout` seconds ends all ranks, with a message. Throws
/// UsageError where this build has no MPI.
int run_in_mpi(const std::function<int(Communicator&)>& work, double timeout);

} // namespace slabhull
