// SPDX-License-Identifier: BSD-3-Clause
// Each hull is built in a process of its own, one after the other, so that peak memory is that of one level.
#include "commands.h"
#include "progress_display.h"

#include "slabhull/core/child_process.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "slabhull/io/atomic_file.h"
#include "slabhull/io/folder_lock.h"
#include "slabhull/study/study.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <system_error>

namespace slabhull::tools {

namespace {

struct StudyOptions {
    std::string experiment;
    std::string levels = "1-4";
    std::string directory;
    std::string splits;
    int threads = 0;
    std::string progress = "auto";
    bool hulls = false;
    bool quiet = false;
};

struct LevelRange {
    int first;
    int last;
};

LevelRange parsed_levels(const std::string& text) {
    const auto number = [&text](const std::string& part) {
        int value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc{} || end != part.data() + part.size() || value < 1) {
            throw UsageError(
                fmt::format("--levels: expected a level such as 3, or the first and the last such as "
                            "1-4, not \"{}\"",
                            text));
        }
        return value;
    };
    const std::size_t dash = text.find('-');
    const LevelRange range{number(text.substr(0, dash)),
                           number(dash == std::string::npos ? text : text.substr(dash + 1))};
    if (range.first > range.last) {
        throw UsageError(fmt::format("--levels: the first level of \"{}\" is after the last", text));
    }
    return range;
}

std::vector<Split> parsed_splits(const std::string& text, const Case& the_case) {
    if (text.empty()) {
        return {the_case.split};
    }
    if (text == "all") {
        return the_case.dimension == 2 ? std::vector{Split::centre, Split::diagonal}
                                       : std::vector{Split::A, Split::B, Split::C, Split::D, Split::E};
    }
    std::vector<Split> splits;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        splits.push_back(split_from_name(text.substr(begin, end - begin), the_case.dimension));
        begin = end + 1;
    }
    return splits;
}

/// The cases of one experiment: split by split, level by level. For "all", levels that do not exist are left
/// out.
void add_cases(std::vector<Case>& cases, const std::string& name, LevelRange levels,
               const StudyOptions& options) {
    if (options.experiment == "all") {
        levels.last = std::min(levels.last, static_cast<int>(experiment_levels(name).size()));
    }
    for (const Split split : parsed_splits(options.splits, experiment_case(name, levels.first))) {
        for (int level = levels.first; level <= levels.last; ++level) {
            cases.push_back(experiment_case(name, level));
            cases.back().split = split;
        }
    }
}

std::vector<Case> cases_of(const StudyOptions& options) {
    const LevelRange levels = parsed_levels(options.levels);
    std::vector<Case> cases;
    if (options.experiment == "all") {
        for (const std::string& name : experiment_names()) {
            add_cases(cases, name, levels, options);
        }
    } else {
        add_cases(cases, options.experiment, levels, options);
    }
    return cases;
}

// --- A level in a process of its own --------------------------------------------------------------

/// Forks: this process has started no threads, so the child may start its own.
ChildAnswer in_child(const std::function<std::string()>& job) {
    std::fflush(nullptr); // or the child would have it, too
    try {
        return ask_child(job);
    } catch (const std::system_error& error) {
        throw GeometryError(fmt::format("cannot start a process for a level: {}", error.what()));
    }
}

/// Removes what a process that was ended, or earlier runs, left beside a hull's file.
void remove_parts(const std::optional<std::filesystem::path>& hull_file) {
    if (hull_file) {
        io::remove_stale_parts(hull_file->parent_path());
    }
}

std::string name_of(const Case& the_case) {
    return fmt::format("{}, level {}, split {}", the_case.experiment, the_case.level,
                       split_name(the_case.split));
}

StudyRow study_alone(const Case& the_case, const std::optional<std::filesystem::path>& hull_file) {
    remove_parts(hull_file);
    ChildAnswer answer;
    try {
        answer = in_child([&] { return row_as_text(study_level(the_case, hull_file)); });
    } catch (const Interrupted&) {
        remove_parts(hull_file);
        throw;
    }
    const std::string where = name_of(the_case);
    if (answer.end.signal != 0) {
        remove_parts(hull_file);
        throw GeometryError(
            fmt::format("{}: its process was ended by signal {}; if memory was short, --levels with "
                        "a lower last one helps",
                        where, answer.end.signal));
    }
    if (answer.end.exit_code != 0) {
        throw Error(static_cast<Failure>(answer.end.exit_code), fmt::format("{}: {}", where, answer.text));
    }
    return row_from_text(answer.text);
}

// --- Files ------------------------------------------------------------------------------------------

void write_text(const std::filesystem::path& path, const std::string& text) {
    io::AtomicFile file{path};
    file.write(text);
    file.commit();
}

void write_study(const std::filesystem::path& directory, const std::vector<StudyRow>& rows) {
    write_text(directory / "study.csv", study_csv(rows));
    write_text(directory / "study.json", study_json(rows));
    write_text(directory / "study.html", study_page(rows));
}

void write_figures(const std::filesystem::path& directory, const std::vector<StudyRow>& rows) {
    io::make_folder(directory);
    for (const StudyFigure& figure : study_figures(rows)) {
        write_text(directory / (figure.name + ".svg"), figure.svg);
    }
}

std::optional<std::filesystem::path> hull_path(const StudyOptions& options, const Case& the_case) {
    if (!options.hulls) {
        return std::nullopt;
    }
    return std::filesystem::path{options.directory} /
           fmt::format("{}-{}-{}.vtu", the_case.experiment, split_name(the_case.split), the_case.level);
}

void print_row(const StudyRow& row) {
    const auto share = [](std::size_t ours, std::size_t paper) {
        return static_cast<double>(ours) / static_cast<double>(paper);
    };
    fmt::print(
        "{} level {} split {}: {} simplices ({:.3f} of the paper's), {} vertices ({:.3f}), error of the hull "
        "{:+.2e}, {:.1f} s, {:.0f} MB\n",
        row.experiment, row.level, row.split, row.counts.cells, share(row.counts.cells, row.paper.cells),
        row.counts.vertices, share(row.counts.vertices, row.paper.vertices), row.error(0),
        row.total_seconds(), 1e-6 * static_cast<double>(row.peak()));
    std::fflush(stdout);
}

void print_orders(const std::vector<StudyRow>& rows) {
    for (const StudySeries& series : series_of(rows)) {
        if (series.size() < 2) {
            continue;
        }
        fmt::print("{} split {}: orders", series.front().experiment, series.front().split);
        for (std::size_t m = 0; m < study_measures.size(); ++m) {
            const auto order = order_of(series, m);
            fmt::print(" {} {}", study_measures[m], order ? fmt::format("{:.2f}", *order) : "-");
        }
        fmt::print("\n");
    }
}

int study(const StudyOptions& options) {
    set_thread_count(options.threads);
    const std::vector<Case> cases =
        cases_of(options); // all arguments are looked at before anything is written
    const std::filesystem::path directory = options.directory;
    io::make_folder(directory);
    const io::FolderLock lock{directory};
    ProgressDisplay display{progress_form(options.progress, options.quiet)};
    const ProgressScope shown{display.for_work()};
    std::vector<StudyRow> rows;
    for (const Case& the_case : cases) {
        enter_stage(name_of(the_case), cases.size());
        work_done(rows.size());
        rows.push_back(study_alone(the_case, hull_path(options, the_case)));
        write_study(directory, rows); // a study that is broken off leaves what it has
        display.clear();
        if (!options.quiet) {
            print_row(rows.back());
        }
    }
    write_figures(directory / "plots", rows);
    if (!options.quiet) {
        print_orders(rows);
        fmt::print("  {}\n", (directory / "study.html").string());
    }
    return 0;
}

} // namespace

void add_study(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<StudyOptions>();
    CLI::App* command =
        program.add_subcommand("study", "Build the paper's experiments, and compare counts and measures");
    command
        ->add_option(
            "CASE", options->experiment,
            "circle, expanding-circle, sphere, expanding-sphere, ellipsoid, tandem-ellipsoids, or all")
        ->required();
    command->add_option("--levels", options->levels, "A level, or the first and the last (default: 1-4)");
    command
        ->add_option("--out", options->directory, "Directory for study.html, study.csv, study.json and plots")
        ->required();
    command->add_option("--split", options->splits,
                        "Splits to compare, such as C or A,C,E, or all; by default E (2D: centre)");
    add_progress_option(*command, options->progress);
    command->add_option("--threads", options->threads, "Threads to use; 0 for all cores")
        ->check(CLI::Range(0, 1024));
    command->add_flag("--hulls", options->hulls, "Write the hulls, too, as VTU");
    command->add_flag("--quiet", options->quiet, "Print warnings and errors only");
    command->footer("Example: slabhull study ellipsoid --levels 1-3 --out out/study");
    command->callback([options, &exit_code] { exit_code = study(*options); });
}

} // namespace slabhull::tools
