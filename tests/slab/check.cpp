// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/check.h"
#include "slabhull/topology/homology.h"

#include "slab/parts.h"
#include "slab/require_found.h"
#include "slab/specimens.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/parallel.h"
#include "slabhull/slab/check_parts.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>

using namespace slabhull;
using specimens::Claims;

namespace {

std::string all_texts(const CheckResult& result) {
    std::string text;
    for (const Finding& finding : result.findings) {
        text += std::string{defect_name(finding.what)} + ": " + finding.text + "\n";
    }
    for (const std::string& skipped : result.skipped) {
        text += "skipped " + skipped + "\n";
    }
    return text;
}

/// Just these kinds of findings, each with text and the numbers of what is at fault.
void require_clean(const CheckResult& result) {
    INFO(all_texts(result));
    REQUIRE(result.clean());
    REQUIRE(result.findings.empty());
    REQUIRE(result.skipped.empty());
}

template<int D>
Claims<D> body_claims() {
    return Claims<D>{specimens::swept(specimens::box_with_body<D>(), 2)};
}

/// As a hull in memory has them; entries that fit no table stay out of it.
template<int D>
Array<Neighbors<D>> neighbor_table(const Claims<D>& claims) {
    Array<Neighbors<D>> table(claims.neighbors.size() / (D + 1));
    for (std::size_t k = 0; k < table.size() * (D + 1); ++k) {
        table[k / (D + 1)][k % (D + 1)] = static_cast<Index>(claims.neighbors[k]);
    }
    return table;
}

/// A cell's claimed neighbour; where there is none, the cell itself, which no part takes for a neighbour.
template<int D>
std::uint64_t claimed_neighbor(const Claims<D>& claims, std::size_t cell, std::size_t i) {
    const std::int64_t n = claims.neighbors[cell * (D + 1) + i];
    return n < 0 ? cell : static_cast<std::uint64_t>(n);
}

/// Some cells of a hull as a rank has them.
template<int D>
HullPart<D> part_of(const Claims<D>& claims, const HullRange& range) {
    HullPart<D> part = tests::part_of<D>(
        claims.points, claims.cells,
        [&](std::size_t c, std::size_t i) { return claimed_neighbor(claims, c, i); }, range);
    for (std::size_t v = 0; v < claims.points.size(); ++v) {
        if (part.points_used->contains(v)) {
            part.vertex_ids.push_back(claims.vertex_id[v]);
            part.track_ids.push_back(claims.track_id[v]);
        }
    }
    return part;
}

/// Whether parts can say what a hull says: an index out of range they cannot.
template<int D>
bool can_be_divided(const Claims<D>& claims) {
    const HullColumns<D> columns = claims.columns();
    const auto cells = static_cast<std::int64_t>(claims.cells.size());
    return cells >= 3 && columns.neighbors.given() && claims.vertex_id.size() == claims.points.size() &&
           claims.track_id.size() == claims.points.size() &&
           claims.neighbors.size() == claims.cells.size() * (D + 1) &&
           std::all_of(claims.neighbors.begin(), claims.neighbors.end(),
                       [&](std::int64_t n) { return n >= -1 && n < cells; }) &&
           std::all_of(claims.cells.begin(), claims.cells.end(), [&](const Simplex<D>& cell) {
               return std::all_of(cell.begin(), cell.end(),
                                  [&](Index v) { return v < claims.points.size(); });
           });
}

/// A column's rows of a range.
Column<std::int64_t> rows_within(const Column<std::int64_t>& column, const HullRange& range) {
    if (!column.given()) {
        return {};
    }
    return {range.count, 1, [column, range](std::size_t begin, std::size_t end, std::int64_t* out) {
                column.fill(range.first + begin, range.first + end, out);
            }};
}

/// Ranks must find a hull sound exactly if the check of the whole does, and then with the same figures.
template<int D>
void require_same_in_ranks(const Claims<D>& claims, const HullReport& whole) {
    static int cases = 0;
    if (!can_be_divided(claims) ||
        whole.count(Defect::wrong_vertex_cell) + whole.count(Defect::column_length) > 0) {
        return;
    }
    const int ranks = 2 + cases++ % 3; // what is found must not depend on where parts begin
    std::vector<std::optional<HullReport>> found(static_cast<std::size_t>(ranks));
    run_team(ranks, [&](Communicator& team) {
        const auto r = static_cast<std::size_t>(team.rank());
        const HullRange range = range_of_part(claims.cells.size(), r, found.size());
        const HullPart<D> part = part_of(claims, range);
        HullColumns<D> columns = claims.columns();
        columns.region = rows_within(columns.region, range);
        columns.patch = rows_within(columns.patch, range);
        columns.layer = rows_within(columns.layer, range);
        found[r] = confirm_parts<D>(part, columns, team);
    });
    INFO(all_texts(whole) << "in " << ranks << " ranks");
    for (const std::optional<HullReport>& report : found) {
        REQUIRE(report.has_value() == whole.clean());
        if (report) {
            REQUIRE(report->counts.vertices == whole.counts.vertices);
            REQUIRE(report->counts.edges == whole.counts.edges);
            REQUIRE(report->counts.facets == whole.counts.facets);
            REQUIRE(report->counts.components == whole.counts.components);
            REQUIRE(report->counts.euler == whole.counts.euler);
            REQUIRE(report->measure == whole.measure);
            REQUIRE(report->measure_by_region == whole.measure_by_region);
            REQUIRE(report->enclosed == whole.enclosed);
            REQUIRE(report->closure == whole.closure);
            REQUIRE(report->angles.smallest == whole.angles.smallest);
            REQUIRE(report->cells_by_region == whole.cells_by_region);
            REQUIRE(report->cells_by_patch.size() == whole.cells_by_patch.size());
            REQUIRE(report->layers == whole.layers);
            REQUIRE(report->time == whole.time);
        }
    }
}

/// The check must find the same whether it can compare with a table of neighbours or has to make one.
template<int D>
HullReport check(const Claims<D>& claims) {
    const HullReport report = check_hull<D>(claims.columns());
    const Array<Neighbors<D>> table = neighbor_table(claims);
    HullColumns<D> with_table = claims.columns();
    with_table.neighbor_table = table;
    const HullReport again = check_hull<D>(with_table);
    REQUIRE(all_texts(report) == all_texts(again));
    REQUIRE(report.found == again.found);
    REQUIRE(report.counts.components == again.counts.components);
    require_same_in_ranks(claims, report);
    return report;
}

/// A vertex on the middle level, where no cap is.
template<int D>
Index middle_vertex(const Claims<D>& claims) {
    const auto found = std::find_if(claims.points.begin(), claims.points.end(),
                                    [](const Point<D + 1>& point) { return point[D] == 1.5; });
    return static_cast<Index>(found - claims.points.begin());
}

/// A vertex inside the initial (time 1) or the terminating cap (time 2).
template<int D>
Index inner_vertex(const Claims<D>& claims, double time) {
    Index v = 0;
    while (claims.points[v][D] != time || claims.track_id[v] >= 0) {
        ++v;
    }
    return v;
}

template<int D>
Index boundary_vertex(const Claims<D>& claims, double time) {
    Index v = 0;
    while (claims.points[v][D] != time || claims.track_id[v] < 0) {
        ++v;
    }
    return v;
}

template<int D>
void erase_cell(Claims<D>& claims, std::size_t c) {
    const auto at = static_cast<std::ptrdiff_t>(c);
    claims.cells.erase(claims.cells.begin() + at);
    claims.region.erase(claims.region.begin() + at);
    claims.patch.erase(claims.patch.begin() + at);
    claims.layer.erase(claims.layer.begin() + at);
    claims.renew_neighbors();
}

template<int D>
void append_cell(Claims<D>& claims, const Simplex<D>& cell, std::size_t like) {
    claims.cells.push_back(cell);
    claims.region.push_back(claims.region[like]);
    claims.patch.push_back(claims.patch[like]);
    claims.layer.push_back(claims.layer[like]);
    claims.renew_neighbors();
}

template<int D>
void append_vertex(Claims<D>& claims, const Point<D + 1>& point) {
    claims.points.push_back(point);
    claims.vertex_id.push_back(900000 + static_cast<std::int64_t>(claims.points.size()));
    claims.track_id.push_back(-1);
    claims.cell_of_vertex.push_back(0);
}

/// Vertices and cells in another order.
template<int D>
Claims<D> shuffled(const Claims<D>& claims, unsigned seed) {
    std::mt19937 random{seed};
    std::vector<Index> vertex(claims.points.size());
    std::vector<Index> cell(claims.cells.size());
    std::iota(vertex.begin(), vertex.end(), Index{0});
    std::iota(cell.begin(), cell.end(), Index{0});
    std::shuffle(vertex.begin(), vertex.end(), random);
    std::shuffle(cell.begin(), cell.end(), random);
    Claims<D> result = claims;
    for (std::size_t v = 0; v < vertex.size(); ++v) {
        result.points[vertex[v]] = claims.points[v];
        result.vertex_id[vertex[v]] = claims.vertex_id[v];
        result.track_id[vertex[v]] = claims.track_id[v];
    }
    for (std::size_t c = 0; c < cell.size(); ++c) {
        Simplex<D> renumbered = claims.cells[c];
        for (Index& v : renumbered) {
            v = vertex[v];
        }
        std::rotate(renumbered.begin(), renumbered.begin() + 1, renumbered.begin() + 3); // even
        result.cells[cell[c]] = renumbered;
        result.region[cell[c]] = claims.region[c];
        result.patch[cell[c]] = claims.patch[c];
        result.layer[cell[c]] = claims.layer[c];
    }
    result.renew_neighbors();
    return result;
}

template<int D>
void reverse_all(Claims<D>& claims) {
    for (Simplex<D>& cell : claims.cells) {
        std::swap(cell[0], cell[1]);
    }
    claims.renew_neighbors();
}

template<int D>
double sum(const std::array<double, D>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

} // namespace

TEMPLATE_TEST_CASE_SIG("sound hulls pass, with everything looked at", "", ((int D), D), 2, 3) {
    require_clean(check_hull<D>(columns_of(specimens::swept(specimens::full_box<D>(3), 1))));
    const auto hull = specimens::swept(specimens::box_with_two_bodies<D>(), 3);
    require_clean(check_hull<D>(hull));
    require_clean(check(Claims<D>{hull}));
    require_clean(check(body_claims<D>()));
}

TEMPLATE_TEST_CASE_SIG("the columns of a hull say of any range of cells what the hull says of each", "",
                       ((int D), D), 2, 3) {
    const Hull<D> hull = specimens::swept(specimens::box_with_body<D>(), 3);
    const HullColumns<D> columns = columns_of(hull);
    const std::size_t cells = hull.cells.size();
    const auto compare = [&](std::size_t begin, std::size_t end) {
        std::vector<std::int64_t> region(end - begin), patch(end - begin), layer(end - begin);
        columns.region.fill(begin, end, region.data());
        columns.patch.fill(begin, end, patch.data());
        columns.layer.fill(begin, end, layer.data());
        for (std::size_t c = begin; c < end; ++c) {
            REQUIRE(region[c - begin] == static_cast<std::int64_t>(hull.region(c)));
            REQUIRE(patch[c - begin] == hull.patch(c));
            REQUIRE(layer[c - begin] == hull.layer(c));
        }
    };
    compare(0, cells);
    for (const std::size_t middle :
         {hull.initial_cells, hull.initial_cells + 1, hull.initial_cells + hull.side_cells / 2,
          hull.terminating_begin() - 1, hull.terminating_begin()}) {
        compare(middle, middle);
        compare(middle - 1, std::min(cells, middle + 7));
        compare(middle, cells);
    }
}

TEMPLATE_TEST_CASE_SIG("points and cells alone are checked as far as they go", "", ((int D), D), 2, 3) {
    const auto report = check_hull<D>(body_claims<D>().bare());
    INFO(all_texts(report));
    CHECK(report.clean());
    CHECK(report.skipped.size() == 1);
    CHECK(report.time == std::array<double, 2>{1, 2});
}

TEMPLATE_TEST_CASE_SIG("the report counts and measures", "", ((int D), D), 2, 3) {
    const auto hull = specimens::swept(specimens::full_box<D>(3), 2);
    const auto report = check_hull<D>(hull);
    const double cap = std::pow(3, D);
    const double side = 2 * D * std::pow(3, D - 1);
    CHECK(report.dimension == D);
    CHECK(report.cells_by_region ==
          std::array<std::size_t, 3>{hull.initial_cells, hull.side_cells, hull.initial_cells});
    CHECK(report.measure_by_region[0] == Approx(cap));
    CHECK(report.measure_by_region[1] == Approx(side));
    CHECK(report.measure_by_region[2] == Approx(cap));
    CHECK(report.measure == Approx(2 * cap + side));
    CHECK(report.enclosed == Approx(cap));
    CHECK(report.closure == Approx(0).margin(1e-12));
    CHECK(report.layers == 2);
    REQUIRE(report.cells_by_patch.size() == 1);
    CHECK(report.cells_by_patch[0].number == 1);
    CHECK(report.cells_by_patch[0].cells == hull.side_cells);
    const double flattest =
        D == 2 ? std::atan(0.5) : std::atan(1 / std::sqrt(5.0)); // of the layers of height 1/2
    CHECK(report.angles.smallest == Approx(flattest * 57.29577951308232));
    CHECK(report.counts.euler == (D == 2 ? 2 : 0));
}

TEST_CASE("Betti numbers tell the number of bodies") {
    const CheckOptions with_betti{practical_betti_cells, 20, {}, {}};
    const auto betti = [&](const auto& hull) { return check_hull(columns_of(hull), with_betti).betti; };
    using Numbers = std::vector<std::size_t>;
    CHECK(betti(specimens::swept(specimens::full_box<2>(2), 1)) == Numbers{1, 0, 1});
    CHECK(betti(specimens::swept(specimens::box_with_body<2>(), 2)) == Numbers{1, 2, 1});
    CHECK(betti(specimens::swept(specimens::box_with_two_bodies<2>(), 1)) == Numbers{1, 4, 1});
    CHECK(betti(specimens::swept(specimens::full_box<3>(2), 1)) == Numbers{1, 0, 0, 1});
    CHECK(betti(specimens::swept(specimens::box_with_body<3>(), 2)) == Numbers{1, 1, 1, 1});
    CHECK(betti(specimens::swept(specimens::box_with_two_bodies<3>(), 1)) == Numbers{1, 2, 2, 1});
}

TEST_CASE("Betti numbers of a hull above the wanted size are left out, and that is said") {
    const auto hull = specimens::swept(specimens::full_box<3>(2), 1);
    CheckOptions options;
    CHECK(check_hull(columns_of(hull), options).skipped.empty());
    options.betti_cells = hull.cells.size();
    CHECK(check_hull(columns_of(hull), options).betti.size() == 4);
    --options.betti_cells;
    const HullReport report = check_hull(columns_of(hull), options);
    CHECK(report.betti.empty());
    REQUIRE(report.skipped.size() == 1);
    CHECK(report.skipped[0].find("Betti numbers") == 0);
    CHECK(report.clean());
}

TEMPLATE_TEST_CASE_SIG("the report does not depend on the order of vertices and cells", "", ((int D), D), 2,
                       3) {
    const auto claims = body_claims<D>();
    const auto reference = check(claims);
    for (unsigned seed = 0; seed < 3; ++seed) {
        const auto report = check(shuffled(claims, seed));
        require_clean(report);
        CHECK(report.measure == Approx(reference.measure).epsilon(1e-13));
        CHECK(report.enclosed == Approx(reference.enclosed).epsilon(1e-12));
        CHECK(report.cells_by_region == reference.cells_by_region);
        CHECK(report.counts.edges == reference.counts.edges);
        CHECK(report.layers == 2);
    }
}

TEMPLATE_TEST_CASE_SIG("the report does not depend on the number of threads", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.vertex_id[3] = claims.vertex_id[8];
    claims.patch[claims.first_cell(Region::intermediate)] = 0;
    std::swap(claims.cells[2][0], claims.cells[2][1]);
    set_thread_count(1);
    const auto alone = check(claims);
    set_thread_count(4);
    const auto together = check(claims);
    set_thread_count(0);
    CHECK(alone.measure == together.measure);
    CHECK(alone.enclosed == together.enclosed);
    CHECK(alone.found == together.found);
    CHECK(all_texts(alone) == all_texts(together));
}

TEMPLATE_TEST_CASE_SIG("time may be shifted and space may be turned", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const double enclosed = check(claims).enclosed;
    for (Point<D + 1>& point : claims.points) {
        const double x = point[0];
        point[0] = 0.6 * x - 0.8 * point[1] + 100;
        point[1] = 0.8 * x + 0.6 * point[1];
        point[D] += 1000;
    }
    claims.time = {1001, 1002};
    const auto report = check(claims);
    require_clean(report);
    CHECK(report.enclosed == Approx(enclosed).epsilon(1e-10));
}

TEMPLATE_TEST_CASE_SIG("a mirrored hull is found to face inwards, and nothing else", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const double enclosed = check(claims).enclosed;
    for (Point<D + 1>& point : claims.points) {
        point[0] = -point[0];
    }
    const auto report = check(claims);
    require_found(report, {Defect::inward_orientation});
    CHECK(report.enclosed == Approx(-enclosed));
    reverse_all(claims);
    require_clean(check(claims));
}

// --- planted faults: the columns themselves
// ---------------------------------------------------------------------------

TEMPLATE_TEST_CASE_SIG("no cells", "", ((int D), D), 2, 3) {
    HullColumns<D> nothing;
    require_found(check_hull<D>(nothing), {Defect::no_cells});
}

TEMPLATE_TEST_CASE_SIG("a claim of the wrong length is reported and not used", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.layer.pop_back();
    require_found(check(claims), {Defect::column_length});
    claims = body_claims<D>();
    auto columns = claims.columns();
    columns.neighbors = Column<std::int64_t>::over(std::span{std::as_const(claims.neighbors)}, 1);
    require_found(check_hull<D>(columns), {Defect::column_length});
}

TEMPLATE_TEST_CASE_SIG("a vertex number one too high", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.cells[5][1] = static_cast<Index>(claims.points.size());
    const auto report = check(claims);
    require_found(report, {Defect::index_out_of_range});
    CHECK(report.findings[0].entities[0].kind == "cell");
    CHECK(report.findings[0].entities[0].number == 5);
    CHECK(report.skipped.size() == 1);
}

TEMPLATE_TEST_CASE_SIG("a coordinate that is not a number", "", ((int D), D), 2, 3) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        auto claims = body_claims<D>();
        claims.points[9][D] = bad;
        const auto report = check(claims);
        require_found(report, {Defect::non_finite_coordinate});
        CHECK(report.findings[0].entities[0].number == 9);
    }
}

// --- connectivity
// -----------------------------------------------------------------------------------------------------

TEMPLATE_TEST_CASE_SIG("a cell that names a vertex twice", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    Simplex<D> cell = claims.cells[0];
    cell[1] = cell[0];
    append_cell(claims, cell, 0);
    CHECK(check(claims).count(Defect::repeated_vertex) == 1);
    CHECK(check(claims).count(Defect::degenerate_cell) == 0);
}

TEMPLATE_TEST_CASE_SIG("a cell listed twice", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    append_cell(claims, Simplex<D>{claims.cells[12]}, 12);
    const auto report = check(claims);
    require_found(report, {Defect::duplicate_cell});
    CHECK(report.findings[0].entities[0].number == static_cast<std::int64_t>(claims.cells.size() - 1));
    CHECK(report.findings[0].entities[1].number == 12);
}

TEMPLATE_TEST_CASE_SIG("a vertex in no cell", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    Point<D + 1> point{};
    point.fill(0.123);
    point[D] = 1.25;
    append_vertex(claims, point);
    auto columns = claims.columns();
    columns.cell_of_vertex = {}; // there is none to name
    require_found(check_hull<D>(columns), {Defect::unused_vertex});
}

TEMPLATE_TEST_CASE_SIG("a hole", "", ((int D), D), 2, 3) {
    for (const Region where : {Region::initial, Region::intermediate, Region::terminating}) {
        auto claims = body_claims<D>();
        erase_cell(claims, claims.first_cell(where) + 3);
        const auto report = check(claims);
        require_found(report, {Defect::open_facet});
        CHECK(report.count(Defect::open_facet) == D + 1);
        CHECK(report.findings[0].entities.size() == D + 1); // its vertices, and one cell
    }
}

TEMPLATE_TEST_CASE_SIG("a fin on a facet", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    Simplex<D> fin = claims.cells[claims.first_cell(Region::intermediate)];
    Point<D + 1> tip{};
    tip.fill(0.3);
    tip[D] = 1.3;
    append_vertex(claims, tip);
    fin[0] = static_cast<Index>(claims.points.size() - 1);
    append_cell(claims, fin, claims.first_cell(Region::intermediate));
    const auto report = check(claims);
    CHECK(report.count(Defect::overfull_facet) == 1);
    CHECK(report.count(Defect::open_facet) == D); // the fin's other facets
    CHECK(report.total() == D + 1);
}

TEMPLATE_TEST_CASE_SIG("a cell turned over", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    Simplex<D>& cell = claims.cells[claims.first_cell(Region::intermediate) + 1];
    std::swap(cell[0], cell[1]);
    claims.renew_neighbors();
    const auto report = check(claims);
    require_found(report, {Defect::disoriented_facet});
    CHECK(report.count(Defect::disoriented_facet) == D + 1);
}

TEMPLATE_TEST_CASE_SIG("two vertices of the side made one", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    // Far from each other on the middle level, so that they have no common neighbour.
    const Index kept = middle_vertex(claims);
    Index gone = kept;
    for (Index v = kept; v < claims.points.size(); ++v) {
        gone = claims.points[v][D] == 1.5 ? v : gone;
    }
    for (Simplex<D>& cell : claims.cells) {
        std::replace(cell.begin(), cell.end(), gone, kept);
    }
    claims.renew_neighbors();
    const auto report = check(claims);
    CHECK(report.count(Defect::singular_vertex) == 1);
    CHECK(report.count(Defect::unused_vertex) == 1);
    CHECK(report.count(Defect::singular_edge) == 0);
}

TEST_CASE("a side that touches itself along an edge") {
    auto claims = body_claims<3>();
    // Two edges on the middle level, far apart.
    const auto edge_of = [&](const Simplex<3>& cell) {
        std::vector<Index> on_level;
        std::copy_if(cell.begin(), cell.end(), std::back_inserter(on_level),
                     [&](Index v) { return claims.points[v][3] == 1.5; });
        return on_level;
    };
    const Index begin = claims.first_cell(Region::intermediate);
    const auto end = claims.first_cell(Region::terminating) - 1;
    const auto first = edge_of(claims.cells[begin + 1]);
    const auto second = edge_of(claims.cells[end - 1]);
    REQUIRE(first.size() == 2);
    REQUIRE(second.size() == 2);
    for (Simplex<3>& cell : claims.cells) {
        std::replace(cell.begin(), cell.end(), second[0], first[0]);
        std::replace(cell.begin(), cell.end(), second[1], first[1]);
    }
    claims.renew_neighbors();
    const auto report = check(claims);
    INFO(all_texts(report));
    CHECK(report.count(Defect::singular_edge) == 1);
    CHECK(report.count(Defect::singular_vertex) == 0);
}

TEST_CASE("a handle on the side is told by the Euler characteristic alone") {
    auto claims = body_claims<2>();
    const Index victim = claims.first_cell(Region::intermediate) + 40;
    const Simplex<2> hole = claims.cells[victim];
    // A torus of 5 x 5 squares, opened at its first triangle, shrunk to the middle of the victim.
    constexpr Index n = 5;
    std::vector<Index> number(n * n);
    for (Index v = 0; v < n * n; ++v) {
        const double a = 6.283185307179586 * (v % n) / n, b = 6.283185307179586 * (v / n) / n;
        Point<3> point{};
        for (std::size_t x = 0; x < 3; ++x) {
            for (const Index w : hole) {
                point[x] += claims.points[w][x] / 3;
            }
        }
        point[0] += 0.01 * (2 + std::cos(a)) * std::cos(b);
        point[1] += 0.01 * (2 + std::cos(a)) * std::sin(b);
        point[2] += 0.01 * std::sin(a);
        append_vertex(claims, point);
        number[v] = static_cast<Index>(claims.points.size() - 1);
    }
    Array<Simplex<2>> torus;
    for (Index y = 0; y < n; ++y) {
        for (Index x = 0; x < n; ++x) {
            const Index a = number[y * n + x], b = number[y * n + (x + 1) % n];
            const Index c = number[(y + 1) % n * n + (x + 1) % n], d = number[(y + 1) % n * n + x];
            torus.push_back({a, b, c});
            torus.push_back({a, c, d});
        }
    }
    const Simplex<2> lid = torus[0];
    const Index outer[3] = {hole[0], hole[1], hole[2]};
    // A tube from the hole's edges to the lid's, which run the same way round.
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        append_cell(claims, {outer[k], outer[next], lid[k]}, victim);
        append_cell(claims, {outer[next], lid[next], lid[k]}, victim);
    }
    torus.erase(torus.begin());
    for (Simplex<2> triangle : torus) {
        std::swap(triangle[0], triangle[1]); // the lid is seen from inside the torus
        append_cell(claims, triangle, victim);
    }
    erase_cell(claims, victim);
    const auto report = check(claims);
    INFO(all_texts(report));
    CHECK(report.count(Defect::euler_mismatch) == 1);
    CHECK(report.count(Defect::singular_vertex) + report.count(Defect::open_facet) +
              report.count(Defect::disoriented_facet) ==
          0);
}

// --- shape
// ------------------------------------------------------------------------------------------------------------

TEMPLATE_TEST_CASE_SIG("two vertices in one place", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index a = middle_vertex(claims);
    Index b = a;
    for (Index v = a; v < claims.points.size(); ++v) {
        b = claims.points[v][D] == 1.5 ? v : b;
    }
    claims.points[b] = claims.points[a];
    const auto report = check(claims);
    require_found(report, {Defect::coincident_vertices});
    CHECK(report.findings[0].entities[0].number == a);
    CHECK(report.findings[0].entities[1].number == b);
}

/// Gives times in another unit.
template<class Claims>
void scale_times(Claims& claims, double unit) {
    for (auto& point : claims.points) {
        point.back() *= unit;
    }
    for (double& time : *claims.time) {
        time *= unit;
    }
}

TEMPLATE_TEST_CASE_SIG("a cell without a measure", "", ((int D), D), 2, 3) {
    // A new vertex in the middle of a cell's facet on the side cuts the two cells there, one of the parts
    // flat.
    const double unit =
        GENERATE(1.0, 0x1p-30, 0x1p-60, 0x1p40); // of time: layers much shorter or longer than edges
    auto claims = body_claims<D>();
    scale_times(claims, unit);
    REQUIRE(check(claims).clean());
    const Index victim =
        claims.first_cell(Region::intermediate) + 1; // none of its facets is within an instant
    const Simplex<D> cell = claims.cells[victim];
    Point<D + 1> middle{};
    for (std::size_t x = 0; x <= D; ++x) {
        for (std::size_t i = 1; i <= D; ++i) {
            middle[x] += claims.points[cell[i]][x] / D;
        }
    }
    append_vertex(claims, middle);
    const auto centre = static_cast<Index>(claims.points.size() - 1);
    for (std::size_t i = 1; i <= D; ++i) {
        Simplex<D> part = cell;
        part[i] = centre;
        append_cell(claims, part, victim);
    }
    claims.cells[victim][0] = centre; // the flat part
    claims.renew_neighbors();
    const auto report = check(claims);
    require_found(report, {Defect::degenerate_cell});
    CHECK(report.total() == 1);
}

TEMPLATE_TEST_CASE_SIG("coordinates so large that nothing can be summed", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    for (Point<D + 1>& point : claims.points) {
        for (std::size_t x = 0; x < D; ++x) {
            point[x] *= 1e200;
        }
    }
    CHECK(check(claims).count(Defect::not_closed) == 1);
}

TEMPLATE_TEST_CASE_SIG("a cap folded over itself", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.points[inner_vertex(claims, 2)][0] += 1.6; // beyond the next vertex
    const auto report = check(claims);
    require_found(report, {Defect::inverted_cell});
}

// --- time and regions
// -------------------------------------------------------------------------------------------------

TEMPLATE_TEST_CASE_SIG("a slab without a duration", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    for (Point<D + 1>& point : claims.points) {
        point[D] = 1;
    }
    auto columns = claims.bare();
    CHECK(check_hull<D>(columns).count(Defect::no_duration) == 1);
}

TEMPLATE_TEST_CASE_SIG("slab times at which there are no caps", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.time = {1, 2.5};
    require_found(check(claims), {Defect::wrong_slab_time});
}

TEMPLATE_TEST_CASE_SIG("a side vertex later than the slab's end", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index v = middle_vertex(claims);
    claims.points[v][D] = 2.25;
    const auto report = check(claims);
    require_found(report, {Defect::time_outside_slab});
    CHECK(report.findings[0].entities[0].number == v);
}

TEMPLATE_TEST_CASE_SIG("a terminating cap at no single time", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    for (Point<D + 1>& point : claims.points) {
        point[D] += point[D] == 2 ? 0.01 * point[0] : 0;
    }
    auto columns = claims.columns();
    columns.time.reset();
    require_found(check_hull<D>(columns), {Defect::missing_cap});
}

TEMPLATE_TEST_CASE_SIG("a cap vertex out of the cap's time", "", ((int D), D), 2, 3) {
    for (const double time : {1.0, 2.0}) {
        auto claims = body_claims<D>();
        claims.points[inner_vertex(claims, time)][D] = 1.5;
        require_found(check(claims), {Defect::cap_not_flat});
    }
}

TEMPLATE_TEST_CASE_SIG("cells claimed for the wrong region", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.region[0] = 2;
    claims.region[claims.cells.size() - 1] = 1;
    claims.region[claims.cells.size() - 2] = 17;
    const auto report = check(claims);
    require_found(report, {Defect::wrong_region});
    CHECK(report.count(Defect::wrong_region) == 3);
}

TEMPLATE_TEST_CASE_SIG("a side cell within an instant", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index victim = claims.first_cell(Region::intermediate);
    for (const Index v : claims.cells[victim]) {
        claims.points[v][D] = 1.25;
    }
    auto columns = claims.bare();
    CHECK(check_hull<D>(columns).count(Defect::flat_side_cell) >= 1);
}

// --- boundary and tracks
// ----------------------------------------------------------------------------------------------

TEMPLATE_TEST_CASE_SIG("a boundary vertex that has lost its track", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index v = boundary_vertex(claims, 1);
    claims.track_id[v] = -1;
    const auto report = check(claims);
    require_found(report,
                  {Defect::untracked_boundary, Defect::track_incomplete}); // the track's rest has no start
}

TEMPLATE_TEST_CASE_SIG("vertices inside the caps may have tracks, also ones that end, but each time once", "",
                       ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.track_id[inner_vertex(claims, 1)] = 5000;
    CHECK(check(claims).clean());
    const Index end = inner_vertex(claims, 2);
    claims.track_id[end] = 5000;
    CHECK(check(claims).clean());
    Index other = end + 1; // inside the terminating cap, too
    while (claims.points[other][D] != claims.points[end][D] || claims.track_id[other] >= 0) {
        ++other;
    }
    claims.track_id[other] = 5000;
    const auto report = check(claims);
    require_found(report, {Defect::track_repeats_time});
    CHECK(report.findings[0].entities[0].number == 5000);
}

TEMPLATE_TEST_CASE_SIG("a vertex inside a cap on a track of the boundary", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index victim = inner_vertex(claims, 2);
    claims.track_id[victim] = claims.track_id[boundary_vertex(claims, 1)];
    const auto report = check(claims);
    require_found(report, {Defect::stray_track, Defect::track_repeats_time});
    CHECK(report.count(Defect::stray_track) == 1);
}

TEMPLATE_TEST_CASE_SIG("two vertices of a track at one time", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index v = middle_vertex(claims);
    const auto track = claims.track_id[v];
    Index other = v + 1;
    while (claims.points[other][D] != 1.5) {
        ++other;
    }
    claims.track_id[other] = track;
    auto columns = claims.columns();
    columns.patch = {}; // a side over wrong tracks has wrong patches
    const auto report = check_hull<D>(columns);
    require_found(report, {Defect::track_repeats_time});
    CHECK(report.findings[0].entities[0].kind == "track");
    CHECK(report.findings[0].entities[0].number == track);
}

TEMPLATE_TEST_CASE_SIG("a track that ends on the way", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.track_id[middle_vertex(claims)] = 4001; // a track of its own, of one vertex
    auto columns = claims.columns();
    columns.patch = {};
    require_found(check_hull<D>(columns), {Defect::track_incomplete});
}

TEMPLATE_TEST_CASE_SIG("a terminating boundary whose tracks are permuted", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index a = boundary_vertex(claims, 2);
    Index b = a;
    for (Index v = 0; v < claims.points.size(); ++v) {
        b = claims.points[v][D] == 2 && claims.track_id[v] >= 0 ? v : b;
    }
    std::swap(claims.track_id[a], claims.track_id[b]);
    auto columns = claims.columns();
    columns.patch = {};
    const auto report = check_hull<D>(columns);
    require_found(report, {Defect::boundary_facet_lost, Defect::boundary_facet_added});
    CHECK(report.count(Defect::boundary_facet_lost) == report.count(Defect::boundary_facet_added));
}

TEMPLATE_TEST_CASE_SIG("a terminating boundary with a facet cut in two", "", ((int D), D), 2, 3) {
    // A new vertex in the middle of a boundary edge of the terminating cap cuts all cells at that edge.
    auto claims = Claims<D>{specimens::swept(specimens::full_box<D>(2), 1)};
    const Index a = boundary_vertex(claims, 2);
    Index b = no_index;
    for (const Simplex<D>& cell : claims.cells) {
        const bool side =
            std::any_of(cell.begin(), cell.end(), [&](Index v) { return claims.points[v][D] == 1; });
        for (const Index v : cell) {
            const bool has_a = std::find(cell.begin(), cell.end(), a) != cell.end();
            b = side && has_a && v != a && claims.points[v][D] == 2 ? v : b;
        }
    }
    REQUIRE(b != no_index);
    Point<D + 1> middle{};
    for (std::size_t x = 0; x <= D; ++x) {
        middle[x] = (claims.points[a][x] + claims.points[b][x]) / 2;
    }
    append_vertex(claims, middle);
    const auto centre = static_cast<Index>(claims.points.size() - 1);
    const std::size_t count = claims.cells.size();
    for (std::size_t c = 0; c < count; ++c) {
        Simplex<D> cell = claims.cells[c];
        const auto at_a = std::find(cell.begin(), cell.end(), a);
        const auto at_b = std::find(cell.begin(), cell.end(), b);
        if (at_a != cell.end() && at_b != cell.end()) {
            claims.cells[c][static_cast<std::size_t>(at_a - cell.begin())] = centre;
            *at_b = centre;
            append_cell(claims, cell, c);
        }
    }
    claims.renew_neighbors();
    auto with_track = claims;
    const auto report = check(claims);
    require_found(report, {Defect::untracked_boundary}); // a vertex was added

    with_track.track_id[centre] = 99999; // and it does not help to claim that it was there all the time
    const auto found = check(with_track);
    INFO(all_texts(found));
    CHECK(found.count(Defect::track_incomplete) == 1);
    CHECK(found.count(Defect::boundary_facet_added) > found.count(Defect::boundary_facet_lost));
    CHECK(found.count(Defect::boundary_facet_lost) > 0);
}

TEST_CASE("a boundary component whose image is turned inside out") {
    // The tracks of a square's mirror image: the same facets, each the other way round.
    auto claims = Claims<2>{specimens::swept(specimens::full_box<2>(1), 1)};
    std::map<std::array<double, 2>, std::int64_t> track;
    for (Index v = 0; v < claims.points.size(); ++v) {
        if (claims.points[v][2] == 1) {
            track[{claims.points[v][0], claims.points[v][1]}] = claims.track_id[v];
        }
    }
    for (Index v = 0; v < claims.points.size(); ++v) {
        if (claims.points[v][2] == 2) {
            claims.track_id[v] = track.at({1 - claims.points[v][0], claims.points[v][1]});
        }
    }
    auto columns = claims.columns();
    columns.patch = {};
    const auto report = check_hull<2>(columns);
    require_found(report, {Defect::boundary_facet_reversed});
    CHECK(report.count(Defect::boundary_facet_reversed) == 4);
}

// --- claims
// -----------------------------------------------------------------------------------------------------------

TEMPLATE_TEST_CASE_SIG("ids that are negative or given twice", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.vertex_id[4] = -7;
    require_found(check(claims), {Defect::negative_vertex_id});
    claims = body_claims<D>();
    claims.vertex_id[4] = claims.vertex_id[2];
    const auto report = check(claims);
    require_found(report, {Defect::duplicate_vertex_id});
    CHECK(report.findings[0].entities[0].number == 2);
    CHECK(report.findings[0].entities[1].number == 4);
}

TEMPLATE_TEST_CASE_SIG("a cap cell with a patch, a side cell without", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.patch[1] = 2;
    claims.patch[claims.first_cell(Region::intermediate) + 2] = 0;
    claims.patch[claims.first_cell(Region::intermediate) + 3] = -1;
    const auto report = check(claims);
    require_found(report, {Defect::wrong_patch});
    CHECK(report.count(Defect::wrong_patch) == 3);
}

TEMPLATE_TEST_CASE_SIG("a patch that is not in the list", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.patches.pop_back();
    const auto report = check(claims);
    require_found(report, {Defect::unknown_patch});
    CHECK(report.findings[0].entities[0].kind == "patch");
    CHECK(report.findings[0].entities[0].number == 2);
}

TEMPLATE_TEST_CASE_SIG("a prism whose cells are not of one patch", "", ((int D), D), 2, 3) {
    const auto sound = body_claims<D>();
    const Index begin = sound.first_cell(Region::intermediate);
    for (Index k = 0; k < D; ++k) {
        auto claims = sound;
        claims.patch[begin + k] = 3 - claims.patch[begin + k];
        const auto report = check(claims);
        require_found(report, {Defect::patch_mismatch});
        CHECK(report.count(Defect::patch_mismatch) == 1);
    }
}

TEMPLATE_TEST_CASE_SIG("layers on caps, below zero, exchanged", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index begin = claims.first_cell(Region::intermediate);
    claims.layer[0] = 0;
    claims.layer[begin] = -1;
    claims.layer[begin + 1] = 1; // it is in layer 0
    const auto report = check(claims);
    require_found(report, {Defect::wrong_layer});
    CHECK(report.count(Defect::wrong_layer) == 3);
}

TEMPLATE_TEST_CASE_SIG("layers that leave a gap", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    for (std::int64_t& layer : claims.layer) {
        layer = layer == 1 ? 2 : layer;
    }
    require_found(check(claims), {Defect::layer_gap});
    claims = body_claims<D>();
    for (std::int64_t& layer : claims.layer) {
        layer = layer >= 0 ? 1 - layer : layer; // in reverse
    }
    CHECK(check(claims).count(Defect::layer_gap) > 0);
}

TEMPLATE_TEST_CASE_SIG("neighbours that are not the ones across the facet", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    claims.neighbors[6 * (D + 1) + 1] = 6;
    claims.neighbors[7 * (D + 1)] = -1;
    const auto report = check(claims);
    require_found(report, {Defect::wrong_neighbor});
    CHECK(report.count(Defect::wrong_neighbor) == 2);
    CHECK(report.findings[0].entities[0].number == 6);
}

TEMPLATE_TEST_CASE_SIG("a vertex whose cell does not use it", "", ((int D), D), 2, 3) {
    auto claims = body_claims<D>();
    const Index v = middle_vertex(claims);
    claims.cell_of_vertex[v] = 0;
    claims.cell_of_vertex[0] = -1;
    claims.cell_of_vertex[1] = static_cast<std::int64_t>(claims.cells.size());
    const auto report = check(claims);
    require_found(report, {Defect::wrong_vertex_cell});
    CHECK(report.count(Defect::wrong_vertex_cell) == 3);
}

// --- the report
// -------------------------------------------------------------------------------------------------------

TEST_CASE("findings are told in the user's numbers, so many of a kind and all counted") {
    auto claims = body_claims<3>();
    erase_cell(claims, 10);
    for (std::int64_t& id : claims.vertex_id) {
        id = -1;
    }
    CheckOptions options;
    options.most_findings = 3;
    options.vertex_number = [](Index v) { return std::int64_t{v} + 1; };
    options.cell_number = [](Index c) { return std::int64_t{c} + 5001; };
    const auto report = check_hull<3>(claims.columns(), options);
    CHECK(report.count(Defect::negative_vertex_id) == claims.points.size());
    CHECK(report.count(Defect::open_facet) == 4);
    CHECK(report.findings.size() == 6);
    for (const Finding& finding : report.findings) {
        for (const Entity& entity : finding.entities) {
            CHECK(entity.number >= (entity.kind == "cell" ? 5001 : 1));
        }
    }
}

TEST_CASE("each defect has a name of its own in kebab case") {
    std::set<std::string_view> names;
    for (std::size_t kind = 0; kind < defect_kinds; ++kind) {
        const std::string_view name = defect_name(static_cast<Defect>(kind));
        CHECK(names.insert(name).second);
        CHECK(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string_view::npos);
        CHECK_FALSE(name.empty());
    }
}

TEST_CASE("claims at random are survived") {
    for (unsigned seed = 0; seed < 30; ++seed) {
        std::mt19937 random{seed};
        auto claims = Claims<3>{specimens::swept(specimens::full_box<3>(2), 2)};
        const auto spoil = [&](std::vector<std::int64_t>& values) {
            for (std::int64_t& value : values) {
                value = random() % 10 == 0 ? static_cast<std::int64_t>(random()) - (1 << 30) : value;
            }
        };
        for (auto* values : {&claims.region, &claims.patch, &claims.layer, &claims.neighbors,
                             &claims.vertex_id, &claims.track_id, &claims.cell_of_vertex}) {
            spoil(*values);
        }
        for (Simplex<3>& cell : claims.cells) {
            cell[random() % 4] = static_cast<Index>(random() % claims.points.size());
        }
        const auto report = check(claims);
        CHECK_FALSE(report.clean());
    }
}
