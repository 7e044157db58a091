// SPDX-License-Identifier: BSD-3-Clause
// The six experiments of Anderson, Williams and Corrigan, with the counts of their tables. One number per
// level, the refinement, sets the three spacings (body, box, time) in fixed proportion;
// bench/tune_experiments found it, so that the hull has the paper's numbers of simplices and vertices.
#include "slabhull/cases/experiments.h"

#include "slabhull/core/error.h"
#include "slabhull/core/text.h"
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
    Spacings mostly_side; ///< at refinement 1
    Spacings mostly_caps;
    std::span<const ExperimentLevel> levels;
};

constexpr std::array circle_levels{
    ExperimentLevel{0.749, {2714, 1357}},     ExperimentLevel{1.041, {5308, 2654}},
    ExperimentLevel{1.386, {10022, 5011}},    ExperimentLevel{1.977, {20142, 10071}},
    ExperimentLevel{2.795, {38792, 19396}},   ExperimentLevel{3.898, {76524, 38262}},
    ExperimentLevel{5.551, {154570, 77285}},  ExperimentLevel{7.797, {305602, 152801}},
    ExperimentLevel{11.058, {613418, 306709}}};
constexpr std::array expanding_circle_levels{
    ExperimentLevel{0.749, {2696, 1348}},     ExperimentLevel{1.049, {5288, 2644}},
    ExperimentLevel{1.397, {10016, 5008}},    ExperimentLevel{1.997, {20086, 10043}},
    ExperimentLevel{2.819, {38734, 19367}},   ExperimentLevel{3.924, {76406, 38203}},
    ExperimentLevel{5.554, {154362, 77181}},  ExperimentLevel{7.866, {305194, 152597}},
    ExperimentLevel{11.154, {612452, 306226}}};
constexpr std::array sphere_levels{
    ExperimentLevel{1.019, {144431, 30813}},      ExperimentLevel{1.412, {368587, 78637}},
    ExperimentLevel{1.947, {958500, 204440}},     ExperimentLevel{2.783, {2630598, 561013}},
    ExperimentLevel{3.895, {7127597, 1519319}},   ExperimentLevel{5.343, {19165615, 4087387}},
    ExperimentLevel{7.733, {56118477, 11961783}}, ExperimentLevel{10.730, {149470428, 31879852}}};
constexpr std::array expanding_sphere_levels{
    ExperimentLevel{1.019, {144345, 30801}},      ExperimentLevel{1.412, {368477, 78620}},
    ExperimentLevel{1.948, {958364, 204417}},     ExperimentLevel{2.781, {2630263, 560955}},
    ExperimentLevel{3.899, {7126629, 1519159}},   ExperimentLevel{5.344, {19163704, 4087112}},
    ExperimentLevel{7.734, {56114273, 11961083}}, ExperimentLevel{10.824, {149461495, 31878349}}};
constexpr std::array ellipsoid_levels{
    ExperimentLevel{1.042, {355798, 75655}},      ExperimentLevel{1.460, {944622, 200867}},
    ExperimentLevel{2.027, {2644079, 562277}},    ExperimentLevel{2.904, {7236458, 1538687}},
    ExperimentLevel{4.067, {20536468, 4365033}},  ExperimentLevel{5.683, {54872975, 11676192}},
    ExperimentLevel{8.145, {162044418, 34449255}}};
constexpr std::array tandem_levels{
    ExperimentLevel{0.959, {603432, 128055}},     ExperimentLevel{1.324, {1627918, 345616}},
    ExperimentLevel{1.911, {4523078, 959759}},    ExperimentLevel{2.665, {12082322, 2566188}},
    ExperimentLevel{3.834, {35245617, 7478525}},  ExperimentLevel{5.326, {94464074, 20066876}},
    ExperimentLevel{7.601, {278561736, 59127488}}};

/// The plane experiments: their hulls have twice as many triangles as vertices, whatever the spacings.
constexpr Spacings plane{0.1475, 0.4, 0.3, 0.25};

constexpr std::array<Experiment, 6> experiments{{
    {"circle", "Circle in a square, at rest", 2, plane, plane, circle_levels},
    {"expanding-circle", "Expanding circle in a square", 2, plane, plane, expanding_circle_levels},
    {"sphere",
     "Sphere in a cube, at rest",
     3,
     {0.189, 2.78, 0.12, 0.9},
     {0.19, 0.7, 0.5, 0.25},
     sphere_levels},
    {"expanding-sphere",
     "Expanding sphere in a cube",
     3,
     {0.189, 2.78, 0.12, 0.9},
     {0.19, 0.7, 0.5, 0.25},
     expanding_sphere_levels},
    {"ellipsoid",
     "Ellipsoid turning in a cube",
     3,
     {0.248, 2.6, 0.114, 0.9},
     {0.3, 1.2, 0.6, 0.1},
     ellipsoid_levels},
    {"tandem-ellipsoids",
     "Two ellipsoids turning against each other in a cube",
     3,
     {0.2535, 2.66, 0.098, 0.9},
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
    throw UsageError(fmt::format("no experiment \"{}\"; there are {}{}", name, known,
                                 did_you_mean(name, experiment_names())));
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

std::span<const std::string> experiment_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Experiment& experiment : experiments) {
            all.emplace_back(experiment.name);
        }
        return all;
    }();
    return names;
}

std::span<const ExperimentLevel> experiment_levels(const std::string& name) {
    return find_experiment(name).levels;
}

Case experiment_at(const std::string& name, double refinement, Bulk bulk) {
    const Experiment& experiment = find_experiment(name);
    const bool side = bulk == Bulk::side;
    const Spacings at = (side ? experiment.mostly_side : experiment.mostly_caps).divided_by(refinement);
    Case result;
    result.title = experiment.title;
    result.dimension = experiment.dimension;
    result.experiment = name;
    result.split = result.dimension == 2 ? Split::centre : side ? Split::E : Split::C;
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
    const auto levels = static_cast<int>(experiment.levels.size());
    if (level < 1 || level > levels) {
        throw UsageError(
            fmt::format("experiment \"{}\" has no level {}; give one from 1 to {}", name, level, levels));
    }
    Case result = experiment_at(name, experiment.levels[static_cast<std::size_t>(level - 1)].refinement);
    result.title += fmt::format(", level {}", level);
    result.level = level;
    return result;
}

} // namespace slabhull
