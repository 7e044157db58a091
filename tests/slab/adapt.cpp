// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/adapt_cap.h"

#include "slab/adapt/cavity_apex.h"
#include "slab/adapt/cavity_maker.h"
#include "slab/adapt/cell_quality.h"
#include "slab/adapt/replace_cells.h"

#include "core/rounds.h"
#include "slab/swept_grid.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/simplex_sign.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/march.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

using namespace slabhull;

namespace {

/// A grid whose inner vertices are displaced at random, at rest or displaced anew by the layer's end.
template<int D>
AdaptMesh<D> random_mesh(Index divisions, unsigned seed, double motion) {
    IdCounter ids;
    const SpatialMesh<D> cap = specimens::as_cap<D>(specimens::full_box<D>(divisions), ids);
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> shift{-1, 1};
    AdaptMesh<D> mesh;
    mesh.cells = cap.cells;
    mesh.neighbors = cap.neighbors;
    mesh.before = cap.points;
    mesh.on_boundary.assign(cap.points.size(), 0);
    for (const Facet<D>& facet : cap.boundary_facets) {
        for (const Index v : facet) {
            mesh.on_boundary[v] = 1;
        }
    }
    for (std::size_t v = 0; v < mesh.before.size(); ++v) {
        for (double& x : mesh.before[v]) {
            x += mesh.on_boundary[v] != 0 ? 0 : 0.15 * shift(random);
        }
    }
    mesh.now = mesh.before;
    for (std::size_t v = 0; v < mesh.now.size(); ++v) {
        for (double& x : mesh.now[v]) {
            x += mesh.on_boundary[v] != 0 ? 0 : motion * shift(random);
        }
    }
    mesh.target.assign(mesh.now.size(), 1);
    mesh.column.resize(mesh.now.size());
    std::iota(mesh.column.begin(), mesh.column.end(), Index{0});
    mesh.find_cells_of_vertices();
    return mesh;
}

template<int D>
std::set<Facet<D>> boundary_of_cells(const std::vector<Simplex<D>>& cells) {
    std::map<Facet<D>, int> times;
    for (const Simplex<D>& cell : cells) {
        for (int i = 0; i <= D; ++i) {
            Facet<D> facet = outward_facet<D>(cell, i);
            std::sort(facet.begin(), facet.end());
            ++times[facet];
        }
    }
    std::set<Facet<D>> once;
    for (const auto& [facet, count] : times) {
        REQUIRE(count <= 2);
        if (count == 1) {
            once.insert(facet);
        }
    }
    return once;
}

template<int D>
double measure_of(const std::vector<Simplex<D>>& cells, const AdaptMesh<D>& mesh, const Cavity<D>& cavity) {
    double sum = 0;
    for (const Simplex<D>& cell : cells) {
        std::array<Point<D>, D + 1> corners;
        for (std::size_t k = 0; k <= D; ++k) {
            corners[k] = cell[k] == Cavity<D>::new_vertex ? cavity.new_place : mesh.now[cell[k]];
        }
        const double measure = signed_measure<D>(corners);
        REQUIRE(measure > 0);
        sum += measure;
    }
    return sum;
}

template<int D>
std::vector<Simplex<D>> cells_of(const AdaptMesh<D>& mesh, const std::vector<Index>& numbers) {
    std::vector<Simplex<D>> cells;
    for (const Index cell : numbers) {
        cells.push_back(mesh.cells[cell]);
    }
    return cells;
}

/// All operations at all places of a mesh.
template<int D>
std::vector<Cavity<D>> all_cavities(const AdaptMesh<D>& mesh) {
    CavityMaker<D> maker{mesh};
    std::vector<Cavity<D>> all;
    const auto add = [&](std::optional<Cavity<D>>&& cavity) {
        if (cavity) {
            all.push_back(std::move(*cavity));
        }
    };
    for (Index c = 0; c < mesh.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            add(maker.flip_facet(c, i));
            for (std::size_t j = 0; j <= D; ++j) {
                if (i != j) {
                    add(maker.collapse(mesh.cells[c][i], mesh.cells[c][j]));
                }
                if (i < j) {
                    add(maker.split(mesh.cells[c][i], mesh.cells[c][j]));
                    add(maker.remove_edge(mesh.cells[c][i], mesh.cells[c][j]));
                }
            }
        }
    }
    return all;
}

} // namespace

TEST_CASE("the quality of a cell is the smallest sine of its angles", "[adapt]") {
    std::mt19937 random{5};
    std::uniform_real_distribution<double> coordinate{0, 1};
    for (int k = 0; k < 1000; ++k) {
        std::array<Point<3>, 4> solid;
        std::array<Point<2>, 3> plane;
        for (auto& point : solid) {
            for (double& x : point) {
                x = coordinate(random);
            }
        }
        for (auto& point : plane) {
            point = {coordinate(random), coordinate(random)};
        }
        const auto sine_of = [](const AngleRange& range) {
            const double smallest = quality_of_angle(range.smallest);
            return std::min(smallest, quality_of_angle(range.largest));
        };
        const double sign = signed_measure<3>(solid) > 0 ? 1 : -1;
        CHECK(cell_quality(solid) == Approx(sign * sine_of(dihedral_angles<3, 3>(solid))).margin(1e-7));
        const double sign2 = signed_measure<2>(plane) > 0 ? 1 : -1;
        CHECK(cell_quality(plane) == Approx(sign2 * sine_of(dihedral_angles<2, 2>(plane))).margin(1e-7));
    }
    CHECK(cell_quality(std::array<Point<3>, 4>{}) == 0);
    CHECK(cell_quality(std::array<Point<2>, 3>{}) == 0);
}

TEST_CASE("cells are replaced so that no number is unused", "[adapt]") {
    std::mt19937 random{11};
    for (int round = 0; round < 2000; ++round) {
        const std::size_t count = 1 + random() % 20;
        Array<int> rows(count);
        std::iota(rows.begin(), rows.end(), 0);
        std::vector<Index> removed;
        std::multiset<int> expected(rows.begin(), rows.end());
        for (Index c = 0; c < count; ++c) {
            if (random() % 3 == 0) {
                removed.push_back(c);
                expected.erase(static_cast<int>(c));
            }
        }
        std::shuffle(removed.begin(), removed.end(), random);
        std::vector<int> added(random() % 8);
        std::iota(added.begin(), added.end(), 100);
        expected.insert(added.begin(), added.end());
        const CellReplacement replacement{count, removed, added.size()};
        replacement.apply(rows, std::span<const int>{added});
        REQUIRE(std::multiset<int>(rows.begin(), rows.end()) == expected);
        for (std::size_t k = 0; k < added.size(); ++k) {
            REQUIRE(rows[replacement.added[k]] == added[k]);
        }
        for (Index c = 0; c < count; ++c) {
            if (std::find(removed.begin(), removed.end(), c) == removed.end()) {
                REQUIRE(rows[replacement.now_of(c)] == static_cast<int>(c));
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("operations keep the boundary and the measure of their cells", "[adapt]", ((int D), D),
                       2, 3) {
    std::map<OperationKind, int> found;
    for (unsigned seed = 0; seed < static_cast<unsigned>(rounds(10)); ++seed) {
        const AdaptMesh<D> mesh = random_mesh<D>(3, seed, 0);
        for (const Cavity<D>& cavity : all_cavities(mesh)) {
            ++found[cavity.kind];
            const auto removed = cells_of(mesh, cavity.removed);
            REQUIRE(boundary_of_cells<D>(removed) == boundary_of_cells<D>(cavity.added));
            REQUIRE(measure_of(cavity.added, mesh, cavity) == Approx(measure_of(removed, mesh, cavity)));
            REQUIRE(cavity.has_new_vertex == (cavity.kind == OperationKind::split));
            REQUIRE((cavity.ended != no_index) == (cavity.kind == OperationKind::collapse));
        }
    }
    CHECK(found[OperationKind::split] > 0);
    CHECK(found[OperationKind::collapse] > 0);
    CHECK(found[OperationKind::flip] > 0);
}

TEMPLATE_TEST_CASE_SIG("operations do not touch the domain's boundary", "[adapt]", ((int D), D), 2, 3) {
    const AdaptMesh<D> mesh = random_mesh<D>(2, 1, 0);
    CavityMaker<D> maker{mesh};
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            if (mesh.neighbors[c][i] != no_index) {
                continue;
            }
            CHECK(!maker.flip_facet(static_cast<Index>(c), i));
            for (std::size_t j = 0; j <= D; ++j) {
                const Index a = mesh.cells[c][j];
                const Index b = mesh.cells[c][(j + 1) % (D + 1)];
                if (j != i && (j + 1) % (D + 1) != i) { // an edge of the facet
                    CHECK(!maker.split(a, b));
                    CHECK(!maker.remove_edge(a, b));
                }
                if (j != i) {
                    CHECK(!maker.collapse(a, b));
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("connectivity is right after rounds of operations", "[adapt]", ((int D), D), 2, 3) {
    for (unsigned seed = 0; seed < static_cast<unsigned>(rounds(D == 2 ? 50 : 10)); ++seed) {
        AdaptMesh<D> mesh = random_mesh<D>(3, seed, 0);
        std::mt19937 random{seed};
        AdaptLog<D> log;
        log.cells = mesh.cells;
        Array<Simplex<D>> replayed = mesh.cells;
        auto next_column = static_cast<Index>(mesh.now.size());
        double measure = 0;
        for (int round = 0; round < 4; ++round) {
            std::vector<Cavity<D>> all = all_cavities(mesh);
            std::shuffle(all.begin(), all.end(), random);
            std::vector<Cavity<D>> chosen;
            std::set<Index> taken;
            for (Cavity<D>& cavity : all) {
                if (std::none_of(cavity.removed.begin(), cavity.removed.end(),
                                 [&](Index c) { return taken.contains(c); })) {
                    taken.insert(cavity.removed.begin(), cavity.removed.end());
                    chosen.push_back(std::move(cavity));
                }
            }
            const std::size_t removed_begin = log.removed.size();
            const std::size_t added_begin = log.added.size();
            mesh.apply(chosen, next_column, log);
            CellReplacement{
                replayed.size(),
                {log.removed.begin() + static_cast<std::ptrdiff_t>(removed_begin), log.removed.end()},
                log.added.size() - added_begin}
                .apply(replayed, std::span<const Simplex<D>>{log.added}.subspan(added_begin));
            const Adjacency<D> expected = build_adjacency<D>(mesh.cells, mesh.now.size());
            REQUIRE(expected.neighbors == mesh.neighbors);
            for (const FacetDefect<D>& defect : expected.defects) {
                REQUIRE(defect.kind == FacetDefect<D>::Kind::open);
            }
            REQUIRE(replayed.size() == mesh.cells.size());
            double sum = 0;
            for (std::size_t c = 0; c < replayed.size(); ++c) {
                Simplex<D> columns = mesh.cells[c];
                for (Index& v : columns) {
                    v = mesh.column[v];
                }
                REQUIRE(columns == replayed[c]);
                sum += signed_measure<D>(corners_of<D, D>(mesh.cells[c], mesh.now));
            }
            measure = measure == 0 ? sum : measure;
            REQUIRE(sum == Approx(measure));
            REQUIRE(std::is_sorted(mesh.column.begin(), mesh.column.end()));
            std::vector<Index> star;
            for (Index v = 0; v < mesh.now.size(); ++v) {
                mesh.gather_star(v, star);
                const auto size = std::count_if(mesh.cells.begin(), mesh.cells.end(),
                                                [v](const auto& cell) { return place_in<D>(cell, v) <= D; });
                REQUIRE(star.size() == static_cast<std::size_t>(size));
            }
            mesh.before = mesh.now;
        }
    }
}

namespace {

/// Whether the cone from the apex over a cavity's space-time cell has positive volumes, by exact sign. Walls
/// are staircases in the order of the vertices.
template<int D>
bool cones_positively(const AdaptMesh<D>& mesh, const Cavity<D>& cavity, double begin, double end) {
    const auto at = [](const Point<D>& place, double t) {
        Point<D + 1> point;
        std::copy(place.begin(), place.end(), point.begin());
        point[D] = t;
        return point;
    };
    const auto positive = [&](const std::array<Point<D + 1>, D + 1>& facet, bool odd) {
        std::array<Point<D + 1>, D + 2> corners;
        std::copy(facet.begin(), facet.end(), corners.begin());
        corners[D + 1] = cavity.apex;
        return simplex_sign<D + 1>(corners) == (odd ? -1 : 1);
    };
    bool all = true;
    for (const Index c : cavity.removed) {
        std::array<Point<D + 1>, D + 1> below;
        for (std::size_t k = 0; k <= D; ++k) {
            below[k] = at(mesh.before[mesh.cells[c][k]], begin);
        }
        all = all && positive(below, false);
    }
    for (const Simplex<D>& cell : cavity.added) {
        std::array<Point<D + 1>, D + 1> above;
        for (std::size_t k = 0; k <= D; ++k) {
            above[k] = at(cell[k] == Cavity<D>::new_vertex ? cavity.new_place : mesh.now[cell[k]], end);
        }
        all = all && positive(above, true);
    }
    for (const Facet<D>& facet : boundary_of_cells<D>(cells_of(mesh, cavity.removed))) {
        for (const Index c : cavity.removed) {
            const auto own = std::count_if(facet.begin(), facet.end(),
                                           [&](Index v) { return place_in<D>(mesh.cells[c], v) <= D; });
            if (own < D) {
                continue;
            }
            const Facet<D> outward = outward_facet<D>(mesh.cells[c], facet);
            bool odd = false;
            for (std::size_t i = 0; i < D; ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    odd = odd != (outward[j] > outward[i]);
                }
            }
            for (std::size_t m = 0; m < D; ++m) {
                std::array<Point<D + 1>, D + 1> piece;
                for (std::size_t k = 0; k <= D; ++k) {
                    piece[k] = k <= m ? at(mesh.before[facet[k]], begin) : at(mesh.now[facet[k - 1]], end);
                }
                all = all && positive(piece, odd == ((m + D) % 2 == 1)); // outward pieces: negative cones
            }
        }
    }
    return all;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("cavities that move are coned with positive volumes, or refused", "[adapt]",
                       ((int D), D), 2, 3) {
    int found = 0;
    for (const double motion : {0.0, 0.05, 0.3}) {
        for (unsigned seed = 0; seed < static_cast<unsigned>(rounds(10)); ++seed) {
            const AdaptMesh<D> mesh = random_mesh<D>(3, seed, motion);
            for (Cavity<D>& cavity : all_cavities(mesh)) {
                if (find_apex<D>(mesh, {0.25, 0.5}, cavity)) {
                    ++found;
                    REQUIRE(cones_positively(mesh, cavity, 0.25, 0.5));
                } else {
                    REQUIRE(motion > 0); // at rest, the kernel's place always serves
                }
            }
        }
    }
    CHECK(found > 100);
    AdaptMesh<D> half_turn = random_mesh<D>(3, 0, 0); // vertices pass through the axis at half time
    for (Point<D>& place : half_turn.now) {
        for (std::size_t k = 0; k < 2; ++k) {
            place[k] = 3 - place[k];
        }
    }
    for (Cavity<D>& cavity : all_cavities(half_turn)) {
        REQUIRE_FALSE(find_apex<D>(half_turn, {0, 1}, cavity));
    }
}

namespace {

template<int D>
March<D> adapting_march(Split split) {
    Case the_case = D == 2 ? experiment_at("expanding-circle", 0.8) : experiment_at("ellipsoid", 0.3);
    the_case.cap_reuse = CapReuse::adapt;
    the_case.split = split;
    StageClock clock;
    IdCounter ids;
    MarchState<D> state = march_from<D>(initial_cap<D>(the_case, ids, {}, clock), the_case.start, ids);
    SlabSettings<D> settings = settings_of<D>(the_case, state.boundary);
    settings.layers.automatic = false;
    settings.layers.suggest = false;
    settings.adapt.angle = 12;
    settings.adapt.size = 1.5;
    return {std::move(state), std::move(settings)};
}

template<int D>
std::vector<Split> splits() {
    if constexpr (D == 2) {
        return {Split::diagonal, Split::centre};
    } else {
        return rounds(10) == 10 ? std::vector{Split::A, Split::B, Split::C, Split::D, Split::E}
                                : std::vector{Split::A, Split::C};
    }
}

} // namespace

TEMPLATE_TEST_CASE_SIG("slabs whose caps are adapted are filled, whatever the split", "[adapt]", ((int D), D),
                       2, 3) {
    for (const Split split : splits<D>()) {
        INFO(split_name(split));
        March<D> march = adapting_march<D>(split);
        std::set<TrackId> ended;
        for (int k = 0; k < 2; ++k) {
            StageClock clock;
            const double t = march.state().time;
            Slab<D> slab = march.propose({t, t + 0.05, t + 0.1, t + 0.15}, clock);
            REQUIRE(slab.adapted);
            const AdaptLog<D>& log = slab.adapted->log;
            CHECK(!log.operations.empty());
            CHECK(std::is_sorted(log.tracks.begin(), log.tracks.end()));
            CHECK(std::set<TrackId>(log.tracks.begin(), log.tracks.end()).size() == log.tracks.size());
            const HullReport hull = check_hull<D>(slab.hull);
            INFO(findings_as_text(hull));
            REQUIRE(hull.clean());
            const Filling<D> filling = fill_adapted<D>(slab.hull, log, clock);
            const FillingReport report = check_filling<D>(columns_of(filling), &slab.hull);
            INFO(findings_as_text(report));
            REQUIRE(report.clean());
            CHECK(report.volume == Approx(hull.enclosed).epsilon(1e-12));
            for (const TrackId track : log.tracks) { // a track that ended does not begin again
                CHECK(!ended.contains(track));
            }
            std::vector<std::uint8_t> alive(log.tracks.size(), 0);
            for (const Index column : log.columns.back()) {
                alive[column] = 1;
            }
            for (std::size_t c = 0; c < alive.size(); ++c) {
                if (alive[c] == 0) {
                    ended.insert(log.tracks[c]);
                }
            }
            march.accept(std::move(slab));
        }
        CHECK(!ended.empty());
    }
}

TEMPLATE_TEST_CASE_SIG("an adapted slab is the same with any number of threads", "[adapt]", ((int D), D), 2,
                       3) {
    const March<D> march = adapting_march<D>(splits<D>().front());
    const auto propose = [&](int threads) {
        set_thread_count(threads);
        Slab<D> slab = march.propose({0, 0.05, 0.1});
        set_thread_count(0);
        return slab;
    };
    const Slab<D> one = propose(1);
    const Slab<D> three = propose(3);
    CHECK(one.hull.points == three.hull.points);
    CHECK(one.hull.cells == three.hull.cells);
    CHECK(one.hull.neighbors == three.hull.neighbors);
    CHECK(one.adapted->log.added == three.adapted->log.added);
    CHECK(one.adapted->log.removed == three.adapted->log.removed);
}

TEST_CASE("layers are halved while they turn cells of the cap inside out", "[adapt]") {
    March<3> march = adapting_march<3>(Split::A);
    march.settings().motions.begin()->second.motion = rotation<3>({0, 0, 1}, {}, 1.5);
    for (const bool automatic : {false, true}) {
        march.settings().layers.automatic = automatic;
        march.settings().layers.tolerance = 10;
        march.settings().layers.turn = 120;
        march.settings().layers.edges_across = 0;
        const Slab<3> slab = march.propose({0, 1});
        CHECK(slab.adapted->report.halvings > 0);
        CHECK(slab.hull.layers == slab.layers.layers);
        CHECK(slab.hull.layers == slab.adapted->log.layers());
        CHECK(check_hull<3>(slab.hull).clean());
    }
    march.settings().layers.most = 1;
    REQUIRE_THROWS_AS(march.propose({0, 1}), InvertedCap);
}
