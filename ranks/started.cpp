// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/ranks/mpi.h"

#include <charconv>
#include <cstdlib>
#include <cstring>

namespace slabhull {

namespace {

std::optional<int> number_in_environment(const char* name) {
    const char* text = std::getenv(name);
    int number = 0;
    if (text == nullptr || std::from_chars(text, text + std::strlen(text), number).ec != std::errc{}) {
        return std::nullopt;
    }
    return number;
}

} // namespace

std::optional<StartedRank> started_by_mpirun() {
    // OpenMPI; Hydra of MPICH and Intel, and Slurm with PMI.
    constexpr const char* names[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                        {"PMI_RANK", "PMI_SIZE"}};
    constexpr const char* local_names[] = {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"};
    for (const auto& [rank, size] : names) {
        const std::optional<int> mine = number_in_environment(rank);
        const std::optional<int> all = number_in_environment(size);
        if (mine && all && *all > 0 && *mine >= 0 && *mine < *all) {
            StartedRank started{*mine, *all, *all};
            for (const char* name : local_names) {
                started.on_this_machine = number_in_environment(name).value_or(started.on_this_machine);
            }
            return started;
        }
    }
    return std::nullopt;
}

} // namespace slabhull
