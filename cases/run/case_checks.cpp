// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/case_checks.h"

#include "cases/run/earlier_run.h"
#include "cases/tables/displacement_files.h"
#include "slabhull/core/error.h"
#include "slabhull/core/missing_file.h"
#include "slabhull/io/checksum.h"
#include "slabhull/io/formats.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <functional>
#include <numbers>

namespace slabhull {

namespace {

/// Is given the key of a file in the case file, and the file.
using VisitFile = std::function<void(const std::string& key, const std::filesystem::path& file)>;

/// None where the pattern is refused, which is told when its files are read.
std::vector<std::filesystem::path> files_found_by(const std::filesystem::path& pattern) {
    try {
        return pattern.empty() ? std::vector<std::filesystem::path>{} : files_of_pattern(pattern);
    } catch (const UsageError&) {
        return {};
    }
}

/// A motion, or all steps of a sequence, too.
void each_step(const std::string& key, const MotionSpec& motion,
               const std::function<void(const std::string& key, const MotionSpec& step)>& visit) {
    visit(key, motion);
    for (std::size_t k = 0; k < motion.steps.size(); ++k) {
        each_step(fmt::format("{}.steps[{}]", key, k), motion.steps[k], visit);
    }
}

void each_file_of_step(const std::string& key, const MotionSpec& motion, const VisitFile& visit) {
    visit(key + (motion.kind == MotionSpec::Kind::rigid_table ? ".file" : ".table"), motion.table);
    for (std::size_t k = 0; k < motion.displacements.files.size(); ++k) {
        visit(fmt::format("{}.files[{}]", key, k), motion.displacements.files[k]);
    }
    for (const std::filesystem::path& file : files_found_by(motion.displacements.pattern)) {
        visit(key + ".pattern", file);
    }
}

void each_file_of_bodies(const Case& the_case, const InitialBodies& bodies, const VisitFile& visit) {
    const char* list = the_case.dimension == 3 ? "surfaces" : "curves";
    for (std::size_t k = 0; k < bodies.files.size(); ++k) {
        visit(fmt::format("initial.{}[{}].file", list, k), bodies.files[k].file);
    }
    if (const auto* outer = std::get_if<BodyFile>(&bodies.outer)) {
        visit("initial.outer.file", outer->file);
    }
}

/// Some may be empty.
void each_file(const Case& the_case, const VisitFile& visit) {
    if (const auto* mesh = std::get_if<InitialMesh>(&the_case.initial)) {
        visit("initial.mesh", mesh->file);
    } else {
        each_file_of_bodies(the_case, std::get<InitialBodies>(the_case.initial), visit);
    }
    for (const auto& [patch, motion] : the_case.motions) {
        each_step("motion." + patch, motion, [&](const std::string& key, const MotionSpec& step) {
            each_file_of_step(key, step, visit);
        });
    }
    for (const auto& [patch, projection] : the_case.projections) {
        visit(fmt::format("project.{}.file", patch), projection.file);
    }
}

std::string place_of(const Case& the_case, const std::string& key) {
    return (the_case.file.empty() ? "" : the_case.file.string() + ": ") + key;
}

void require_there(const Case& the_case, const std::string& key, const std::filesystem::path& file) {
    std::error_code ignored;
    const bool folder = std::filesystem::is_directory(file, ignored);
    if (std::filesystem::exists(file, ignored) && !folder) {
        return;
    }
    const int why = folder ? EISDIR : ENOENT;
    throw InputError(fmt::format(
        "{}: {}: cannot be read: {}{}{}", place_of(the_case, key), file.string(), std::strerror(why),
        folder ? "" : " (paths in a case file start from its own folder)", look_again(file, why)));
}

/// The run would replace or remove it: under its own name, or as what that links to.
void require_kept(const Case& the_case, const std::string& key, const std::filesystem::path& file) {
    std::error_code ignored;
    for (const std::filesystem::path& path :
         {std::filesystem::absolute(file), std::filesystem::canonical(file, ignored)}) {
        if (is_name_of_run(path.filename().string()) &&
            std::filesystem::equivalent(path.parent_path(), the_case.directory, ignored)) {
            throw UsageError(fmt::format(
                "{}: {}: lies in the folder of the output, {}, where the run replaces or removes files "
                "of this name; copy it elsewhere, or give another folder with --out",
                place_of(the_case, key), file.string(), the_case.directory.string()));
        }
    }
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
}

} // namespace

void require_files(const Case& the_case) {
    each_file(the_case, [&](const std::string& key, const std::filesystem::path& file) {
        if (!file.empty()) {
            require_there(the_case, key, file);
            require_kept(the_case, key, file);
        }
    });
}

std::uint32_t checksum_of_motions(const Case& the_case) {
    io::Checksum sum;
    const auto add = [&sum](std::uint32_t value) { sum.add(&value, sizeof value); };
    const auto add_file = [&add](const std::filesystem::path& file) {
        if (!file.empty()) {
            add(io::checksum_of(file));
        }
    };
    add(the_case.checksum);
    for (const auto& [patch, motion] : the_case.motions) {
        each_step(patch, motion, [&](const std::string&, const MotionSpec& step) { add_file(step.table); });
    }
    for (const auto& [patch, projection] : the_case.projections) {
        add_file(projection.file);
    }
    return sum.value();
}

Case case_in_ranks(Case the_case, int ranks) {
    const auto refuse = [&](const std::string& what) {
        throw UsageError{
            fmt::format("{}{}", the_case.file.empty() ? "" : the_case.file.string() + ": ", what)};
    };
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
        each_step("motion." + patch, motion, [&](const std::string& key, const MotionSpec& step) {
            warn_of_turn(the_case, key, step, listener);
        });
    }
}

} // namespace slabhull
