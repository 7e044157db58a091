// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/slice_filling.h"

#include "slab/filled_grid.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/slab/slice.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace slabhull;
using specimens::hull_over;
using specimens::splits;

TEMPLATE_TEST_CASE_SIG("a filling's section has the measure that the hull's encloses", "[slice]",
                       ((int D), D), 2, 3) {
    for (const Split split : splits<D>()) {
        const Hull<D> hull = hull_over<D>(specimens::full_box<D>(3), {split}, 2, true);
        const Filling<D> filling = fill_slab(hull);
        for (const double time : {0.5, 0.53, 0.625, 0.7, 0.75}) {
            INFO(split_name(split) << " at " << time);
            const FillingSection<D> section = slice_filling<D>(columns_of(filling), time);
            const FillingSectionReport report = measure_section(section);
            CHECK(report.smallest_cell > 0);
            CHECK(report.measure ==
                  Approx(measure_section(slice_hull<D>(columns_of(hull), time)).enclosed).epsilon(1e-12));
            CHECK(report.facets_by_attribute.count(1) + report.facets_by_attribute.count(2) == 0);
        }
    }
}

TEMPLATE_TEST_CASE_SIG("a section at a level is the mesh on it", "[slice]", ((int D), D), 2, 3) {
    const Hull<D> hull = hull_over<D>(specimens::full_box<D>(2), {splits<D>().front()}, 2, true);
    const Filling<D> filling = fill_slab(hull);
    for (const double time : {0.5, 0.625, 0.75}) {
        const FillingSection<D> section = slice_filling<D>(columns_of(filling), time);
        CHECK(section.cells.size() == hull.initial_cells); // as many as the caps have
        for (const PointOnEdge& point : section.edge) {
            REQUIRE(point.lower == point.upper);
            REQUIRE(filling.points[point.lower][D] == Approx(time).epsilon(1e-15));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("linear functions of space and time are cut with the mesh", "[slice]", ((int D), D), 2,
                       3) {
    const Filling<D> filling =
        fill_slab(hull_over<D>(specimens::full_box<D>(2), {splits<D>().back()}, 2, true));
    const auto value = [](const auto& x, double t) { return 3 * x[0] - x[1] + 2 * t; };
    const FillingSection<D> section = slice_filling<D>(columns_of(filling), 0.6);
    REQUIRE(section.edge.size() == section.points.size());
    for (std::size_t v = 0; v < section.points.size(); ++v) {
        const auto [lower, upper, share] = section.edge[v];
        const Point<D + 1>& a = filling.points[lower];
        const Point<D + 1>& b = filling.points[upper];
        CHECK(std::lerp(value(a, a[D]), value(b, b[D]), share) ==
              Approx(value(section.points[v], 0.6)).epsilon(1e-13));
    }
}

TEMPLATE_TEST_CASE_SIG("sections do not depend on the number of threads", "[slice]", ((int D), D), 2, 3) {
    const Filling<D> filling =
        fill_slab(hull_over<D>(specimens::full_box<D>(8), {splits<D>().back()}, 4, true));
    set_thread_count(1);
    const FillingSection<D> one = slice_filling<D>(columns_of(filling), 0.61);
    set_thread_count(3);
    const FillingSection<D> three = slice_filling<D>(columns_of(filling), 0.61);
    set_thread_count(0);
    CHECK(one.points == three.points);
    CHECK(one.cells == three.cells);
    CHECK(one.boundary_attribute == three.boundary_attribute);
}

TEMPLATE_TEST_CASE_SIG("a section that is no manifold is refused by cells", "[slice]", ((int D), D), 2, 3) {
    const Filling<D> filling =
        fill_slab(hull_over<D>(specimens::full_box<D>(2), {splits<D>().front()}, 1, true));
    const auto refusal = [](const Filling<D>& faulty, double time) -> std::string {
        try {
            slice_filling<D>(columns_of(faulty), time);
        } catch (const GeometryError& error) {
            REQUIRE_FALSE(error.entities.empty());
            return error.what();
        }
        return "";
    };
    CHECK(refusal(filling, 0.6).empty());

    Filling<D> holed = filling;
    holed.cells.erase(holed.cells.begin() + 5);
    CHECK_THAT(refusal(holed, 0.6), Catch::Contains("no neighbour"));

    Filling<D> doubled = filling;
    doubled.cells.push_back(filling.cells[5]);
    CHECK_THAT(refusal(doubled, 0.6), Catch::Contains("no manifold"));

    Filling<D> lost = filling;
    lost.cells[1][2] = static_cast<Index>(lost.points.size());
    CHECK_THROWS_AS(slice_filling<D>(columns_of(lost), 0.6), InputError);
    CHECK_THROWS_AS(slice_filling<D>(columns_of(filling), 0.76), UsageError);
}
