// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"
#include "progress_display.h"

#include "slabhull/cases/plan.h"
#include "slabhull/cases/run.h"
#include "slabhull/core/child_process.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/ranks/mpi.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace slabhull::tools {

namespace {

struct BuildOptions {
    std::string case_file;
    std::string directory;
    int threads = 0;
    bool quiet = false;
    bool resume = false;
    bool dry_run = false;
    std::string progress = "auto";
};

Listener listener_with(ProgressDisplay& display) {
    Listener listener;
    listener.warning = [&display](const std::string& text) {
        display.clear();
        fmt::print(stderr, "slabhull: warning: {}\n", text);
    };
    listener.progress = [&display](const RunProgress& run) { display.show(run); };
    return listener;
}

std::string title_or_file(const Case& the_case) {
    return the_case.title.empty() ? the_case.file.string() : the_case.title;
}

/// Says what the run would do.
void print_plan(const Case& the_case, const CasePlan& plan) {
    fmt::print("{}: {}D+t, {} facets on the boundary\n", title_or_file(the_case), the_case.dimension,
               plan.facets);
    for (const PatchPlan& patch : plan.patches) {
        fmt::print("  patch {}: {} facets, {}\n", patch.name, patch.facets,
                   patch.moves ? "moves" : "stands still");
    }
    for (std::size_t k = 0; k < plan.slabs.size(); ++k) {
        const SlabPlan& slab = plan.slabs[k];
        fmt::print("  slab {} from t = {:.9g} to {:.9g}: {} layer{}, {:.0f} simplices on the side\n", k,
                   slab.begin, slab.end, slab.layers, slab.layers == 1 ? "" : "s", slab.side_simplices);
    }
    fmt::print("  caps of about {:.2g} simplices; about {:.2g} GB of memory and {:.2g} s\n",
               plan.cap_simplices, 1e-9 * plan.bytes, plan.seconds);
}

/// Builds, alone or as one of the ranks that mpirun started; the first of them speaks for all.
int build(const BuildOptions& options, Communicator* ranks) {
    const bool first = ranks == nullptr || ranks->first();
    Case the_case = read_case(options.case_file);
    if (!options.directory.empty()) {
        the_case.directory = options.directory;
    }
    ProgressDisplay display{progress_form(options.progress, options.quiet || !first)};
    const Listener listener = listener_with(display);
    if (options.dry_run) {
        if (first) {
            print_plan(the_case, plan_case(the_case, listener));
        }
        return 0;
    }
    const Stopwatch watch;
    const RunResult result = run_case(the_case, listener, {options.resume, ranks});
    display.clear();
    if (!options.quiet && first) {
        fmt::print("{}: {} simplices, {} points, {} slab{}, checked, in {:.1f} s\n", title_or_file(the_case),
                   result.cells, result.points, result.slabs, result.slabs == 1 ? "" : "s", watch.seconds());
        for (const auto& file : result.files) {
            fmt::print("  {}\n", file.string());
        }
    }
    return 0;
}

int build(const BuildOptions& options) {
    start_child_server(); // for meshers, while this process is small and knows nothing of MPI
    set_thread_count(options.threads);
    keep_freed_memory(); // each slab takes what the one before it took
    const std::optional<StartedRank> started = started_by_mpirun();
    if (!started) {
        return build(options, nullptr);
    }
    if (options.threads == 0) {
        set_thread_count(std::max(1, thread_count() / started->on_this_machine));
    }
    // The first rank tells of an error while the others are still there: where one ends with an error, mpirun
    // ends all.
    return run_in_mpi(
        [&options](Communicator& ranks) {
            return exit_code_of([&] { return together(ranks, [&] { return build(options, &ranks); }); });
        },
        rank_timeout());
}

/// Where a page of the documentation is: installed beside this program, or in the repository.
std::string page_of_docs(const std::string& name) {
    std::error_code none;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", none);
    const auto installed = program.parent_path().parent_path() / "share/doc/slabhull/docs" / name;
    return std::filesystem::exists(installed, none) ? installed.string() : "docs/" + name;
}

} // namespace

void add_build(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<BuildOptions>();
    CLI::App* command = program.add_subcommand("build", "Run a case: one or more slabs");
    command
        ->add_option("CASE.toml", options->case_file, "The case file (" + page_of_docs("case-file.md") + ")")
        ->required();
    command->add_option("--out", options->directory, "Directory for the output, instead of the case's own");
    command
        ->add_option("--threads", options->threads,
                     "Threads to use; 0 for all cores. The output does not depend on it")
        ->check(CLI::Range(0, 1024));
    command->add_flag(
        "--resume", options->resume,
        "Go on after the last slab that an interrupted run finished, as if nothing had happened");
    command->add_flag(
        "--dry-run", options->dry_run,
        "Read everything and mesh nothing: say what the run would do, with layers, simplices, memory "
        "and time");
    add_progress_option(*command, options->progress);
    command->add_flag("--quiet", options->quiet, "Print warnings and errors only");
    command->footer("Example: slabhull build examples/ellipsoid.toml --out out/ellipsoid");
    command->callback([options, &exit_code] { exit_code = build(*options); });
}

} // namespace slabhull::tools
