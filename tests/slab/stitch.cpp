// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/stitch.h"
#include "slabhull/cases/settings.h"

#include "slab/stitch/layered_side.h"
#include "slab/sweep/share_levels.h"
#include "slab/swept_grid.h"
#include "slabhull/cases/case.h"
#include "slabhull/cases/initial.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/slab.h"
#include "slabhull/topology/homology.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

using namespace slabhull;
using specimens::part_is_of;
using specimens::SlabParts;
using specimens::stitched;

namespace {

template<int D>
std::vector<SideOptions> all_sides() {
    if constexpr (D == 2) {
        return {{Split::diagonal}, {Split::centre}};
    } else {
        return {{Split::A}, {Split::B}, {Split::B, Diagonals::smallest_id},
                {Split::C}, {Split::D}, {Split::D, Diagonals::smallest_id},
                {Split::E}};
    }
}

template<int D>
std::vector<specimens::Grid<D>> family() {
    return {specimens::full_box<D>(1), specimens::full_box<D>(3), specimens::box_with_body<D>(),
            specimens::box_with_two_bodies<D>(), specimens::box_with_channel<D>()};
}

template<int D>
SlabParts<D> slab_over(const specimens::Grid<D>& grid, std::vector<double> times,
                       const MotionPointer<D>& motion) {
    IdCounter ids;
    auto cap = specimens::as_cap<D>(grid, ids);
    return specimens::next_slab<D>(std::move(cap), std::move(times), motion, ids);
}

template<int D>
void check_sound(const Hull<D>& hull, const std::vector<std::size_t>& betti) {
    CheckOptions options;
    options.betti_cells = practical_betti_cells;
    const HullReport report = check_hull<D>(hull, options);
    for (const Finding& finding : report.findings) {
        FAIL_CHECK(finding.text);
    }
    if (!betti.empty()) {
        CHECK(report.betti == betti);
    }
}

template<int D>
double smallest_side_angle(const Hull<D>& hull) {
    double smallest = 180;
    for (std::size_t c = hull.initial_cells; c < hull.terminating_begin(); ++c) {
        const auto corners = corners_of<D, D + 1>(hull.cells[c], hull.points);
        smallest = std::min(smallest, dihedral_angles<D, D + 1>(corners).smallest);
    }
    return smallest;
}

/// The diagonals of the side as pairs of tracks, from the earlier point to the later one, by layer.
std::set<std::array<std::int64_t, 3>> diagonals_of(const Hull<3>& hull) {
    std::set<std::array<std::int64_t, 3>> found;
    for (std::size_t c = hull.initial_cells; c < hull.terminating_begin(); ++c) {
        for (const Index a : hull.cells[c]) {
            for (const Index b : hull.cells[c]) {
                const bool both_tracked = hull.track_ids[a] != no_track && hull.track_ids[b] != no_track;
                if (both_tracked && hull.track_ids[a] != hull.track_ids[b] &&
                    hull.points[a][3] < hull.points[b][3]) {
                    found.insert({hull.layer(c), hull.track_ids[a], hull.track_ids[b]});
                }
            }
        }
    }
    return found;
}

struct QuadDiagonal {
    std::int64_t start; ///< absolute track of its earlier end
    double angle = 180; ///< smallest dihedral angle of the tetrahedra that have it
};

/// By layer and the two tracks of each quadrilateral that has a diagonal, whatever the sign of tracks.
std::map<std::array<std::int64_t, 3>, QuadDiagonal> quads_of(const Hull<3>& hull) {
    std::map<std::array<std::int64_t, 3>, QuadDiagonal> quads;
    for (std::size_t c = hull.initial_cells; c < hull.terminating_begin(); ++c) {
        const auto corners = corners_of<3, 4>(hull.cells[c], hull.points);
        for (const Index a : hull.cells[c]) {
            for (const Index b : hull.cells[c]) {
                const auto start = std::abs(hull.track_ids[a]);
                const auto end = std::abs(hull.track_ids[b]);
                const bool tracked = hull.track_ids[a] != no_track && hull.track_ids[b] != no_track;
                if (tracked && start != end && hull.points[a][3] < hull.points[b][3]) {
                    const std::array<std::int64_t, 3> key{hull.layer(c), std::min(start, end),
                                                          std::max(start, end)};
                    auto& quad = quads.try_emplace(key, QuadDiagonal{start}).first->second;
                    quad.angle = std::min(quad.angle, dihedral_angles<3, 4>(corners).smallest);
                }
            }
        }
    }
    return quads;
}

std::size_t starting_at_smallest(const std::set<std::array<std::int64_t, 3>>& diagonals) {
    return static_cast<std::size_t>(
        std::count_if(diagonals.begin(), diagonals.end(), [](const auto& d) { return d[1] < d[2]; }));
}

/// What one rank stitches of a slab. The caps' cells come from the first rank, the sweep's levels from the
/// ranks that have swept its layers.
template<int D>
HullPart<D> part_by_rank(const SlabParts<D>& parts, const SideOptions& side, Communicator& team,
                         HullOrder<D>& order) {
    Sweep<D> sweep = parts.sweep;
    keep_levels(sweep, levels_of_rank(sweep.layers(), team));
    SpatialMesh<D> initial = parts.initial;
    SpatialMesh<D> terminating = parts.terminating;
    leave_cells_on_first(initial, team);
    leave_cells_on_first(terminating, team);
    CapCells<D> first = take_cells(initial, team);
    CapCells<D> last = take_cells(terminating, team);
    CapToStitch<D> begin{initial};
    CapToStitch<D> end{terminating};
    begin.give_cells(first);
    end.give_cells(last);
    IdCounter ids{1'000'000};
    return stitch_part<D>(begin, sweep, end, side, ids, team, order);
}

} // namespace

TEMPLATE_TEST_CASE_SIG(
    "adjacency by construction is that of the soup, for every split, shape and number of layers", "[stitch]",
    ((int D), D), 2, 3) {
    for (const auto& grid : family<D>()) {
        for (const std::vector<double>& times : {std::vector{0.0, 0.5}, std::vector{0.0, 0.2, 0.3, 0.5}}) {
            const auto parts = slab_over<D>(grid, times, specimens::bending_flow<D>());
            for (const SideOptions& side : all_sides<D>()) {
                INFO(split_name(side.split) << ", " << times.size() - 1 << " layers");
                const Hull<D> hull = stitched(parts, side);
                const Adjacency<D> soup = build_adjacency<D>(hull.cells, hull.points.size());
                REQUIRE(soup.defects.empty());
                REQUIRE(hull.neighbors == soup.neighbors);
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("stitched hulls pass the whole check", "[stitch]", ((int D), D), 2, 3) {
    const auto expected = [](std::size_t handles_or_bodies) {
        return D == 2 ? std::vector<std::size_t>{1, 2 * handles_or_bodies, 1}
                      : std::vector<std::size_t>{1, handles_or_bodies, handles_or_bodies, 1};
    };
    for (const SideOptions& side : all_sides<D>()) {
        INFO(split_name(side.split));
        const auto check = [&](const specimens::Grid<D>& grid, const std::vector<std::size_t>& betti) {
            check_sound(stitched(slab_over<D>(grid, {0, 0.25, 0.5}, specimens::bending_flow<D>()), side),
                        betti);
        };
        check(specimens::full_box<D>(2), expected(0));
        check(specimens::box_with_body<D>(), expected(1));
        check(specimens::box_with_two_bodies<D>(), expected(2));
        check(specimens::box_with_channel<D>(), expected(1)); // the double of a solid torus is S2 x S1
    }
}

TEMPLATE_TEST_CASE_SIG("parts of a hull are the whole, row by row, for any number of parts", "[stitch]",
                       ((int D), D), 2, 3) {
    for (const SideOptions& side : all_sides<D>()) {
        for (const auto& grid : {specimens::full_box<D>(1), specimens::box_with_body<D>()}) {
            const SlabParts<D> parts =
                slab_over<D>(grid, {0, 0.1, 0.25, 0.4, 0.5}, specimens::bending_flow<D>());
            const Hull<D> whole = stitched<D>(parts, side);
            for (const int count : {1, 2, 3, 7, 20}) {
                std::size_t cells = 0;
                std::vector<HullPart<D>> made(static_cast<std::size_t>(count));
                std::vector<HullOrder<D>> orders(made.size());
                run_team(count, [&](Communicator& team) {
                    const auto r = static_cast<std::size_t>(team.rank());
                    made[r] = part_by_rank<D>(parts, side, team, orders[r]);
                });
                for (std::size_t r = 0; r < made.size(); ++r) {
                    REQUIRE(made[r].range.first == cells);
                    cells += made[r].range.count;
                    REQUIRE(part_is_of<D>(made[r], whole));
                    REQUIRE(orders[r].facet_patch == whole.facet_patch);
                    REQUIRE(orders[r].side_cells == whole.side_cells);
                    const CapCells<D> cap = terminating_cells_of(made[r], orders[r]);
                    REQUIRE(cap.all == parts.terminating.cells.size());
                    for (std::size_t c = 0; c < cap.cells.size(); ++c) {
                        REQUIRE(cap.cells[c] == parts.terminating.cells[cap.range.first + c]);
                        REQUIRE(cap.neighbors[c] == parts.terminating.neighbors[cap.range.first + c]);
                    }
                }
                REQUIRE(cells == whole.cells.size());
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("ranks refuse a cap that does not fit its boundary, all of them", "[stitch]",
                       ((int D), D), 2, 3) {
    SlabParts<D> parts = slab_over<D>(specimens::box_with_body<D>(), {0, 0.5}, specimens::bending_flow<D>());
    std::swap(parts.terminating.boundary_facets[3][0], parts.terminating.boundary_facets[3][1]);
    std::atomic<int> refused{0};
    CHECK_THROWS_AS(run_team(3,
                             [&](Communicator& team) {
                                 HullOrder<D> order;
                                 try {
                                     part_by_rank<D>(parts, all_sides<D>().front(), team, order);
                                 } catch (const GeometryError&) {
                                     ++refused;
                                     throw;
                                 }
                             }),
                    GeometryError);
    CHECK(refused == 3);
}

TEMPLATE_TEST_CASE_SIG("the number of threads changes no byte", "[stitch]", ((int D), D), 2, 3) {
    const auto parts =
        slab_over<D>(specimens::full_box<D>(12), {0, 0.1, 0.3, 0.5}, specimens::bending_flow<D>());
    for (const SideOptions& side : all_sides<D>()) {
        set_thread_count(1);
        const Hull<D> one = stitched(parts, side);
        set_thread_count(3);
        const Hull<D> three = stitched(parts, side);
        set_thread_count(0);
        CHECK(one.cells == three.cells);
        CHECK(one.neighbors == three.neighbors);
        CHECK(one.points == three.points);
        CHECK(one.vertex_ids == three.vertex_ids);
        CHECK(one.track_ids == three.track_ids);
    }
}

TEST_CASE("diagonals by id start at the smaller track, in every layer", "[stitch]") {
    const auto parts =
        slab_over<3>(specimens::box_with_body<3>(), {0, 0.25, 0.5}, specimens::bending_flow<3>());
    const std::size_t facets = parts.sweep.boundary.facet_count();
    const auto check = [&](Split split, Diagonals kind, std::size_t in_layer) {
        const auto diagonals = diagonals_of(stitched(parts, {split, kind}));
        CHECK(diagonals.size() == 2 * in_layer);
        CHECK(starting_at_smallest(diagonals) == diagonals.size());
    };
    check(Split::A, Diagonals::shape, facets * 3 / 2);
    check(Split::A, Diagonals::smallest_id, facets * 3 / 2);
    check(Split::B, Diagonals::smallest_id, facets);     // all but the paired quadrilaterals
    check(Split::D, Diagonals::smallest_id, facets / 2); // the paired ones
}

TEST_CASE("diagonals by shape make no side worse, and a bent one better", "[stitch]") {
    const auto grid = specimens::box_with_body<3>();
    const auto shear = formula_velocity<3>({"0.9*y", "0.4*z", "-0.7*x"}, {});
    const auto parts = slab_over<3>(grid, {0, 0.25, 0.5}, shear);
    for (const Split split : {Split::B, Split::D}) {
        const Hull<3> by_shape = stitched(parts, {split, Diagonals::shape});
        const Hull<3> by_id = stitched(parts, {split, Diagonals::smallest_id});
        CHECK(by_shape.points == by_id.points);
        CHECK(smallest_side_angle(by_shape) >= smallest_side_angle(by_id) - 1e-6);
        const auto diagonals = diagonals_of(by_shape);
        CHECK(diagonals.size() == diagonals_of(by_id).size());
        CHECK(starting_at_smallest(diagonals) < diagonals.size());
    }
    CHECK(smallest_side_angle(stitched(parts, {Split::B})) >
          smallest_side_angle(stitched(parts, {Split::B, Diagonals::smallest_id})));
}

TEST_CASE("each diagonal by shape has the better angles beside it, and the smaller id where they are equal",
          "[stitch]") {
    const auto shear = formula_velocity<3>({"0.9*y", "0.4*z", "-0.7*x"}, {});
    const auto parts =
        slab_over<3>(specimens::full_box<3>(2), {0, 0.25, 0.5}, GENERATE_COPY(shear, MotionPointer<3>{}));
    auto turned = parts; // with tracks in the other order, diagonals by id are the other ones
    Array<TrackId> tracks(parts.sweep.boundary.tracks().begin(), parts.sweep.boundary.tracks().end());
    for (TrackId& track : tracks) {
        track = -track;
    }
    turned.sweep.boundary = Boundary<3>{parts.sweep.boundary.start_surface(), std::move(tracks)}.bounding(
        parts.initial.vertex_ids,
        {parts.sweep.boundary.mesh_vertices().begin(), parts.sweep.boundary.mesh_vertices().end()});
    for (const Split split : {Split::B, Split::D}) {
        const auto by_shape = quads_of(stitched(parts, {split, Diagonals::shape}));
        const auto by_id = quads_of(stitched(parts, {split, Diagonals::smallest_id}));
        const auto against_id = quads_of(stitched(turned, {split, Diagonals::smallest_id}));
        REQUIRE(by_shape.size() == by_id.size());
        for (const auto& [quad, taken] : by_shape) {
            const double gain = against_id.at(quad).angle - by_id.at(quad).angle;
            const QuadDiagonal& better = gain > 1e-6 ? against_id.at(quad) : by_id.at(quad);
            CHECK(taken.start == better.start);
            CHECK(taken.angle == Approx(better.angle).margin(1e-9));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("a domain that stands has the same side in every slab", "[stitch]", ((int D), D), 2,
                       3) {
    IdCounter ids;
    auto cap = specimens::as_cap<D>(specimens::box_with_body<D>(), ids);
    const auto first = specimens::next_slab<D>(std::move(cap), {0, 1}, nullptr, ids);
    const auto second = specimens::next_slab<D>(first.terminating, {1, 2}, nullptr, ids);
    for (const SideOptions& side : all_sides<D>()) {
        INFO(split_name(side.split));
        const Hull<D> before = stitched(first, side);
        const Hull<D> after = stitched(second, side);
        REQUIRE(before.side_cells == after.side_cells);
        for (std::size_t c = before.initial_cells; c < before.terminating_begin(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                Point<D + 1> later = before.points[before.cells[c][i]];
                later[D] += 1;
                REQUIRE(after.points[after.cells[c][i]] == later);
            }
        }
    }
}

TEST_CASE("a cap that does not fit its boundary is refused", "[stitch]") {
    const auto parts = slab_over<3>(specimens::full_box<3>(2), {0, 0.5}, nullptr);
    const SideOptions side{Split::C};
    SECTION("a boundary facet turned over") {
        auto wrong = parts;
        std::swap(wrong.terminating.boundary_facets[5][0], wrong.terminating.boundary_facets[5][1]);
        CHECK_THROWS_AS(stitched(wrong, side), GeometryError);
    }
    SECTION("a boundary facet too many") {
        auto wrong = parts;
        wrong.initial.boundary_facets.push_back({0, 1, 2});
        CHECK_THROWS_AS(stitched(wrong, side), GeometryError);
    }
    SECTION("a boundary facet given twice instead of another") {
        auto wrong = parts;
        wrong.initial.boundary_facets[0] = wrong.initial.boundary_facets[1];
        CHECK_THROWS_AS(stitched(wrong, side), GeometryError);
    }
    SECTION("a cell cut off from its neighbour") {
        auto wrong = parts;
        auto& row = wrong.terminating.neighbors[3];
        *std::find_if(row.begin(), row.end(), [](Index n) { return n != no_index; }) = no_index;
        CHECK_THROWS_WITH(stitched(wrong, side), Catch::Contains("cell 3"));
    }
    SECTION("a swept boundary with a hole") {
        Surface<3> open = parts.sweep.boundary.start_surface();
        open.facets.pop_back();
        open.patch.pop_back();
        CHECK_THROWS_WITH(Boundary<3>{open}, Catch::Contains("is in 1 triangle"));
    }
}

TEST_CASE(
    "every split builds the turning ellipsoid's hull without a finding, with the Betti numbers of S2 x S1",
    "[stitch]") {
    Case the_case = experiment_at("ellipsoid", 0.3);
    StageClock clock;
    IdCounter ids;
    const SpatialMesh<3> initial = initial_cap<3>(the_case, ids, {}, clock);
    for (const SideOptions& side : all_sides<3>()) {
        INFO(split_name(side.split));
        the_case.split = side.split;
        the_case.diagonals = side.diagonals;
        const auto settings = settings_of<3>(the_case, boundary_of(initial));
        const auto slab =
            build_slab<3>(initial, boundary_of(initial), 0, the_case.level_times(0), settings, ids, clock);
        check_sound(slab.hull, {1, 1, 1, 1});
    }
}

TEST_CASE("a case file names the split and its diagonals", "[stitch]") {
    const auto path = std::filesystem::temp_directory_path() / "slabhull_test_stitch_side.toml";
    const auto read = [&](const std::string& side) {
        std::ofstream{path} << "[initial]\nexperiment = \"ellipsoid\"\n" << side;
        return read_case(path);
    };
    CHECK(read("").split == Split::E);
    for (const char* name : {"A", "B", "C", "D", "E"}) {
        const Case the_case = read("[side]\nsplit = \"" + std::string{name} + "\"\n");
        CHECK(split_name(the_case.split) == name);
        CHECK(the_case.diagonals == Diagonals::shape);
    }
    CHECK(read("[side]\nsplit = \"B\"\ndiagonals = \"smallest-id\"\n").diagonals == Diagonals::smallest_id);
    CHECK_THROWS_WITH(read("[side]\ndiagonals = \"longest\"\n"),
                      Catch::Contains("\"shape\"") && Catch::Contains("\"smallest-id\""));
    CHECK_THROWS_AS(read("[side]\nsplit = \"F\"\n"), UsageError);
    std::filesystem::remove(path);
}

namespace {

/// The sweep as one whose boundary might change. Columns are numbers of boundary vertices by ascending track.
template<int D>
LayeredSweep<D> in_layers(const SlabParts<D>& parts, std::vector<TrackId>& tracks) {
    const Sweep<D>& sweep = parts.sweep;
    tracks.assign(sweep.boundary.tracks().begin(), sweep.boundary.tracks().end());
    std::sort(tracks.begin(), tracks.end());
    std::vector<Index> columns;
    for (const TrackId track : sweep.boundary.tracks()) {
        const auto column = std::lower_bound(tracks.begin(), tracks.end(), track) - tracks.begin();
        columns.push_back(static_cast<Index>(column));
    }
    LayeredSweep<D> layered;
    layered.times = sweep.times;
    for (std::size_t layer = 0; layer < sweep.layers(); ++layer) {
        layered.layers.push_back({sweep.boundary, columns, sweep.positions[layer + 1], {}});
    }
    layered.places = sweep.positions;
    layered.last = sweep.boundary;
    layered.last_columns = columns;
    return layered;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a side made layer by layer is that of a boundary that stays", "[stitch]",
                       ((int D), D), 2, 3) {
    for (const auto& grid : family<D>()) {
        const SlabParts<D> parts = slab_over<D>(grid, {0, 0.25, 0.5, 1}, specimens::bending_flow<D>());
        std::vector<TrackId> tracks;
        const LayeredSweep<D> layered = in_layers(parts, tracks);
        for (const SideOptions& side : all_sides<D>()) {
            INFO(split_name(side.split));
            const Hull<D> expected = stitched(parts, side);
            IdCounter ids{1'000'000};
            const Hull<D> hull = LayeredSide<D>{parts.initial.points.size(), layered, side}.stitch(
                parts.initial, parts.terminating, tracks, ids);
            REQUIRE(hull.points == expected.points);
            REQUIRE(hull.cells == expected.cells);
            REQUIRE(hull.neighbors == expected.neighbors);
            REQUIRE(hull.vertex_ids == expected.vertex_ids);
            REQUIRE(hull.track_ids == expected.track_ids);
            for (std::size_t c = 0; c < hull.cells.size(); ++c) {
                REQUIRE(hull.region(c) == expected.region(c));
                REQUIRE(hull.layer(c) == expected.layer(c));
                REQUIRE(hull.patch(c) == expected.patch(c));
                REQUIRE(hull.prism_end(c) == expected.prism_end(c));
            }
        }
    }
}
