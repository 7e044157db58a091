// SPDX-License-Identifier: BSD-3-Clause
// The proof by stars and groups against the exact test of every pair of cells, on random hulls.
#include "slabhull/geometry/hull_embedding.h"

#include "core/rounds.h"
#include "geometry/embedding/cell_pairs.h"
#include "io/scratch.h"
#include "slab/parts.h"
#include "slab/specimens.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/run.h"
#include "slabhull/cases/settings.h"
#include "slabhull/slab/slab.h"

#include <catch2/catch.hpp>

#include <random>
#include <regex>
#include <set>

using namespace slabhull;

namespace {

template<int D>
struct Soup {
    Array<Point<D + 1>> points;
    Array<Simplex<D>> cells;
};

using Pairs = std::set<std::pair<Index, Index>>;

template<int D>
HullEmbedding<D> examine(const Soup<D>& hull) {
    const auto adjacency = build_adjacency<D>(hull.cells, hull.points.size());
    constexpr std::size_t all = 1'000'000;
    const auto found = examine_embedding<D>(hull.points, hull.cells, adjacency, all);
    tests::require_same_in_ranks<D>(hull.points, hull.cells, adjacency, all, found);
    return found;
}

template<int D>
Pairs pairs_of(const std::vector<Crossing<D + 1>>& crossings) {
    Pairs pairs;
    for (const auto& crossing : crossings) {
        pairs.emplace(crossing.first, crossing.second);
    }
    return pairs;
}

/// All cells, those of the caps too, in pairs; cells without extent alone.
template<int D>
Pairs by_pairs(const Soup<D>& hull) {
    const CellPairs<D> decider{hull.points, hull.cells, scale_of_cells<D>(hull.points, hull.cells)};
    PairTally<D> tally;
    Array<Box<D + 1>> boxes;
    for (Index c = 0; c < hull.cells.size(); ++c) {
        const bool flat = degenerate(corners_of<D, D + 1>(hull.cells[c], hull.points));
        boxes.push_back(flat ? Box<D + 1>{} : box_of<D>(hull.cells[c], hull.points));
        if (flat) {
            tally.crossings.push_back({c, c, {}});
        }
    }
    const BoxTree<D + 1> tree{boxes};
    for (std::size_t block = 0; block < tree.blocks(); ++block) {
        tree.find_pairs(block, [&](Index a, Index b) { decider.decide(a, b, tally); });
    }
    return pairs_of<D>(tally.crossings);
}

using Random = std::mt19937;

double uniform(Random& random, double reach) {
    return std::uniform_real_distribution<double>{-reach, reach}(random);
}

/// A hull by hand whose body moves as it likes: on each level it is turned about its middle and shifted, by
/// up to `turn` and `shift`, and its vertices shaken.
template<int D>
Soup<D> with_moved_body(Random& random, double turn, double shift, double shake) {
    const Hull<D> made = specimens::swept(specimens::box_with_body<D>(), 3);
    Soup<D> hull{made.points, made.cells};
    std::map<double, std::array<double, D + 1>> moves; // angle and shift by level
    for (Point<D + 1>& p : hull.points) {
        const bool of_body =
            std::all_of(p.begin(), p.begin() + D, [](double x) { return x > 1.5 && x < 3.5; });
        if (!of_body || p[D] == 1 || p[D] == 2) {
            continue;
        }
        auto [move, is_new] = moves.try_emplace(p[D]);
        for (std::size_t k = 0; k <= D && is_new; ++k) {
            move->second[k] = uniform(random, k == 0 ? turn : shift);
        }
        const double c = std::cos(move->second[0]), s = std::sin(move->second[0]);
        const double x = p[0] - 2.5, y = p[1] - 2.5;
        p[0] = 2.5 + c * x - s * y;
        p[1] = 2.5 + s * x + c * y;
        for (std::size_t k = 0; k < D; ++k) {
            p[k] += move->second[k + 1] + uniform(random, shake);
        }
    }
    return hull;
}

/// A hull of the paper's, coarse, with a split of the case's choice.
template<int D>
Soup<D> built(const std::string& experiment, double refinement, Split split, int layers) {
    Case the_case = experiment_at(experiment, refinement, Bulk::caps);
    the_case.split = split;
    the_case.layers = layers;
    the_case.spacing.reset();
    IdCounter ids;
    StageClock clock;
    const SpatialMesh<D> cap = initial_cap<D>(the_case, ids, {}, clock);
    const Hull<D> hull = build_slab<D>(cap, boundary_of(cap), 0, the_case.level_times(0),
                                       settings_of<D>(the_case, boundary_of(cap)), ids, clock)
                             .hull;
    return {hull.points, hull.cells};
}

/// Moves the vertices between the caps, centres of prisms and faces too, by up to `reach` in space.
template<int D>
Soup<D> shaken(Soup<D> hull, Random& random, double reach) {
    for (Point<D + 1>& p : hull.points) {
        for (std::size_t k = 0; k < D && p[D] != 0 && p[D] != 1; ++k) {
            p[k] += uniform(random, reach);
        }
    }
    return hull;
}

/// Two ellipses or ellipsoids, called left and right, that move in a box, in a few layers of given length.
template<int D>
class TwoBodies {
public:
    explicit TwoBodies(unsigned seed) : random_{seed} {}

    /// They stay in their half of the box, and turn by little.
    Case apart() {
        Case the_case = two_bodies(2.2, [&](double side) {
            MotionSpec turned = rotation(0.5);
            turned.centre = Numbers(D, side);
            return sequence({turned, translation(side > 0 ? 0.5 : -0.5, 0.5)});
        });
        the_case.layers = 1 + static_cast<int>(random_() % 3);
        return the_case;
    }
    /// They change places, which leads them through each other if they do not pass by.
    Case changing_places() {
        return two_bodies(1.5, [&](double side) { return translation(-2 * side, 0.4); });
    }
    /// Each turns about itself so far that its chords may meet.
    Case turning() {
        return two_bodies(2, [&](double side) {
            MotionSpec motion = rotation(1);
            motion.rate = (motion.rate < 0 ? -1 : 1) * (2.2 + uniform(random_, 1.4));
            motion.centre = Numbers(D, 0.0);
            motion.centre[0] = side;
            return motion;
        });
    }

private:
    template<class MotionOf>
    Case two_bodies(double side, const MotionOf& motion_of) {
        Case the_case;
        the_case.dimension = D;
        the_case.split = D == 2 ? (random_() % 2 == 0 ? Split::centre : Split::diagonal)
                                : std::array{Split::A, Split::B, Split::C, Split::D, Split::E}[random_() % 5];
        the_case.layers = 1;
        the_case.formats = {"vtu"};
        InitialBodies bodies;
        bodies.outer = BoxSpec{Numbers(D, -5.5), Numbers(D, 5.5), D == 2 ? 2.75 : 5.5, "walls"};
        for (const char* name : {"left", "right"}) {
            side = -side;
            Numbers centre(D, 0.0);
            centre[0] = side;
            Numbers semi_axes(D);
            for (double& length : semi_axes) {
                length = 0.8 + uniform(random_, 0.35);
            }
            bodies.ellipsoids.push_back({centre, semi_axes, D == 2 ? 9 : 1, name});
            the_case.motions[name] = motion_of(side);
        }
        the_case.initial = std::move(bodies);
        return the_case;
    }
    MotionSpec translation(double along, double across) {
        MotionSpec motion;
        motion.kind = MotionSpec::Kind::translation;
        motion.velocity = {along, uniform(random_, across), uniform(random_, across)};
        motion.velocity.resize(D);
        return motion;
    }
    MotionSpec rotation(double most) {
        MotionSpec motion;
        motion.kind = MotionSpec::Kind::rotation;
        motion.rate = uniform(random_, most);
        motion.axis = {uniform(random_, 1), uniform(random_, 1), 1};
        return motion;
    }
    static MotionSpec sequence(std::vector<MotionSpec> steps) {
        MotionSpec motion;
        motion.kind = MotionSpec::Kind::sequence;
        motion.steps = std::move(steps);
        return motion;
    }

    Random random_;
};

template<int D>
Soup<D> hull_of_file(const std::filesystem::path& path) {
    io::Soup soup = io::read_mesh(path);
    const HullArrays<D> arrays = hull_of_soup<D>(soup);
    const HullColumns<D> columns = arrays.columns();
    CHECK(columns.neighbor_table.size() == columns.cells.size()); // as it was read, in 32 bits
    CHECK(arrays.region.narrow().empty());                        // in runs
    return {arrays.points, {columns.cells.begin(), columns.cells.end()}};
}

/// Builds without a proof, so that there is a hull to look at in pairs.
template<int D>
Pairs pairs_without_proof(Case the_case) {
    const scratch::Folder folder;
    the_case.directory = folder / "out";
    the_case.check_embedding = false;
    run_case(the_case, {});
    return by_pairs(hull_of_file<D>(the_case.directory / "slab_0000.vtu"));
}

/// Each crossing in the refusal is two cells that cross indeed, said with patches, place and time.
void check_refusal(const GeometryError& refusal, const Pairs& expected) {
    REQUIRE_FALSE(refusal.entities.empty());
    REQUIRE(refusal.entities.size() % 2 == 0);
    for (std::size_t k = 0; k < refusal.entities.size(); k += 2) {
        REQUIRE(refusal.entities[k].kind == "cell");
        REQUIRE(expected.contains({static_cast<Index>(refusal.entities[k].number),
                                   static_cast<Index>(refusal.entities[k + 1].number)}));
    }
    const std::string text = refusal.what();
    const std::string cell = "cell \\d+ \\(patch (left|right|walls), t = [0-9.]+ to [0-9.]+\\)";
    const std::regex crossing{cell + " and " + cell +
                              " meet at t = ([-0-9.e]+) near \\(([-0-9.e]+(, )?)+\\)"};
    auto found = std::sregex_iterator(text.begin(), text.end(), crossing);
    REQUIRE(static_cast<std::size_t>(std::distance(found, {})) == refusal.entities.size() / 2);
    for (; found != std::sregex_iterator{}; ++found) {
        const double time = std::stod((*found)[3]);
        CHECK((time >= 0 && time <= 1));
    }
}

} // namespace

TEMPLATE_TEST_CASE_SIG("random sound hulls are proven, as by pairs", "[embedding]", ((int D), D), 2, 3) {
    Random random{17};
    for (int k = 0; k < rounds(12); ++k) {
        const Soup<D> hull = with_moved_body<D>(random, 0.3, 0.2, 0.03);
        const HullEmbedding<D> found = examine(hull);
        REQUIRE(found.crossings.empty());
        REQUIRE(found.caps_proven);
        REQUIRE(by_pairs(hull).empty());
    }
}

TEMPLATE_TEST_CASE_SIG("random bodies that go through walls or themselves are found, as by pairs",
                       "[embedding]", ((int D), D), 2, 3) {
    Random random{23};
    for (int planted = 0; planted < rounds(8);) {
        const bool through_itself = planted % 2 == 0;
        const Soup<D> hull = through_itself ? with_moved_body<D>(random, 3, 0.1, 0.1)
                                            : with_moved_body<D>(random, 0.1, 3, 0.1);
        const Pairs expected = by_pairs(hull);
        REQUIRE(pairs_of<D>(examine(hull).crossings) == expected);
        planted += !expected.empty();
    }
}

TEST_CASE("hulls of every split that are shaken cross just where pairs do", "[embedding][long]") {
    Random random{29};
    const bool longer = rounds(1) > 1;
    const std::vector<double> reaches = longer ? std::vector{0.0, 0.1, 0.4, 1.5} : std::vector{0.1, 1.5};
    for (const Split split : {Split::A, Split::B, Split::C, Split::D, Split::E}) {
        const Soup<3> hull = built<3>("ellipsoid", 0.1, split, 4);
        CHECK(examine(hull).proven_stars > 0);
        bool crossed = false;
        for (const double reach : reaches) {
            const Soup<3> moved = shaken(hull, random, reach);
            const Pairs expected = by_pairs(moved);
            CHECK(pairs_of<3>(examine(moved).crossings) == expected);
            crossed = crossed || !expected.empty();
        }
        CHECK(crossed);
    }
    for (const Split split : {Split::diagonal, Split::centre}) {
        const Soup<2> hull = built<2>("expanding-circle", 0.5, split, 4);
        for (const double reach : {0.0, 0.1, 0.5, 1.0}) {
            const Soup<2> moved = shaken(hull, random, reach);
            CHECK(pairs_of<2>(examine(moved).crossings) == by_pairs(moved));
        }
    }
}

TEST_CASE("a star that winds twice about its vertex is not proven", "[embedding]") {
    // Two cones over a curve that goes round twice: all normals are on one side, the border is seen from the
    // tip.
    Soup<2> cones;
    constexpr Index corners = 16;
    for (Index k = 0; k < corners; ++k) {
        const double a = 2 * M_PI * k / corners;
        const double r = 1 + 0.3 * std::cos(a);
        cones.points.push_back({r * std::cos(2 * a), r * std::sin(2 * a), 0.3 * std::sin(a)});
        cones.cells.push_back({k, (k + 1) % corners, corners});
        cones.cells.push_back({(k + 1) % corners, k, corners + 1});
    }
    cones.points.push_back({0.01, 0.02, 2});
    cones.points.push_back({0.02, 0.01, -3});
    const Pairs expected = by_pairs(cones);
    CHECK_FALSE(expected.empty());
    CHECK(pairs_of<2>(examine(cones).crossings) == expected);

    Soup<3> suspended;
    for (const Point<3>& p : cones.points) {
        suspended.points.push_back({p[0], p[1], p[2], 0.01 * p[0]});
    }
    suspended.points.push_back({0.1, 0.2, 0.1, 4});
    suspended.points.push_back({0.2, 0.1, 0.1, -5});
    for (const Simplex<2>& cell : cones.cells) {
        suspended.cells.push_back({cell[0], cell[1], cell[2], corners + 2});
        suspended.cells.push_back({cell[1], cell[0], cell[2], corners + 3});
    }
    const Pairs of_suspended = by_pairs(suspended);
    CHECK_FALSE(of_suspended.empty());
    CHECK(pairs_of<3>(examine(suspended).crossings) == of_suspended);
}

TEST_CASE("cells in any order are proven as well, only less quickly", "[embedding]") {
    Random random{31};
    Soup<3> hull = built<3>("ellipsoid", 0.1, Split::C, 4);
    std::shuffle(hull.cells.begin(), hull.cells.end(), random);
    const HullEmbedding<3> found = examine(hull);
    CHECK(found.crossings.empty());
    CHECK(found.proven_stars > found.stars / 2);
}

TEMPLATE_TEST_CASE_SIG("a run refuses random bodies that cross between levels, and writes nothing",
                       "[embedding]", ((int D), D), 2, 3) {
    TwoBodies<D> scene{37};
    for (int planted = 0, tried = 0; planted < rounds(8); ++tried) {
        REQUIRE(tried < rounds(60));
        Case the_case = planted % 2 == 0 ? scene.changing_places() : scene.turning();
        const Pairs expected = pairs_without_proof<D>(the_case);
        const scratch::Folder folder;
        the_case.directory = folder / "out";
        if (expected.empty()) {
            REQUIRE_NOTHROW(run_case(the_case, {}));
            continue;
        }
        try {
            run_case(the_case, {});
            FAIL("a hull that crosses itself was written");
        } catch (const GeometryError& refusal) {
            check_refusal(refusal, expected);
        }
        CHECK(std::filesystem::is_empty(the_case.directory));
        ++planted;
    }
}

TEMPLATE_TEST_CASE_SIG("a run refuses no random slabs that are sound", "[embedding]", ((int D), D), 2, 3) {
    TwoBodies<D> scene{41};
    for (int k = 0; k < rounds(12); ++k) {
        const scratch::Folder folder;
        Case the_case = scene.apart();
        the_case.directory = folder / "out";
        REQUIRE_NOTHROW(run_case(the_case, {}));
        REQUIRE(by_pairs(hull_of_file<D>(the_case.directory / "slab_0000.vtu")).empty());
    }
}
