// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/layers.h"

#include "slab/sweep/share_levels.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/displacement_series.h"
#include "slabhull/geometry/rigid_table.h"
#include "slabhull/slab/march.h"
#include "study/order_study.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace slabhull;

namespace {

constexpr double pi = std::numbers::pi;

/// A coarse body in a box, opened to be swept.
template<int D>
struct Setting {
    SpatialMesh<D> cap;
    Boundary<D> boundary;
    PatchNumber body;
    TrajectoryOptions trajectory;

    static const Setting& get() {
        static const Setting setting;
        return setting;
    }

    MeasuredSweep<D> sweep(const MovingPatch<D>& moving, const LayerOptions& options = {},
                           Communicator* ranks = nullptr) const {
        return sweep_in_layers<D>(boundary, cap, {{body, moving}}, 0, {0, 1}, trajectory, options, ranks);
    }
    MeasuredSweep<D> measured(const MovingPatch<D>& moving, std::size_t layers,
                              const LayerOptions& options = {}, Communicator* ranks = nullptr) const {
        return sweep_measured<D>(boundary, cap, {{body, moving}}, 0, even_levels(0, 1, layers), trajectory,
                                 options, ranks);
    }

private:
    Setting() {
        const Case the_case =
            D == 2 ? experiment_at("expanding-circle", 0.8) : experiment_at("ellipsoid", 0.5);
        StageClock clock;
        IdCounter ids;
        cap = initial_cap<D>(the_case, ids, {}, clock);
        boundary = boundary_of(cap);
        body = patch_number(boundary.patches(), "body");
    }
};

/// What layers do, by brute force: trajectories at many times, by another scheme than the meter's.
template<int D>
class Judge {
public:
    explicit Judge(const Sweep<D>& sweep) : sweep_{sweep} {}

    void run(const MovingPatch<D>& moving, PatchNumber body) {
        const std::vector<Index> vertices = sweep_.boundary.vertices_of({body});
        for (std::size_t layer = 0; layer < sweep_.layers(); ++layer) {
            run_layer(moving, vertices, layer);
        }
    }
    double deviation = 0; ///< in local edge lengths
    double turn = 0;      ///< of facets' edges and normals from level to level, in degrees

private:
    static constexpr int times_per_layer = 23;

    void run_layer(const MovingPatch<D>& moving, const std::vector<Index>& vertices, std::size_t layer) {
        const double from = sweep_.times[layer];
        const double to = sweep_.times[layer + 1];
        const auto& start = sweep_.positions[layer];
        const auto& end = sweep_.positions[layer + 1];
        const std::vector<double> before = local_edges(start);
        const std::vector<double> after = local_edges(end);
        std::vector<Point<D>> x;
        std::vector<TrackId> tracks;
        for (const Index v : vertices) {
            x.push_back(start[v]);
            tracks.push_back(sweep_.boundary.tracks()[v]);
        }
        for (int k = 1; k < times_per_layer; ++k) {
            const double s0 = (k - 1.0) / times_per_layer;
            const double s = static_cast<double>(k) / times_per_layer;
            const double time = from + s * (to - from);
            if (moving.motion != nullptr) {
                advance<D>(*moving.motion, x, from + s0 * (to - from), time, {Scheme::dopri5, 8, 1e-9});
            } else {
                moving.nodal->positions(tracks, time, x);
            }
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                const Index v = vertices[i];
                const Point<D> chord = plus(times(1 - s, start[v]), times(s, end[v]));
                deviation = std::max(deviation, distance(x[i], chord) / std::min(before[v], after[v]));
            }
        }
        for (const Facet<D>& facet : sweep_.boundary.facets()) {
            for (std::size_t i = 0; i < D; ++i) {
                const Index a = facet[i];
                const Index b = facet[(i + 1) % D];
                turn = std::max(turn, angle(minus(start[b], start[a]), minus(end[b], end[a])));
            }
        }
    }

    static double angle(const Point<D>& a, const Point<D>& b) {
        return std::acos(std::clamp(dot(a, b) / (norm(a) * norm(b)), -1.0, 1.0)) * 180 / pi;
    }

    std::vector<double> local_edges(const Array<Point<D>>& places) const {
        std::vector<std::vector<double>> lengths(places.size());
        for (const Facet<D>& facet : sweep_.boundary.facets()) {
            for (std::size_t i = 0; i < D; ++i) {
                for (std::size_t j = 0; j < D; ++j) {
                    if (i != j) {
                        lengths[facet[i]].push_back(distance(places[facet[i]], places[facet[j]]));
                    }
                }
            }
        }
        std::vector<double> mean;
        for (const auto& of_vertex : lengths) {
            double sum = 0;
            for (const double length : of_vertex) {
                sum += length;
            }
            mean.push_back(sum / static_cast<double>(of_vertex.size()));
        }
        return mean;
    }

    const Sweep<D>& sweep_;
};

template<int D>
class RandomMotions {
public:
    explicit RandomMotions(unsigned seed) : random_{seed} {}

    MovingPatch<D> rigid() {
        std::vector<MotionPointer<D>> steps{rotation<D>(direction(), direction(), uniform(-12, 12)),
                                            translation<D>(direction())};
        if (uniform(0, 1) < 0.5) {
            steps.push_back(rotation<D>(direction(), direction(), uniform(-3, 3)));
        }
        return {sequence<D>(steps, 0)};
    }
    MovingPatch<D> formula() {
        std::array<std::string, D> formulas;
        for (std::size_t k = 0; k < D; ++k) {
            const char* other = k == 0 ? "y" : "x";
            formulas[k] = std::to_string(uniform(-6, 6)) + " * sin(" + std::to_string(uniform(1, 40)) +
                          " * t + 0.3 * " + other + ") + " + std::to_string(uniform(-3, 3)) + " * " +
                          (k == 1 ? "-1 * " : "") + other;
        }
        return {formula_velocity<D>(formulas)};
    }
    MovingPatch<D> table() {
        RigidTable<D> table;
        const int rows = static_cast<int>(uniform(2, 40));
        for (int k = 0; k <= rows; ++k) {
            table.times.push_back(static_cast<double>(k) / rows);
            table.shifts.push_back(times(0.3, direction()));
            for (double& angle : table.angles.emplace_back()) {
                angle = uniform(-0.6, 0.6);
            }
        }
        return {rigid_table<D>(table, {})};
    }

private:
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(random_);
    }
    Point<D> direction() {
        Point<D> x;
        for (double& entry : x) {
            entry = uniform(-1, 1);
        }
        return x;
    }
    std::mt19937 random_;
};

template<int D>
MotionPointer<D> turning(double rate) {
    Point<D> axis{};
    axis[D - 1] = 1;
    return rotation<D>(axis, {}, rate);
}

/// Along x, at this speed.
template<int D>
MotionPointer<D> along(const std::string& speed) {
    std::array<std::string, D> formulas;
    formulas.fill("0");
    formulas[0] = speed;
    return formula_velocity<D>(formulas);
}

} // namespace

TEMPLATE_TEST_CASE_SIG("layers by themselves keep chords near trajectories and facets from turning far",
                       "[layers][long]", ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    RandomMotions<D> random{D};
    for (int round = 0; round < 12; ++round) {
        const MovingPatch<D> moving = round % 3 == 0   ? random.rigid()
                                      : round % 3 == 1 ? random.formula()
                                                       : random.table();
        const MeasuredSweep<D> swept = setting.sweep(moving);
        Judge<D> judge{swept.sweep};
        judge.run(moving, setting.body);
        INFO("motion " << round << ", " << swept.fit.layers << " layers");
        CHECK(swept.fit.sound());
        CHECK(judge.deviation <= 0.05 * 1.01); // the judge looks at other times
        CHECK(judge.deviation == Approx(swept.fit.deviation).epsilon(0.1).margin(1e-3));
        CHECK(judge.turn <= 30 * 1.2); // edges shear as well
        CHECK(swept.fit.turn <= 30);
    }
}

TEMPLATE_TEST_CASE_SIG("no fewer equal layers would do for an even turn", "[layers]", ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    LayerOptions plain;
    plain.edges_across = 0;
    for (const double rate : {0.4, 1.0, pi / 2, pi, 2 * pi, 20.0}) {
        const MovingPatch<D> moving{turning<D>(rate)};
        const std::size_t layers = setting.sweep(moving, plain).fit.layers;
        INFO(rate << " rad in " << layers << " layers");
        CHECK(setting.measured(moving, layers).fit.sound());
        if (layers > 1) {
            CHECK_FALSE(setting.measured(moving, layers - 1).fit.sound());
        }
    }
}

TEMPLATE_TEST_CASE_SIG("turns that bring every sample back to its place are seen", "[layers]", ((int D), D),
                       2, 3) {
    const auto& setting = Setting<D>::get();
    for (const int turns : {1, 2, 8, 16, 32, 64, 128, 256, 1000}) {
        CHECK_FALSE(setting.measured({turning<D>(2 * pi * turns)}, 1).fit.sound());
    }
    for (const int turns : {1, 8, 32}) {
        CHECK(setting.sweep({turning<D>(2 * pi * turns)}).fit.layers >= static_cast<std::size_t>(12 * turns));
    }
}

TEMPLATE_TEST_CASE_SIG("a body that goes and comes back between samples is seen", "[layers]", ((int D), D), 2,
                       3) {
    const auto& setting = Setting<D>::get();
    for (const int periods : {1, 8, 16, 32, 64, 128, 256, 1000}) {
        const std::string phase = std::to_string(2 * periods) + " * pi * t";
        const std::string speed = std::to_string(periods) + " * pi * ";
        for (const auto* wave : {"sin(", "cos("}) {
            const MovingPatch<D> moving{along<D>(speed + wave + phase + ")")};
            CHECK_FALSE(setting.measured(moving, 1).fit.sound());
            if (periods <= 16) {
                CHECK(setting.sweep(moving).fit.layers > static_cast<std::size_t>(2 * periods));
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("rows of tables are not stepped over", "[layers]", ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    const int rows = 97;
    RigidTable<D> table;
    DisplacementRows<D> displacements;
    const auto tracks = setting.boundary.tracks();
    for (const Index v : setting.boundary.vertices_of({setting.body})) {
        displacements.tracks.push_back(tracks[v]);
        displacements.start.push_back(setting.boundary.start()[v]);
    }
    for (int k = 0; k <= rows; ++k) {
        Point<D> shift{};
        shift[0] = k == 23 ? 0.3 : 0;
        table.times.push_back(static_cast<double>(k) / rows);
        table.shifts.push_back(shift);
        displacements.times.push_back(table.times.back());
        displacements.displacements.emplace_back(displacements.tracks.size(), shift);
    }
    MovingPatch<D> nodal;
    nodal.nodal = displacement_series<D>(displacements, TimeInterpolation::linear);
    for (const MovingPatch<D>& moving : {MovingPatch<D>{rigid_table<D>(table, {})}, nodal}) {
        const LayerFit fit = setting.measured(moving, 1).fit;
        CHECK_FALSE(fit.sound());
        CHECK(setting.sweep(moving).fit.layers > static_cast<std::size_t>(rows));
    }
    CHECK(setting.measured(nodal, 1).fit.time == Approx(23.0 / rows)); // where the row is, 0.3 off the chord
}

TEMPLATE_TEST_CASE_SIG("a motion that chords follow exactly takes one layer", "[layers]", ((int D), D), 2,
                       3) {
    const auto& setting = Setting<D>::get();
    Point<D> far{};
    far[0] = 1000;
    for (const MotionPointer<D>& motion : {standing<D>(), translation<D>(far), expansion<D>({}, 0.8, 0)}) {
        const MeasuredSweep<D> swept = setting.sweep({motion});
        CHECK(swept.fit.layers == 1);
        CHECK(swept.fit.deviation < 1e-6);
    }
}

TEMPLATE_TEST_CASE_SIG("a body that gathers speed is off its chords in time, though its path is straight",
                       "[layers]", ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    const MovingPatch<D> moving{along<D>("8 * t")}; // 4 t^2, off its chord by 1 in the middle
    const LayerFit one = setting.measured(moving, 1).fit;
    CHECK(one.time == Approx(0.5));
    CHECK(setting.sweep(moving).fit.layers > 4);
}

TEMPLATE_TEST_CASE_SIG("the result is that of as many given layers, for any number of threads", "[layers]",
                       ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    const MovingPatch<D> moving = RandomMotions<D>{7}.formula();
    const MeasuredSweep<D> swept = setting.sweep(moving);
    const Sweep<D> given = sweep_boundary<D>(setting.boundary, setting.cap, {{setting.body, moving}}, 0,
                                             even_levels(0, 1, swept.fit.layers), setting.trajectory);
    CHECK(given.times == swept.sweep.times);
    CHECK(given.positions == swept.sweep.positions);
    set_thread_count(3);
    const MeasuredSweep<D> again = setting.sweep(moving);
    set_thread_count(0);
    CHECK(again.sweep.positions == swept.sweep.positions);
    CHECK(again.fit.deviation == swept.fit.deviation);
    CHECK(again.fit.time == swept.fit.time);
}

TEMPLATE_TEST_CASE_SIG("a motion that needs too many layers is refused by patch and time", "[layers][long]",
                       ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    try {
        setting.sweep({along<D>("t < 0.5 ? 0 : 1e5 * cos(1e6 * t)")});
        FAIL("it was not refused");
    } catch (const TooManyLayers& error) {
        REQUIRE(error.entities.size() == 1);
        CHECK(error.entities[0].kind == "patch");
        CHECK(error.entities[0].patch == "body");
        CHECK_THAT(error.what(), Catch::Contains("more than 10000 layers") && Catch::Contains("patch body"));
        CHECK_THAT(error.what(), Catch::Contains("near t = 0.4999") || Catch::Contains("near t = 0.5"));
    }
    LayerOptions few;
    few.most = 5;
    CHECK_THROWS_AS(setting.sweep({turning<D>(2 * pi)}, few), TooManyLayers);
    CHECK_NOTHROW(setting.sweep({turning<D>(0.1)}, few));
}

TEMPLATE_TEST_CASE_SIG("an error that more layers do not cure is thrown", "[layers]", ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    CHECK_THROWS_WITH(setting.sweep({along<D>("1 / (t - t)")}), Catch::Contains("1 / (t - t)"));
}

namespace {

/// What comes of a sweep, or its error.
template<int D>
struct Outcome {
    std::vector<Array<Point<D>>> positions{};
    std::size_t layers = 0;
    std::array<double, 4> fit{};
    PatchNumber patch = 0;
    std::string error{};

    bool operator==(const Outcome&) const = default;

    /// What a rank has of it: the levels of its layers, the first and the last.
    Outcome of_rank(std::size_t rank, std::size_t ranks) const {
        Outcome here = *this;
        const HullRange share = range_of_part(layers, rank, ranks);
        for (std::size_t level = 1; level < layers; ++level) {
            if (level < share.first || level > share.end()) {
                here.positions[level].clear();
            }
        }
        return here;
    }

    template<class Work>
    static Outcome of(const Work& work) {
        try {
            const MeasuredSweep<D> swept = work();
            const LayerFit& fit = swept.fit;
            return {swept.sweep.positions,
                    fit.layers,
                    {fit.deviation, fit.turn, fit.growth, fit.time},
                    fit.patch,
                    {}};
        } catch (const GeometryError& error) {
            return {{}, 0, {}, 0, error.what()};
        }
    }
};

/// `sweep(ranks)` by one process and in ranks.
template<int D, class SweepIn>
void require_same_in_ranks(const SweepIn& sweep) {
    const auto alone = Outcome<D>::of([&] { return sweep(nullptr); });
    for (const int size : {1, 2, 3, 5, 7}) {
        std::vector<Outcome<D>> found(static_cast<std::size_t>(size));
        run_team(size, [&](Communicator& ranks) {
            found[static_cast<std::size_t>(ranks.rank())] = Outcome<D>::of([&] { return sweep(&ranks); });
        });
        for (std::size_t rank = 0; rank < found.size(); ++rank) {
            CHECK(found[rank] == alone.of_rank(rank, found.size()));
        }
    }
}

/// Some levels, one after the other; often none or all.
HullRange random_levels(std::size_t levels, std::mt19937& random) {
    const std::size_t first = random() % levels;
    const std::array<HullRange, 4> ranges{HullRange{}, {0, levels}, {first, 1}, {first, levels - first}};
    return ranges[random() % ranges.size()];
}

/// Whether a sweep has the levels `kept`, the first and the last of `whole`, and no others.
template<int D>
bool has_only(const Sweep<D>& sweep, const HullRange& kept, const Sweep<D>& whole) {
    bool same = sweep.positions.size() == whole.positions.size();
    for (std::size_t level = 0; level < whole.positions.size() && same; ++level) {
        const bool here = level == 0 || level == whole.layers() || kept.contains(level);
        same = here ? sweep.positions[level] == whole.positions[level] : !sweep.has(level);
    }
    return same;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("ranks that measure layers together find what one process finds", "[layers]",
                       ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    RandomMotions<D> random{11};
    const MovingPatch<D> formula = random.formula();
    const MovingPatch<D> table = random.table();
    LayerOptions few;
    few.most = 20;
    for (const MovingPatch<D>& moving :
         {formula, table, MovingPatch<D>{turning<D>(5)}, MovingPatch<D>{along<D>("1 / (t - t)")},
          MovingPatch<D>{along<D>("t < 0.7 ? 1 : 1 / (t - t)")},
          MovingPatch<D>{along<D>("t < 0.5 ? 90 * cos(90 * t) : 1 / (t - t)")}}) {
        require_same_in_ranks<D>([&](Communicator* ranks) { return setting.sweep(moving, few, ranks); });
        for (const std::size_t layers : {1, 4}) {
            require_same_in_ranks<D>(
                [&](Communicator* ranks) { return setting.measured(moving, layers, {}, ranks); });
        }
    }
}

TEMPLATE_TEST_CASE_SIG("ranks get the levels that they ask for", "[layers]", ((int D), D), 2, 3) {
    const auto& setting = Setting<D>::get();
    const MovingPatch<D> moving{turning<D>(1)};
    for (const std::size_t layers : {1, 2, 5, 12}) {
        const Sweep<D> whole = setting.measured(moving, layers).sweep;
        for (const int size : {1, 2, 3, 4, 7}) {
            std::atomic<int> wrong{0};
            run_team(size, [&](Communicator& ranks) {
                std::mt19937 random{static_cast<unsigned>(ranks.rank())};
                const Sweep<D> share = setting.measured(moving, layers, {}, &ranks).sweep;
                for (int round = 0; round < 20; ++round) {
                    const HullRange wanted = random_levels(layers + 1, random);
                    Sweep<D> sweep = share;
                    share_levels(sweep, wanted, ranks);
                    wrong += has_only(sweep, wanted, whole) ? 0 : 1;
                }
                Sweep<D> sweep = whole; // nobody lacks anything
                const std::uint64_t sent = ranks.sent_bytes();
                share_levels(sweep, levels_of_rank(layers, ranks), ranks);
                wrong += has_only(sweep, levels_of_rank(layers, ranks), whole) ? 0 : 1;
                wrong += ranks.sent_bytes() - sent > static_cast<std::size_t>(size) * (layers + 1) ? 1 : 0;
            });
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("a level that is not here is not given", "[layers]") {
    Sweep<2> sweep = Setting<2>::get().measured({turning<2>(1)}, 3).sweep;
    keep_levels(sweep, {0, 2});
    CHECK(sweep.at(1).points.size() == sweep.boundary.vertex_count());
    CHECK_THROWS_AS(sweep.places(2), std::logic_error);
    CHECK_THROWS_AS(sweep.at(2), std::logic_error);
}

namespace {

/// A march in which layers follow from the motion.
template<int D>
March<D> march_of(double rate) {
    const auto& setting = Setting<D>::get();
    SlabSettings<D> settings;
    settings.motions[setting.body] = {turning<D>(rate)};
    settings.layers.automatic = true;
    return {march_from<D>(setting.cap, 0, IdCounter{1'000'000}), settings};
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a corrected motion that needs no more layers keeps the predicted one's ids",
                       "[layers]", ((int D), D), 2, 3) {
    March<D> march = march_of<D>(2);
    const Slab<D> predicted = march.propose({0, 0.5});
    CHECK(predicted.hull.layers == predicted.layers.layers);
    march.settings().motions.begin()->second.motion = turning<D>(1);
    CHECK(march.propose({0, 0.5}).hull.layers < predicted.hull.layers);
    march.settings().layers.at_least = static_cast<int>(predicted.layers.layers);
    const Slab<D> corrected = march.propose({0, 0.5});
    const std::size_t kept = predicted.hull.points.size() - predicted.terminating().points.size() +
                             march.state().boundary.vertex_count();
    CHECK(corrected.hull.layers == predicted.hull.layers);
    for (std::size_t v = 0; v < kept; ++v) {
        REQUIRE(corrected.hull.vertex_ids[v] == predicted.hull.vertex_ids[v]);
        REQUIRE(corrected.hull.track_ids[v] == predicted.hull.track_ids[v]);
    }
    march.settings().motions.begin()->second.motion = turning<D>(6);
    CHECK(march.propose({0, 0.5}).hull.layers > predicted.hull.layers);
}

TEMPLATE_TEST_CASE_SIG("given layers that are too few are built, with the number that would do", "[layers]",
                       ((int D), D), 2, 3) {
    March<D> march = march_of<D>(2);
    march.settings().layers.automatic = false;
    const Slab<D> few = march.propose({0, 0.5, 1});
    CHECK(few.hull.layers == 2);
    CHECK_FALSE(few.layers.sound());
    REQUIRE(few.layers_enough);
    const Slab<D> enough = march.propose(even_levels(0, 1, *few.layers_enough));
    CHECK(enough.layers.sound());
    CHECK_FALSE(enough.layers_enough);
    march.settings().layers.automatic = true;
    CHECK_THROWS_AS(march.propose({0, 0.5, 1}), UsageError);
}

TEST_CASE("with layers by themselves the turning ellipsoid's side converges at order 2", "[layers][long]") {
    std::vector<specimens::ErrorRow> rows;
    for (const double refinement : {0.5, 0.75, 1.0, 1.5}) {
        Case the_case = experiment_at("ellipsoid", refinement);
        the_case.layers.reset();
        rows.push_back(specimens::errors_of<3>(the_case));
        UNSCOPED_INFO("refinement " << refinement << ": " << rows.back().cells << " cells, side off by "
                                    << rows.back().errors[2]);
    }
    for (const std::size_t measure : {0, 2, 3, 4}) {
        const double order = specimens::rate(rows, measure, 3);
        INFO(specimens::measure_names[measure] << ": order " << order);
        CHECK(order > 1.85);
        CHECK(order < 2.2);
    }
    CHECK(std::abs(rows.back().errors[2]) < 5e-3);
}
