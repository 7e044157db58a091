// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/ranks/mpi.h"

#include "slabhull/core/error.h"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>

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

double rank_timeout() {
    constexpr const char* name = "SLABHULL_RANK_TIMEOUT";
    const char* text = std::getenv(name);
    if (text == nullptr) {
        return 600;
    }
    double seconds = 0;
    const char* end = text + std::strlen(text);
    const auto [read, error] = std::from_chars(text, end, seconds);
    if (error != std::errc{} || read != end || !(seconds >= 4)) { // ranks tell each second that they live
        throw UsageError{fmt::format("{}: \"{}\" is not a number of seconds, 4 or more", name, text)};
    }
    return seconds;
}

} // namespace slabhull
