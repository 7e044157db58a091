// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/study/study.h"

#include "slabhull/core/error.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace slabhull;

namespace {

StudyRow row(const std::string& experiment, const std::string& split, int level, std::size_t cells,
             double error) {
    StudyRow result;
    result.experiment = experiment;
    result.split = split;
    result.level = level;
    result.dimension = 3;
    result.counts = {cells, cells / 5};
    result.paper = {cells + 7, cells / 5 + 1};
    result.exact = {100, 10, 20, 30, 40};
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        result.measured[m] = result.exact[m] * (1 + error * static_cast<double>(m + 1));
    }
    result.seconds = {{"cap meshing", 1e-6 * static_cast<double>(cells)},
                      {"checking", 2e-6 * static_cast<double>(cells)}};
    result.cpu_seconds = 1e-5 * static_cast<double>(cells);
    result.peak_bytes = 100 * cells;
    result.mesher_peak_bytes = 10 * cells;
    result.side.histogram[3] = 5;
    result.caps.histogram[17] = 2;
    result.boundary_facets = 2;
    result.layers = 3;
    return result;
}

/// Levels whose errors fall with order 2 in N^(-1/3).
std::vector<StudyRow> rows_of_order_two(const std::string& split) {
    return {row("sphere", split, 1, 1000, 0.01), row("sphere", split, 2, 8000, 0.0025),
            row("sphere", split, 3, 64000, 0.000625)};
}

} // namespace

TEST_CASE("a power law is found again, and there is none for one point or values that are not positive",
          "[study]") {
    CHECK(power_law({{1, 3}, {10, 3 * std::pow(10, 1.5)}, {50, 3 * std::pow(50, 1.5)}}) ==
          std::optional{Approx(1.5).epsilon(1e-12)});
    CHECK(*power_law({{2, 8}, {4, 1}}) == Approx(-3));
    CHECK_FALSE(power_law({{2, 8}}));
    CHECK_FALSE(power_law({}));
    CHECK_FALSE(power_law({{2, 8}, {2, 9}}));
    CHECK_FALSE(power_law({{2, 8}, {4, 0}}));
    CHECK_FALSE(power_law({{2, -8}, {4, 1}}));
}

TEST_CASE("orders and growth are those of the rows, whatever their order", "[study]") {
    auto rows = rows_of_order_two("E");
    std::swap(rows[0], rows[2]);
    const auto all = series_of(rows);
    REQUIRE(all.size() == 1);
    CHECK(all[0].front().level == 1);
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        CHECK(*order_of(all[0], m) == Approx(2).epsilon(1e-9));
    }
    CHECK(*time_growth(all[0]) == Approx(1));
    CHECK(*memory_growth(all[0]) == Approx(1));
}

TEST_CASE("series are parted by experiment and split", "[study]") {
    auto rows = rows_of_order_two("E");
    rows.push_back(row("sphere", "A", 1, 500, 0.02));
    rows.push_back(row("ellipsoid", "E", 1, 500, 0.02));
    const auto all = series_of(rows);
    REQUIRE(all.size() == 3);
    CHECK(all[0].size() == 3);
    CHECK(all[1].front().split == "A");
    CHECK_FALSE(order_of(all[1], 0));
}

TEST_CASE("a row survives the way through text", "[study]") {
    StudyRow before = row("sphere", "E", 2, 12345, 1e-7);
    before.closure = 1.25e-15;
    before.side.angles = {5.5, 150.25};
    before.caps.aspect = {1.5, 12.25};
    before.cells_by_region = {1, 2, 3};
    before.centres = 99;
    const StudyRow after = row_from_text(row_as_text(before));
    CHECK(row_as_text(after) == row_as_text(before));
    CHECK(after.measured == before.measured);
    CHECK(after.side.histogram == before.side.histogram);
    CHECK(after.caps.aspect.largest == 12.25);
    CHECK(after.cells_by_region == before.cells_by_region);
    CHECK(after.seconds == before.seconds);
    CHECK(after.total_seconds() == before.total_seconds());
}

TEST_CASE("names are escaped in the page, and every row of the tables is there", "[study]") {
    auto rows = rows_of_order_two("E");
    rows[1].experiment = rows[0].experiment = rows[2].experiment = "a<b>&\"c\"";
    const std::string page = study_page(rows);
    CHECK(page.find("a<b>") == std::string::npos);
    CHECK(page.find("a&lt;b&gt;&amp;&quot;c&quot;") != std::string::npos);
    CHECK(page.find("64,000") != std::string::npos);
    CHECK(page.find("64,007") != std::string::npos);
    const std::string csv = study_csv(rows);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
}

TEST_CASE("splits are set side by side at the finest level that all have", "[study]") {
    auto rows = rows_of_order_two("E");
    CHECK(study_page(rows).find("side by side") == std::string::npos);
    rows.push_back(row("sphere", "A", 1, 500, 0.02));
    const std::string page = study_page(rows);
    CHECK(page.find("sphere, level 1") != std::string::npos);
    CHECK(study_figures(rows).size() == 9);
}

TEST_CASE("a level is built, measured and counted", "[study]") {
    const StudyRow found = study_level(experiment_case("expanding-circle", 1), std::nullopt);
    CHECK(found.counts.cells == 2 * found.counts.vertices);
    CHECK(found.cells_by_region[0] + found.cells_by_region[1] + found.cells_by_region[2] ==
          found.counts.cells);
    CHECK(found.centres == found.layers * found.boundary_facets);
    const auto angles =
        std::accumulate(found.side.histogram.begin(), found.side.histogram.end(), std::size_t{0});
    CHECK(angles == 3 * found.cells_by_region[1]);
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        CHECK(std::abs(found.error(m)) < 1e-3);
        CHECK(found.error(m) != 0);
    }
}

TEST_CASE("a plot leaves out what a logarithmic axis cannot show", "[study]") {
    auto rows = rows_of_order_two("E");
    rows[1].measured[0] = rows[1].exact[0]; // an error of zero
    for (const StudyFigure& figure : study_figures(rows)) {
        CHECK(figure.svg.find("nan") == std::string::npos);
        CHECK(figure.svg.find("inf") == std::string::npos);
        CHECK(figure.svg.find("</svg>") != std::string::npos);
    }
}
