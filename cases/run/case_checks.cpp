// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/case_checks.h"

#include "cases/run/earlier_run.h"
#include "cases/tables/displacement_files.h"
#include "slabhull/core/error.h"
#include "slabhull/core/missing_file.h"
#include "slabhull/io/formats.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <numbers>
#include <vector>

namespace slabhull {

namespace {

using FileVisitor = std::function<void(const std::string& key, const std::filesystem::path& file)>;

/// A pattern that no file has is told when its files are read.
std::vector<std::filesystem::path> files_of(const DisplacementSpec& spec) {
    if (spec.pattern.empty()) {
        return spec.files;
    }
    try {
        return files_of_pattern(spec.pattern);
    } catch (const UsageError&) {
        return {};
    }
}

void visit_files(const std::string& key, const MotionSpec& motion, const FileVisitor& visit) {
    visit(key + (motion.kind == MotionSpec::Kind::rigid_table ? ".file" : ".table"), motion.table);
    const bool by_pattern = !motion.displacements.pattern.empty();
    const std::vector<std::filesystem::path> displacements = files_of(motion.displacements);
    for (std::size_t k = 0; k < displacements.size(); ++k) {
        visit(by_pattern ? key + ".pattern" : fmt::format("{}.files[{}]", key, k), displacements[k]);
    }
    for (std::size_t k = 0; k < motion.steps.size(); ++k) {
        visit_files(fmt::format("{}.steps[{}]", key, k), motion.steps[k], visit);
    }
}

void visit_files(const Case& the_case, const InitialBodies& bodies, const FileVisitor& visit) {
    const char* list = the_case.dimension == 3 ? "surfaces" : "curves";
    for (std::size_t k = 0; k < bodies.files.size(); ++k) {
        visit(fmt::format("initial.{}[{}].file", list, k), bodies.files[k].file);
    }
    if (const auto* outer = std::get_if<BodyFile>(&bodies.outer)) {
        visit("initial.outer.file", outer->file);
    }
}

/// All files that the case names, with their keys; paths are empty where a key is not given.
void visit_files(const Case& the_case, const FileVisitor& visit) {
    if (const auto* mesh = std::get_if<InitialMesh>(&the_case.initial)) {
        visit("initial.mesh", mesh->file);
    } else {
        visit_files(the_case, std::get<InitialBodies>(the_case.initial), visit);
    }
    for (const auto& [patch, motion] : the_case.motions) {
        visit_files("motion." + patch, motion, visit);
    }
    for (const auto& [patch, projection] : the_case.projections) {
        visit(fmt::format("project.{}.file", patch), projection.file);
    }
}

std::string in_case(const Case& the_case) {
    return the_case.file.empty() ? "" : the_case.file.string() + ": ";
}

/// `key` is the file's key in the case file.
void require_file(const Case& the_case, const std::string& key, const std::filesystem::path& file) {
    std::error_code ignored;
    const bool folder = std::filesystem::is_directory(file, ignored);
    if (file.empty() || (std::filesystem::exists(file, ignored) && !folder)) {
        return;
    }
    const int why = folder ? EISDIR : ENOENT;
    throw InputError(fmt::format(
        "{}{}: {}: cannot be read: {}{}{}", in_case(the_case), key, file.string(), std::strerror(why),
        folder ? "" : " (paths in a case file start from its own folder)", look_again(file, why)));
}

/// Files of the output folder that a run would write over or remove.
std::vector<std::filesystem::path> files_of_run(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator{folder, ignored}) {
        if (is_file_of_run(entry.path().filename().string())) {
            files.push_back(entry.path());
        }
    }
    return files;
}

/// The longest that a layer lasts: the whole slab, where layers follow from the motion.
double longest_layer(const Case& the_case) {
    const double slab = (the_case.end - the_case.start) / the_case.slabs;
    return the_case.layers    ? slab / *the_case.layers
           : the_case.spacing ? std::min(slab, *the_case.spacing)
                              : slab;
}

void warn_of_turn(const Case& the_case, const std::string& key, const MotionSpec& motion,
                  const Listener& listener) {
    const bool follows = the_case.layers_follow_motion();
    const double layer = longest_layer(the_case);
    const double turns = std::abs(motion.rate) * layer / (2 * std::numbers::pi);
    // With layers by the motion, several turns in a slab are as good as one; so only what looks like degrees
    // is told.
    const bool like_degrees = std::fmod(motion.rate, 15) == 0;
    if (motion.kind == MotionSpec::Kind::rotation && (follows ? like_degrees && turns > 2 : turns > 0.5)) {
        listener.warning(
            fmt::format("{}.rate: {} radians per unit of time are {:.3g} turns in {} from t = {} to {}; if "
                        "degrees were meant, give {:.6g}",
                        key, motion.rate, turns, follows ? "the slab" : "the layer", the_case.start,
                        the_case.start + layer, motion.rate * std::numbers::pi / 180));
    }
    for (std::size_t k = 0; k < motion.steps.size(); ++k) {
        warn_of_turn(the_case, fmt::format("{}.steps[{}]", key, k), motion.steps[k], listener);
    }
}

} // namespace

void require_files(const Case& the_case) {
    visit_files(the_case, [&](const std::string& key, const std::filesystem::path& file) {
        require_file(the_case, key, file);
    });
    const std::vector<std::filesystem::path> written = files_of_run(the_case.directory);
    visit_files(the_case, [&](const std::string& key, const std::filesystem::path& file) {
        std::error_code ignored;
        if (std::any_of(written.begin(), written.end(), [&](const std::filesystem::path& output) {
                return std::filesystem::equivalent(output, file, ignored);
            })) {
            throw UsageError(fmt::format("{}{}: {}: the run would write over it; give another folder "
                                         "(output.directory, --out), or copy the file elsewhere",
                                         in_case(the_case), key, file.string()));
        }
    });
}

Case case_in_ranks(Case the_case, int ranks) {
    const auto refuse = [&](const std::string& what) { throw UsageError{in_case(the_case) + what}; };
    if (the_case.cap_reuse == CapReuse::adapt) {
        refuse("cap.reuse: \"adapt\" does not work in ranks yet: \"move\" does, or run without mpirun");
    }
    for (const std::string& format : the_case.formats) {
        if (io::format_named(format)->write_piece == nullptr) {
            refuse(fmt::format("output.formats: \"{}\" is one file, and ranks write one each: \"pvtu\" and "
                               "\"msh\" are in pieces. Set formats = [\"pvtu\"] under [output]",
                               format));
        }
        io::WriteOptions& writing = the_case.writing[format];
        if (writing.pieces != 0 && writing.pieces != static_cast<std::size_t>(ranks)) {
            refuse(
                fmt::format("output.pieces: there are {} ranks, and each writes a piece: leave out the {}, "
                            "or start as many",
                            ranks, writing.pieces));
        }
        writing.pieces = static_cast<std::size_t>(ranks);
        io::require_supported(*io::format_named(format), writing, "output." + format + ".");
    }
    if (the_case.dimension == 3 && the_case.cap_blocks == 0) {
        the_case.cap_blocks = ranks;
    }
    return the_case;
}

void warn_of_turns(const Case& the_case, const Listener& listener) {
    for (const auto& [patch, motion] : the_case.motions) {
        warn_of_turn(the_case, "motion." + patch, motion, listener);
    }
}

} // namespace slabhull
