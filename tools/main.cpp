// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "slabhull/cases/run.h"
#include "slabhull/core/error.h"
#include "slabhull/core/progress.h"
#include "slabhull/ranks/mpi.h"

#include <atomic>
#include <csignal>
#include <fmt/format.h>
#include <new>

namespace {

constexpr int wrong_usage = static_cast<int>(slabhull::Failure::usage);
constexpr int failed = static_cast<int>(slabhull::Failure::geometry);

/// Of the processes that mpirun starts, the first speaks for all.
bool speaks() {
    return slabhull::started_by_mpirun().value_or(slabhull::StartedRank{}).rank == 0;
}

int complain(const std::string& text, int exit_code) {
    if (speaks()) {
        fmt::print(stderr, "slabhull: {}\n", text);
    }
    return exit_code;
}

/// Other subcommands would do the same work, and write the same files, as often as there are ranks.
void require_one_process(const CLI::App& program) {
    const auto started = slabhull::started_by_mpirun();
    if (started && started->size > 1 && !program.got_subcommand("build")) {
        throw slabhull::UsageError{
            "of the subcommands, only build works in ranks: run this one without mpirun"};
    }
}

std::atomic<int> stop_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler writes it");

/// The first one asks for an orderly end, within a second; the next one ends the process at once.
void ask_to_stop(int number) {
    if (stop_signal.exchange(number) != 0) {
        std::signal(number, SIG_DFL);
        std::raise(number);
    }
}

/// Not where the signal is ignored already, as nohup and shells in the background do.
void answer_signal(int number) {
    struct sigaction present {};
    if (sigaction(number, nullptr, &present) == 0 && present.sa_handler != SIG_IGN) {
        struct sigaction action {};
        action.sa_handler = ask_to_stop;
        sigemptyset(&action.sa_mask);
        sigaction(number, &action, nullptr);
    }
}

} // namespace

int slabhull::tools::exit_code_of(const std::function<int()>& work) {
    try {
        return work();
    } catch (const slabhull::Interrupted&) {
        constexpr int by_signal = 128;
        return complain(
            "interrupted; no file is half-written. build --resume goes on after the last whole slab",
            by_signal + (stop_signal != 0 ? stop_signal.load() : SIGTERM)); // or another rank was told
    } catch (const slabhull::Error& error) {
        return complain(error.what(), static_cast<int>(error.failure()));
    } catch (const std::bad_alloc&) {
        return complain("out of memory; a coarser mesh, fewer layers or more memory would help", failed);
    } catch (const std::exception& error) {
        return complain(error.what(), failed);
    }
}

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN); // a file size limit becomes an error message, like a full disk
    answer_signal(SIGINT);
    answer_signal(SIGTERM);
    const slabhull::ProgressScope scope{[](const slabhull::WorkState&) { return stop_signal == 0; }};
    CLI::App program{"Space-time hulls of moving domains: closed, conforming, checked"};
    program.set_version_flag("--version", slabhull::version());
    program.require_subcommand(1);
    int exit_code = 0;
    slabhull::tools::add_build(program, exit_code);
    slabhull::tools::add_check(program, exit_code);
    slabhull::tools::add_convert(program, exit_code);
    slabhull::tools::add_fill(program, exit_code);
    slabhull::tools::add_info(program, exit_code);
    slabhull::tools::add_new(program, exit_code);
    slabhull::tools::add_slice(program, exit_code);
    slabhull::tools::add_study(program, exit_code);
    slabhull::tools::add_view(program, exit_code);
    program.parse_complete_callback([&program] { require_one_process(program); });
    return slabhull::tools::exit_code_of([&] {
        try {
            program.parse(argc, argv);
            return exit_code;
        } catch (const CLI::Success& wish) { // --help, --version
            return program.exit(wish);
        } catch (const CLI::ParseError& error) {
            return complain(slabhull::tools::usage_fault(program, error), wrong_usage);
        }
    });
}
