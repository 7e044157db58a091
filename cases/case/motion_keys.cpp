// SPDX-License-Identifier: BSD-3-Clause
#include "cases/case/motion_keys.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace slabhull {

namespace {

using Kind = MotionSpec::Kind;

void read_rotation(KeyTable& table, const PatchKeysContext& context, MotionSpec& motion) {
    if (context.dimension == 3) {
        motion.axis = table.direction("axis", 3);
    }
    motion.centre = table.numbers("centre", context.dimension);
    if (table.has("table")) {
        motion.table = context.directory / table.text("table");
        if (table.has("rate")) {
            table.fail("table", "one of \"rate\" and \"table\"");
        }
    } else {
        motion.rate = table.number("rate");
    }
}

void read_translation(KeyTable& table, const PatchKeysContext& context, MotionSpec& motion) {
    motion.velocity = table.numbers("velocity", context.dimension);
}

void read_expansion(KeyTable& table, const PatchKeysContext& context, MotionSpec& motion) {
    motion.centre = table.numbers("centre", context.dimension);
    motion.rate = table.number("rate");
    if (1 + motion.rate * context.duration <= 0) {
        table.fail("rate", "a rate that keeps 1 + rate (end - start) positive");
    }
}

void read_velocity(KeyTable& table, const PatchKeysContext& context, MotionSpec& motion) {
    motion.formula = table.texts("formula", context.dimension);
    motion.constants = table.optional_constants("constants");
}

void read_rigid_table(KeyTable& table, const PatchKeysContext& context, MotionSpec& motion) {
    motion.table = context.directory / table.text("file");
    motion.centre = table.numbers("centre", context.dimension);
}

std::vector<std::filesystem::path> files_in(const std::vector<std::string>& names,
                                            const std::filesystem::path& directory) {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) {
        files.push_back(directory / name);
    }
    return files;
}

void read_times(KeyTable& table, DisplacementSpec& displacements) {
    displacements.times = table.numbers("times", -1);
    const auto& times = displacements.times;
    if (times.empty() ||
        std::adjacent_find(times.begin(), times.end(), std::greater_equal{}) != times.end()) {
        table.fail("times", "a list of times that ascend");
    }
    if (!displacements.files.empty() && times.size() != displacements.files.size()) {
        table.fail("times", fmt::format("{} times, one for each file, not {}", displacements.files.size(),
                                        times.size()));
    }
}

void read_displacement_series(KeyTable& table, const PatchKeysContext& context, MotionSpec& motion) {
    DisplacementSpec& displacements = motion.displacements;
    if (table.has("files") == table.has("pattern")) {
        table.fail(table.has("files") ? "pattern" : "files", "exactly one of \"files\" and \"pattern\"");
    }
    if (table.has("files")) {
        displacements.files = files_in(table.texts("files", -1), context.directory);
        if (displacements.files.empty()) {
            table.fail("files", "a list of file names");
        }
    } else {
        displacements.pattern = context.directory / table.text("pattern");
    }
    if (table.has("times")) {
        read_times(table, displacements);
    }
    displacements.array = table.optional_text("array").value_or(displacements.array);
    if (table.has("tolerance")) {
        displacements.tolerance = table.positive("tolerance");
    }
    if (table.has("interpolation")) {
        displacements.interpolation = table.choice<TimeInterpolation>(
            "interpolation", {{"linear", TimeInterpolation::linear}, {"cubic", TimeInterpolation::cubic}});
    }
}

void read_stretch(KeyTable&, const PatchKeysContext&, MotionSpec&) {} // no keys: it follows its neighbours

void read_sequence(KeyTable& table, const PatchKeysContext& context, MotionSpec& motion) {
    for (KeyTable& step : table.optional_tables("steps")) {
        motion.steps.push_back(read_motion(step, context));
        if (!motion.steps.back().is_field()) {
            step.fail("kind",
                      "a motion of space: a step of a sequence can neither be a displacement-series nor "
                      "a stretch");
        }
    }
    if (motion.steps.empty()) {
        table.fail("steps", "a list of tables, one for each motion, the inner first");
    }
}

/// A kind of motion and the function that reads its keys.
struct MotionKind {
    Kind kind;
    void (*read_keys)(KeyTable& table, const PatchKeysContext& context, MotionSpec& motion);
};

const std::map<std::string, MotionKind>& motion_kinds() {
    static const std::map<std::string, MotionKind> kinds{
        {"rotation", {Kind::rotation, read_rotation}},
        {"translation", {Kind::translation, read_translation}},
        {"expansion", {Kind::expansion, read_expansion}},
        {"velocity", {Kind::velocity, read_velocity}},
        {"rigid-table", {Kind::rigid_table, read_rigid_table}},
        {"sequence", {Kind::sequence, read_sequence}},
        {"displacement-series", {Kind::displacement_series, read_displacement_series}},
        {"stretch", {Kind::stretch, read_stretch}},
    };
    return kinds;
}

} // namespace

MotionSpec read_motion(KeyTable table, const PatchKeysContext& context) {
    const auto [kind, read_keys] = table.choice("kind", motion_kinds());
    MotionSpec motion;
    motion.kind = kind;
    read_keys(table, context, motion);
    table.require_all_known();
    return motion;
}

ProjectionSpec read_projection(KeyTable table, const PatchKeysContext& context) {
    using Kind = ProjectionSpec::Kind;
    const bool solid = context.dimension == 3;
    ProjectionSpec spec;
    const std::string ball = solid ? "sphere" : "circle";
    const std::string egg = solid ? "ellipsoid" : "ellipse";
    std::map<std::string, Kind> kinds{
        {ball, Kind::sphere}, {egg, Kind::ellipsoid}, {"plane", Kind::plane}, {"file", Kind::file}};
    if (solid) {
        kinds["cylinder"] = Kind::cylinder;
    }
    spec.kind = table.choice<Kind>("surface", kinds);
    if (spec.kind == Kind::file) {
        spec.file = context.directory / table.text("file");
        table.require_all_known();
        return spec;
    }
    spec.centre = table.numbers(spec.kind == Kind::plane ? "point" : "centre", context.dimension);
    switch (spec.kind) {
    case Kind::sphere:
        spec.semi_axes.assign(static_cast<std::size_t>(context.dimension), table.positive("radius"));
        break;
    case Kind::ellipsoid:
        spec.semi_axes = table.positives("semi_axes", context.dimension);
        break;
    case Kind::cylinder:
        spec.direction = table.direction("axis", 3);
        spec.radius = table.positive("radius");
        break;
    case Kind::plane:
        spec.direction = table.direction("normal", context.dimension);
        break;
    case Kind::file:
        break; // read above
    }
    table.require_all_known();
    return spec;
}

} // namespace slabhull
