// SPDX-License-Identifier: BSD-3-Clause
// The six experiments against their exact measures: sizes near the paper's, errors that fall with order 2.
#include "slabhull/slab/check.h"
#include "slabhull/slab/initial.h"
#include "slabhull/slab/slab.h"

#include "slab/exact.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace slabhull;

namespace {

struct Row {
    double cells;
    std::array<double, 5> errors; ///< hull, initial, side, terminating, enclosed; relative
};
constexpr std::array measure_names{"hull", "initial", "side", "terminating", "enclosed"};

template<int D>
Row run_level(const std::string& name, int level) {
    const Case the_case = experiment_case(name, level);
    IdCounter ids;
    StageClock clock;
    const auto initial = initial_cap<D>(the_case, ids, {}, clock);
    const auto settings = settings_of<D>(the_case, boundary_of(initial));
    const Slab<D> slab = build_slab<D>(initial, 0, the_case.level_times(0), settings, ids, clock);
    const HullReport report = check_hull<D>(columns_of(slab.hull));
    REQUIRE(report.clean());
    const auto exact = exact::measures(name);
    const auto relative = [](double ours, double theirs) { return std::abs(ours / theirs - 1); };
    return {static_cast<double>(report.counts.cells),
            {relative(report.measure, exact.hull()), relative(report.measure_by_region[0], exact.initial),
             relative(report.measure_by_region[1], exact.side),
             relative(report.measure_by_region[2], exact.terminating),
             relative(report.enclosed, exact.enclosed)}};
}

/// Slope of log error against log spacing, the spacing being N^(-1/D).
double rate(const std::vector<Row>& rows, std::size_t measure, int dimension) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Row& row : rows) {
        const double x = -std::log(row.cells) / dimension;
        const double y = std::log(row.errors[measure]);
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const auto n = static_cast<double>(rows.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

template<int D>
void converge(const std::string& name, const std::vector<double>& paper_counts, int levels) {
    std::vector<Row> rows;
    for (int level = 1; level <= levels; ++level) {
        rows.push_back(run_level<D>(name, level));
        const double paper = paper_counts[static_cast<std::size_t>(level - 1)];
        INFO(name << " level " << level << ": " << rows.back().cells << " cells, the paper has " << paper);
        CHECK(rows.back().cells / paper == Approx(1).margin(0.05));
    }
    for (std::size_t measure = 0; measure < measure_names.size(); ++measure) {
        const double order = rate(rows, measure, D);
        std::printf("%-18s %-12s rate %.3f, errors", name.c_str(), measure_names[measure], order);
        for (const Row& row : rows) {
            std::printf(" %.3e", row.errors[measure]);
        }
        std::printf("\n");
        INFO(name << ", " << measure_names[measure]);
        CHECK(order > 1.9);
        CHECK(order < 2.2);
    }
}

} // namespace

TEST_CASE("the plane experiments converge at order 2 over levels 1 to 5", "[convergence]") {
    converge<2>("circle", {2714, 5308, 10022, 20142, 38792}, 5);
    converge<2>("expanding-circle", {2696, 5288, 10016, 20086, 38734}, 5);
}

TEST_CASE("the sphere and the expanding sphere converge at order 2 over levels 1 to 3", "[convergence]") {
    converge<3>("sphere", {144431, 368587, 958500}, 3);
    converge<3>("expanding-sphere", {144345, 368477, 958364}, 3);
}

TEST_CASE("the turning ellipsoid converges at order 2 over levels 1 to 3", "[convergence]") {
    converge<3>("ellipsoid", {355798, 944622, 2644079}, 3);
}

TEST_CASE("the tandem ellipsoids converge at order 2 over levels 1 to 3", "[convergence]") {
    converge<3>("tandem-ellipsoids", {603432, 1627918, 4523078}, 3);
}

TEST_CASE("the exact side of a body that stands still is its area", "[convergence]") {
    // Knud Thomsen's formula is good to 1.061 %; the sphere's is exact.
    CHECK(exact::turning_side({1, 1, 1}, 1.5) == Approx(4 * std::acos(-1.0)).epsilon(1e-12));
    CHECK(exact::turning_side({1, 3, 2}, 0) == Approx(48.8822).epsilon(1e-5));
}
