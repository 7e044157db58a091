// SPDX-License-Identifier: BSD-3-Clause
// The six experiments of Anderson, Williams and Corrigan. One number per level, the refinement, sets the
// three spacings (body, box, time) in fixed proportion; it was found by search so that the hull has the
// paper's number of simplices.
#include "slabhull/slab/case.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/shapes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <span>

namespace slabhull {

namespace {

struct Spacings {
    double body;
    double box;
    double time;

    double growth; ///< of the spacing inside the caps, which ends at that of the box

    /// All lengths shrink alike, and so does the growth per unit of distance.
    Spacings divided_by(double refinement) const {
        return {body / refinement, box / refinement, time / refinement, growth / refinement};
    }
};

struct Experiment {
    const char* name;
    const char* title;
    int dimension;
    Spacings spacings;                  ///< at refinement 1
    std::span<const double> refinement; ///< by level
};

constexpr std::array circle_levels{0.747, 1.046, 1.399, 1.959, 2.790, 3.906, 5.573, 7.802, 11.118};
constexpr std::array expanding_circle_levels{0.748, 1.047, 1.396, 1.985, 2.814, 3.940, 5.621, 7.869, 11.155};
constexpr std::array sphere_levels{1.040, 1.410, 1.950};
constexpr std::array expanding_sphere_levels{1.050, 1.410, 1.960};
constexpr std::array ellipsoid_levels{1.137, 1.614, 2.280};
constexpr std::array tandem_levels{1.140, 1.612, 2.280};

constexpr std::array<Experiment, 6> experiments{{
    {"circle", "Circle in a square, at rest", 2, {0.15, 0.4, 0.3, 0.25}, circle_levels},
    {"expanding-circle", "Expanding circle in a square", 2, {0.15, 0.4, 0.3, 0.25}, expanding_circle_levels},
    {"sphere", "Sphere in a cube, at rest", 3, {0.19, 0.7, 0.5, 0.25}, sphere_levels},
    {"expanding-sphere", "Expanding sphere in a cube", 3, {0.19, 0.7, 0.5, 0.25}, expanding_sphere_levels},
    {"ellipsoid", "Ellipsoid turning in a cube", 3, {0.3, 1.2, 0.6, 0.1}, ellipsoid_levels},
    {"tandem-ellipsoids",
     "Two ellipsoids turning against each other in a cube",
     3,
     {0.3, 1.2, 0.6, 0.1},
     tandem_levels},
}};

const Experiment& find_experiment(const std::string& name) {
    std::string known;
    for (const Experiment& experiment : experiments) {
        if (experiment.name == name) {
            return experiment;
        }
        known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", experiment.name);
    }
    throw UsageError(fmt::format("no experiment \"{}\"; there are {}", name, known));
}

constexpr double quarter_turn = std::numbers::pi / 2;

/// Puts an ellipsoid with these semi-axes into the case, its motion about its own centre, and its projection.
void add_body(Case& the_case, InitialBodies& bodies, const std::string& patch, const Numbers& centre,
              const Numbers& semi_axes, double spacing, std::optional<MotionSpec> motion) {
    const auto divisions = [&] {
        if (the_case.dimension == 2) {
            return ellipsoid_divisions<2>({semi_axes[0], semi_axes[1]}, spacing);
        }
        return ellipsoid_divisions<3>({semi_axes[0], semi_axes[1], semi_axes[2]}, spacing);
    };
    bodies.ellipsoids.push_back({centre, semi_axes, divisions(), patch});
    if (motion) {
        motion->centre = centre;
        the_case.motions[patch] = *motion;
    }
    ProjectionSpec projection;
    projection.kind = ProjectionSpec::Kind::ellipsoid;
    projection.centre = centre;
    projection.semi_axes = semi_axes;
    the_case.projections[patch] = projection;
}

MotionSpec turning(double rate) {
    MotionSpec motion;
    motion.kind = MotionSpec::Kind::rotation;
    motion.rate = rate;
    return motion;
}

MotionSpec expanding(double rate) {
    MotionSpec motion;
    motion.kind = MotionSpec::Kind::expansion;
    motion.rate = rate;
    return motion;
}

BoxSpec centred_box(int dimension, double edge, double size) {
    const auto count = static_cast<std::size_t>(dimension);
    return {Numbers(count, -edge / 2), Numbers(count, edge / 2), size, "walls"};
}

} // namespace

Case experiment_at(const std::string& name, double refinement) {
    const Experiment& experiment = find_experiment(name);
    const Spacings at = experiment.spacings.divided_by(refinement);
    Case result;
    result.title = experiment.title;
    result.dimension = experiment.dimension;
    result.experiment = name;
    result.split = result.dimension == 3 ? Split::C : Split::centre;
    result.layers = std::max(1, static_cast<int>(std::lround(1 / at.time)));
    result.cap_size = at.box;
    result.cap_growth = at.growth;

    InitialBodies bodies;
    if (name == "ellipsoid") {
        bodies.outer = centred_box(3, 16, at.box);
        add_body(result, bodies, "body", {0, 0, 0}, {1, 3, 2}, at.body, turning(quarter_turn));
    } else if (name == "tandem-ellipsoids") {
        bodies.outer = BoxSpec{{-7.5, -10, -10}, {12.5, 10, 10}, at.box, "walls"};
        add_body(result, bodies, "first", {0, 0, 0}, {1, 3, 2}, at.body, turning(quarter_turn));
        add_body(result, bodies, "second", {5, 0, 0}, {3, 1, 2}, at.body, turning(-quarter_turn));
    } else {
        const auto dimension = static_cast<std::size_t>(result.dimension);
        bodies.outer = centred_box(result.dimension, 10, at.box);
        const bool expands = name.starts_with("expanding");
        add_body(result, bodies, "body", Numbers(dimension, 0.0), Numbers(dimension, 1.0), at.body,
                 expands ? std::optional{expanding(0.25)} : std::nullopt);
    }
    result.initial = std::move(bodies);
    return result;
}

Case experiment_case(const std::string& name, int level) {
    const Experiment& experiment = find_experiment(name);
    const auto levels = static_cast<int>(experiment.refinement.size());
    if (level < 1 || level > levels) {
        throw UsageError(fmt::format("experiment \"{}\" has levels 1 to {}, not {}", name, levels, level));
    }
    Case result = experiment_at(name, experiment.refinement[static_cast<std::size_t>(level - 1)]);
    result.title += fmt::format(", level {}", level);
    result.level = level;
    return result;
}

} // namespace slabhull
