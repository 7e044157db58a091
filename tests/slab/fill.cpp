// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/fill.h"

#include "slab/fill/mend_cells.h"
#include "slab/filled_grid.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/filling_quality.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

using namespace slabhull;
using specimens::hull_over;
using specimens::splits;
using specimens::turn;

namespace {

template<int D>
void require_clean(const Filling<D>& filling, const Hull<D>& hull) {
    const FillingReport report = check_filling<D>(columns_of(filling), &hull);
    INFO(findings_as_text(report));
    REQUIRE(report.clean());
    CHECK(report.boundary_facets == hull.cells.size());
    CHECK(report.volume == Approx(check_hull<D>(columns_of(hull)).enclosed).epsilon(1e-12));
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a slab over a grid is filled, whatever the split of its side", "[fill]", ((int D), D),
                       2, 3) {
    for (const Split split : splits<D>()) {
        for (const std::size_t layers : {1u, 3u}) {
            for (const bool turns : {false, true}) {
                INFO(split_name(split)
                     << " with " << layers << " layers, " << (turns ? "turning" : "at rest"));
                const Hull<D> hull = hull_over<D>(specimens::full_box<D>(3), {split}, layers, turns);
                require_clean(fill_slab(hull), hull);
            }
        }
    }
}

namespace {

template<int D>
struct Planted {
    Hull<D> hull = hull_over<D>(specimens::full_box<D>(2), {splits<D>().back()}, 2, true);
    Filling<D> filling = fill_slab(hull);

    FillingReport check() const { return check_filling<D>(columns_of(filling), &hull); }
    /// Without claims that the plant made stale.
    FillingReport check_bare() const {
        FillingColumns<D> columns = columns_of(filling);
        columns.neighbors = {};
        return check_filling<D>(columns, &hull);
    }
    /// A cell on the hull, and the place of its facet there.
    std::pair<std::size_t, std::size_t> outer() const {
        for (std::size_t c = 0;; ++c) {
            for (std::size_t i = 0; i <= D + 1; ++i) {
                if (filling.neighbors[c][i] == no_index) {
                    return {c, i};
                }
            }
        }
    }
    std::size_t inner() const {
        std::size_t c = 0;
        while (std::find(filling.neighbors[c].begin(), filling.neighbors[c].end(), no_index) !=
               filling.neighbors[c].end()) {
            ++c;
        }
        return c;
    }
};

void require_found(const FillingReport& report, std::vector<Defect> expected) {
    INFO(findings_as_text(report));
    for (std::size_t kind = 0; kind < defect_kinds; ++kind) {
        const auto what = static_cast<Defect>(kind);
        INFO(defect_name(what));
        REQUIRE((report.count(what) > 0) ==
                (std::find(expected.begin(), expected.end(), what) != expected.end()));
    }
}

} // namespace

TEMPLATE_TEST_CASE_SIG("each defect of a filling is found", "[fill]", ((int D), D), 2, 3) {
    Planted<D> planted;
    Filling<D>& filling = planted.filling;
    require_found(planted.check(), {});

    SECTION("a cell on the hull is missing") {
        filling.cells.erase(filling.cells.begin() + static_cast<std::ptrdiff_t>(planted.outer().first));
        const auto report = planted.check_bare();
        require_found(report, {Defect::hull_facet_lost, Defect::hull_facet_added});
        CHECK(report.count(Defect::hull_facet_lost) + report.count(Defect::hull_facet_added) == D + 2);
    }
    SECTION("a cell inside is missing") {
        filling.cells.erase(filling.cells.begin() + static_cast<std::ptrdiff_t>(planted.inner()));
        const auto report = planted.check_bare();
        require_found(report, {Defect::hull_facet_added});
        CHECK(report.count(Defect::hull_facet_added) == D + 2);
    }
    SECTION("a cell is inside out") {
        const std::size_t victim = planted.inner();
        std::swap(filling.cells[victim][0], filling.cells[victim][1]);
        std::swap(filling.neighbors[victim][0], filling.neighbors[victim][1]);
        const auto report = planted.check();
        require_found(report, {Defect::inverted_cell, Defect::disoriented_facet, Defect::volume_mismatch});
        CHECK(report.count(Defect::disoriented_facet) == D + 2);
    }
    SECTION("a facet of the hull is seen from outside") {
        for (std::size_t c = 0; c < filling.cells.size(); ++c) {
            std::swap(filling.cells[c][0], filling.cells[c][1]);
        }
        require_found(planted.check_bare(), {Defect::inverted_cell, Defect::hull_facet_reversed});
    }
    SECTION("a cell is there twice") {
        filling.cells.push_back(filling.cells[planted.inner()]);
        require_found(planted.check_bare(), {Defect::overfull_facet, Defect::volume_mismatch});
    }
    SECTION("a vertex is unused") {
        filling.points.push_back(filling.points.front());
        filling.points.back()[0] += 0.01;
        require_found(planted.check(), {Defect::unused_vertex});
    }
    SECTION("a crack: a cell has a vertex of its own at the place of another") {
        const std::size_t victim = planted.inner();
        filling.points.push_back(filling.points[filling.cells[victim][0]]);
        filling.cells[victim][0] = static_cast<Index>(filling.points.size() - 1);
        require_found(planted.check_bare(), {Defect::coincident_vertices, Defect::hull_facet_added});
    }
    SECTION("a vertex is elsewhere than in the hull, by the last bit") {
        double& x = filling.points[0][0];
        x = std::nextafter(x, 10.0);
        require_found(planted.check(), {Defect::hull_vertex_moved});
    }
    SECTION("a vertex has left its star") {
        Point<D + 1>& point = filling.points.back(); // a cell's centre
        point[0] += 1;
        require_found(planted.check(), {Defect::inverted_cell});
    }
    SECTION("a flat cell") {
        const auto [c, place] = planted.outer();
        const Simplex<D + 1> cell = filling.cells[c]; // its vertex off the hull goes to the facet's first
        filling.points[cell[place]] = filling.points[cell[place == 0 ? 1 : 0]];
        CHECK(planted.check().count(Defect::degenerate_cell) > 0);
        CHECK(planted.check().count(Defect::coincident_vertices) > 0);
    }
    SECTION("a wrong attribute") {
        filling.facet_attribute.back() = 3;
        require_found(planted.check(), {Defect::wrong_attribute});
    }
    SECTION("a facet of the boundary is not listed") {
        filling.facets.pop_back();
        filling.facet_attribute.pop_back();
        require_found(planted.check(), {Defect::hull_facet_added});
        require_found(planted.check_bare(), {Defect::hull_facet_added});
    }
    SECTION("a listed facet is turned round") {
        std::swap(filling.facets[1][0], filling.facets[1][1]);
        require_found(planted.check(), {Defect::hull_facet_reversed});
        require_found(planted.check_bare(), {Defect::hull_facet_reversed});
    }
    SECTION("a wrong neighbour") {
        filling.neighbors[7][1] = 8;
        require_found(planted.check(), {Defect::wrong_neighbor});
    }
    SECTION("a cell names a vertex that there is not") {
        filling.cells[3][2] = static_cast<Index>(filling.points.size());
        require_found(planted.check(), {Defect::index_out_of_range});
    }
    SECTION("a coordinate that is no number") {
        filling.points.back()[1] = std::nan("");
        require_found(planted.check(), {Defect::non_finite_coordinate});
    }
    SECTION("a cell names a vertex twice") {
        filling.cells[5][0] = filling.cells[5][1];
        CHECK(planted.check_bare().count(Defect::repeated_vertex) == 1);
    }
}

namespace {

template<int D>
FillingReport check_cells(const specimens::Grid<D + 1>& mesh) {
    FillingColumns<D> columns;
    columns.points = mesh.points;
    columns.cells = mesh.cells;
    return check_filling<D>(columns);
}

/// Cells around one vertex that go round it twice: over a ring of eight, whose second turn is farther out,
/// between poles on the other axes. All are positive and paired, and the boundary is one sphere.
template<int N>
specimens::Grid<N> double_star() {
    constexpr Index ring = 8;
    specimens::Grid<N> star;
    star.points.assign(1 + ring, Point<N>{});
    for (Index k = 0; k < ring; ++k) {
        const double radius = k < 4 ? 1 : 1.5;
        star.points[1 + k][0] = radius * std::cos(1.5708 * k);
        star.points[1 + k][1] = radius * std::sin(1.5708 * k);
    }
    for (std::size_t axis = 2; axis < N; ++axis) {
        for (const double side : {1.0, -1.0}) {
            star.points.push_back({});
            star.points.back()[axis] = side;
        }
    }
    for (Index k = 0; k < ring; ++k) {
        for (Index sides = 0; sides < Index{1} << (N - 2); ++sides) {
            Simplex<N> cell{0, 1 + k, 1 + (k + 1) % ring};
            for (Index axis = 2; axis < N; ++axis) {
                cell[axis + 1] = 1 + ring + 2 * (axis - 2) + (sides >> (axis - 2) & 1);
            }
            if (signed_measure<N>(corners_of<N, N>(cell, star.points)) < 0) {
                std::swap(cell[0], cell[1]);
            }
            star.cells.push_back(cell);
        }
    }
    return star;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("vertices that cells do not lie around once are found", "[fill]", ((int D), D), 2, 3) {
    constexpr int N = D + 1;
    using Cube = std::array<Index, N>;
    require_found(check_cells<D>(specimens::grid<N>(3, [](const Cube&) { return true; })), {});
    SECTION("cells go round a vertex twice") {
        const FillingReport report = check_cells<D>(double_star<N>());
        require_found(report, {Defect::singular_vertex});
        CHECK(report.count(Defect::singular_vertex) == 1 + 2 * (D - 1)); // the poles too
        CHECK(report.findings.front().entities.front().number == 0);
        CHECK_THAT(report.findings.front().text, Catch::Contains("2 times"));
    }
    SECTION("two boxes meet in a vertex") {
        const auto corners = specimens::grid<N>(2, [](const Cube& at) {
            return std::all_of(at.begin(), at.end(), [&](Index k) { return k == at[0]; });
        });
        const FillingReport report = check_cells<D>(corners);
        require_found(report, {Defect::singular_boundary_vertex});
        CHECK(report.count(Defect::singular_boundary_vertex) == 1);
    }
    SECTION("two boxes meet in what two facets of the boundary share") {
        const auto boxes = specimens::grid<N>(2, [](const Cube& at) {
            return at[0] == at[1] && std::all_of(at.begin() + 2, at.end(), [](Index k) { return k == 0; });
        });
        CHECK(check_cells<D>(boxes).count(Defect::singular_boundary_ridge) > 0);
    }
}

TEMPLATE_TEST_CASE_SIG("a slab that turns too far in one layer is refused, naming cell and layer", "[fill]",
                       ((int D), D), 2, 3) {
    Hull<D> hull = hull_over<D>(specimens::full_box<D>(2), {splits<D>().front()}, 1, false);
    const std::size_t begin = hull.terminating_points_begin();
    for (std::size_t v = begin; v < hull.points.size(); ++v) { // half a turn about the middle
        hull.points[v][0] = 2 - hull.points[v][0];
        hull.points[v][1] = 2 - hull.points[v][1];
    }
    try {
        fill_slab(hull);
        FAIL("filled");
    } catch (const GeometryError& error) {
        CHECK_THAT(error.what(), Catch::Contains("more layers") && Catch::Contains("in layer 0"));
        REQUIRE(error.entities.size() >= 2);
        CHECK(error.entities[0].kind == "cell");
        CHECK(error.entities[1].kind == "layer");
        CHECK_THAT(error.what(), Catch::Contains("vertices on the hull"));
    }
}

TEMPLATE_TEST_CASE_SIG("centres and inner vertices that turned cells inside out are moved back", "[fill]",
                       ((int D), D), 2, 3) {
    const Hull<D> hull = hull_over<D>(specimens::full_box<D>(3), {splits<D>().back()}, 2, true);
    Filling<D> filling = fill_slab(hull);
    Filling<D> places;
    const SlabColumns<D> columns = slab_columns(hull, places);
    SECTION("the apex of a cone") {
        filling.points.back()[0] += 1.5;
        filling.points.back()[D] += 0.1;
    }
    SECTION("the centre of a wall or cell, on the hull") {
        filling.points[filling.points.size() - filling.steiner_points] = hull.points.front();
    }
    SECTION("a vertex on the level between the layers") {
        filling.points[filling.hull_points][0] += 1.5;
    }
    const double level = filling.points[filling.hull_points][D];
    REQUIRE_FALSE(not_positive(filling).empty());
    mend_cells(not_positive(filling), columns.cells.size(), columns.layers(), filling);
    require_clean(filling, hull);
    CHECK(filling.points[filling.hull_points][D] == level);
}

TEMPLATE_TEST_CASE_SIG("where no place helps, vertices of the hull stay and the cells are left", "[fill]",
                       ((int D), D), 2, 3) {
    Hull<D> hull = hull_over<D>(specimens::full_box<D>(3), {splits<D>().back()}, 1, true);
    Filling<D> filling = fill_slab(hull);
    Filling<D> places;
    const SlabColumns<D> columns = slab_columns(hull, places);
    filling.points.front()[0] += 2; // beyond the kernel of any star
    const auto before = filling.points;
    mend_cells(not_positive(filling), columns.cells.size(), columns.layers(), filling);
    CHECK_FALSE(not_positive(filling).empty());
    CHECK(std::equal(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(filling.hull_points),
                     filling.points.begin()));
}

TEMPLATE_TEST_CASE_SIG("a regular simplex over a cap has the best quality, for the layer lasts an edge",
                       "[fill]", ((int D), D), 2, 3) {
    // Edges of 2 over the cap at t = 0; the tip is as high as a regular simplex over it, if t = 1 is an edge.
    Filling<D> filling;
    if constexpr (D == 2) {
        filling.points = {
            {0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3), 0}, {1, 1 / std::sqrt(3), std::sqrt(2.0 / 3)}};
        filling.cells = {{0, 1, 2, 3}};
        filling.facets = {{0, 1, 2}};
    } else {
        const double a = std::sqrt(0.5);
        filling.points = {
            {a, a, a, 0}, {a, -a, -a, 0}, {-a, a, -a, 0}, {-a, -a, a, 0}, {0, 0, 0, std::sqrt(5.0 / 8)}};
        filling.cells = {{0, 1, 2, 3, 4}};
        filling.facets = {{0, 1, 2, 3}};
    }
    filling.facet_attribute = {1};
    filling.time = {0, 1};
    if (!(signed_measure<D + 1>(corners_of<D + 1, D + 1>(filling.cells[0], filling.points)) > 0)) {
        std::swap(filling.cells[0][0], filling.cells[0][1]);
    }
    const double regular = std::acos(1.0 / (D + 1)) * 180 / std::acos(-1.0);
    const FillingQuality best = filling_quality(filling, 1);
    CHECK(best.time_scale == Approx(2));
    CHECK(best.smallest == Approx(1).epsilon(1e-6));
    CHECK(best.angles.smallest == Approx(regular));
    CHECK(best.angles.largest == Approx(regular));
    const FillingQuality longer = filling_quality(filling, 2); // twice as high
    CHECK(longer.smallest < 0.9);
    CHECK(longer.angles.smallest < regular - 3);
    CHECK(longer.angles.largest > regular + 3);
}

TEST_CASE("TetGen fills a hull in 2D + t whatever its caps and its split", "[fill]") {
    if (!has_mesher(SolidMesher::tetgen)) {
        WARN("a build without TetGen");
        return;
    }
    for (const Split split : splits<2>()) {
        const Hull<2> hull = hull_over<2>(specimens::box_with_body<2>(), {split}, 3, true);
        for (const double scale : {0.0, 2.0, 3.3}) {
            INFO(split_name(split) << " with time scale " << scale);
            StageClock clock;
            const Filling<2> filling = fill_unstructured(hull, clock, {scale});
            require_clean(filling, hull);
            CHECK(filling.facets == hull.cells);
            CHECK(filling.track_ids.size() == filling.points.size());
            CHECK(filling.vertex_ids.size() == filling.points.size());
        }
    }
    StageClock clock;
    const Hull<2> hull = hull_over<2>(specimens::full_box<2>(2), {Split::centre}, 1, false);
    CHECK_THROWS_AS(fill_unstructured(hull, clock, {-1.0}), UsageError);
    CHECK_THROWS_AS(fill_unstructured(hull, clock, {std::nan("")}), UsageError);
}

TEMPLATE_TEST_CASE_SIG("a filling does not depend on the number of threads", "[fill]", ((int D), D), 2, 3) {
    const Hull<D> hull = hull_over<D>(specimens::full_box<D>(4), {splits<D>().back()}, 3, true);
    set_thread_count(1);
    const Filling<D> alone = fill_slab(hull);
    set_thread_count(4);
    const Filling<D> together = fill_slab(hull);
    set_thread_count(0);
    CHECK(alone.points == together.points);
    CHECK(alone.cells == together.cells);
    CHECK(alone.neighbors == together.neighbors);
}
