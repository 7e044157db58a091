// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "slabhull/cases/case.h"
#include "slabhull/cases/starting_case.h"
#include "slabhull/core/error.h"
#include "slabhull/io/atomic_file.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <vector>

namespace slabhull::tools {

namespace {

struct NewOptions {
    std::vector<std::string> files;
    std::string out;
};

/// By default the case has the name of the first file, and lies in the present directory.
std::filesystem::path case_path(const NewOptions& options) {
    return options.out.empty()
               ? std::filesystem::path{options.files.front()}.filename().replace_extension(".toml")
               : std::filesystem::path{options.out};
}

int write_new_case(const NewOptions& options) {
    const std::filesystem::path path = case_path(options);
    if (std::filesystem::exists(path)) {
        throw UsageError(fmt::format("{} exists; --out another name, or remove it", path.string()));
    }
    Listener listener;
    listener.warning = [](const std::string& text) { fmt::print(stderr, "slabhull: warning: {}\n", text); };
    const std::filesystem::path directory = path.has_parent_path() ? path.parent_path() : ".";
    const std::string text = starting_case({options.files.begin(), options.files.end()}, directory, listener);
    io::AtomicFile file{path};
    file.write(text);
    file.commit();
    read_case(path); // what is written can be read
    fmt::print("{}: nothing moves yet. Give patches a motion there, then: slabhull build {}\n", path.string(),
               path.string());
    return 0;
}

} // namespace

void add_new(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<NewOptions>();
    CLI::App* command = program.add_subcommand(
        "new", "Write a case file to start with, for a mesh in space, or surfaces or curves");
    command
        ->add_option(
            "FILE", options->files,
            "A spatial mesh; or bodies: closed surfaces (STL, OFF, OBJ, PLY, MSH) or curves (2D). The one "
            "that has all others inside is the outer boundary; without it, they get a box")
        ->required();
    command->add_option("--out", options->out, "The case file; by default FILE.toml here");
    command->footer("Example: slabhull new flange.stl --out flange.toml");
    command->callback([options, &exit_code] { exit_code = write_new_case(*options); });
}

} // namespace slabhull::tools
