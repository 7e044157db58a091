// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/slice.h"
#include "slabhull/cases/settings.h"

#include "slab/swept_grid.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/initial.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files.h"
#include "slabhull/slab/slab.h"
#include "slabhull/study/exact_measures.h"

#include "io/scratch.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <set>

using namespace slabhull;
using specimens::Claims;
using specimens::SlabParts;
using specimens::stitched;

namespace {

template<int D>
std::vector<SideOptions> one_side_of_each_split() {
    if constexpr (D == 2) {
        return {{Split::diagonal}, {Split::centre}};
    } else {
        return {{Split::A}, {Split::B}, {Split::C}, {Split::D}, {Split::E}};
    }
}

template<int D>
std::vector<specimens::Grid<D>> sliced_grids() {
    return {specimens::full_box<D>(1), specimens::box_with_body<D>(), specimens::box_with_two_bodies<D>(),
            specimens::box_with_channel<D>()};
}

const std::vector<double> levels{1.0, 1.2, 1.3, 1.7};

template<int D>
SlabParts<D> parts_over(const specimens::Grid<D>& grid) {
    IdCounter ids;
    return specimens::next_slab<D>(specimens::as_cap<D>(grid, ids), levels, specimens::bending_flow<D>(),
                                   ids);
}

/// Calls visit(hull, its parts) for each grid of the family and each split.
template<int D, class Visit>
void each_hull(const Visit& visit) {
    for (const auto& grid : sliced_grids<D>()) {
        const auto parts = parts_over<D>(grid);
        for (const SideOptions& side : one_side_of_each_split<D>()) {
            INFO(grid.cells.size() << " cells, split " << split_name(side.split));
            visit(stitched<D>(parts, side), parts);
        }
    }
}

/// Facets by their corners' coordinates, from the smallest corner on: the same for the same oriented surface.
template<int D>
auto facets_in_space(const Surface<D>& surface, double mirror = 1) {
    std::multiset<std::pair<std::array<Point<D>, D>, PatchNumber>> facets;
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        std::array<Point<D>, D> corners;
        for (std::size_t i = 0; i < D; ++i) {
            corners[i] = surface.points[surface.facets[f][i]];
            corners[i][0] *= mirror;
        }
        if (mirror < 0) {
            std::swap(corners[0], corners[1]);
        }
        if (D == 3) { // a rotation keeps the orientation of a triangle, but not that of an edge
            std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        }
        facets.insert({corners, surface.patch[f]});
    }
    return facets;
}

template<int D>
bool same(const Section<D>& a, const Section<D>& b) {
    return a.surface.points == b.surface.points && a.surface.facets == b.surface.facets &&
           a.surface.patch == b.surface.patch && a.neighbors == b.neighbors && a.hull_cell == b.hull_cell &&
           a.vertex_ids == b.vertex_ids && a.track_ids == b.track_ids;
}

/// V - E + F; for curves, V - E.
template<int D>
std::int64_t euler(const Section<D>& section) {
    const auto facets = static_cast<std::int64_t>(section.surface.facets.size());
    const auto vertices = static_cast<std::int64_t>(section.surface.points.size());
    return D == 2 ? vertices - facets : vertices - facets * 3 / 2 + facets;
}

/// Closed, oriented, no pinched vertices, no two vertices in one place, every facet with a measure.
template<int D>
void require_manifold(const Section<D>& section) {
    const Surface<D>& surface = section.surface;
    const auto adjacency = build_adjacency<D - 1>(surface.facets, surface.points.size());
    REQUIRE(adjacency.defects.empty());
    REQUIRE(section.neighbors == adjacency.neighbors);
    if constexpr (D == 3) {
        REQUIRE(examine_manifold<2>(surface.facets, surface.points.size(), adjacency).clean());
    }
    REQUIRE(std::set<Point<D>>(surface.points.begin(), surface.points.end()).size() == surface.points.size());
    for (const Facet<D>& facet : surface.facets) {
        const auto normal = simplex_normal<D - 1>(corners_of<D - 1, D>(facet, surface.points));
        REQUIRE(std::inner_product(normal.begin(), normal.end(), normal.begin(), 0.0) > 0);
    }
}

constexpr double far = 7.3; ///< a number that weights s and 1 - s often fail to give back

/// Whether a point is on a box from 0 to `far`, to the last bit.
template<int D>
bool on_box(const Point<D>& point) {
    return std::any_of(point.begin(), point.end(), [](double x) { return x == 0 || x == 5 * (far / 5); });
}

/// All different times of a hull's vertices.
template<int D>
std::vector<double> vertex_times(const Hull<D>& hull) {
    std::set<double> times;
    for (const auto& point : hull.points) {
        times.insert(point[D]);
    }
    return {times.begin(), times.end()};
}

/// Integral of the sections' measure over the hull's time. Between two times of vertices it is a polynomial
/// of degree D, for which two Gauss points are enough.
template<int D>
double integrated_sections(const Hull<D>& hull) {
    const std::vector<double> breaks = vertex_times(hull);
    std::vector<double> times;
    std::vector<double> weights;
    for (std::size_t k = 1; k < breaks.size(); ++k) {
        const double half = (breaks[k] - breaks[k - 1]) / 2;
        if (half < 1e-12) { // centres at one time but for rounding
            continue;
        }
        for (const double x : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {
            times.push_back(breaks[k - 1] + half + x * half);
            weights.push_back(half);
        }
    }
    double sum = 0;
    auto weight = weights.begin();
    slice_hull<D>(columns_of(hull), times,
                  [&](Section<D>&& section) { sum += *weight++ * measure_section(section).enclosed; });
    return sum;
}

template<int D>
Hull<D> built(const Case& the_case) {
    IdCounter ids;
    StageClock clock;
    const auto initial = initial_cap<D>(the_case, ids, {}, clock);
    return build_slab<D>(initial, boundary_of(initial), 0, the_case.level_times(0),
                         settings_of<D>(the_case, boundary_of(initial)), ids, clock)
        .hull;
}

/// An experiment with so many divisions of the body and layers, in a box meshed coarsely.
Case refined(const std::string& experiment, int divisions, int layers) {
    Case the_case = experiment_at(experiment, 0.3, Bulk::caps);
    auto& bodies = std::get<InitialBodies>(the_case.initial);
    for (EllipsoidBody& body : bodies.ellipsoids) {
        body.frequency = divisions;
    }
    the_case.spacing.reset();
    the_case.layers = layers;
    return the_case;
}

double measure_of(const SectionReport& report, PatchNumber patch) {
    const auto found = std::find_if(report.patches.begin(), report.patches.end(),
                                    [&](const PatchMeasure& each) { return each.number == patch; });
    REQUIRE(found != report.patches.end());
    return found->measure;
}

/// Length or area and enclosed measure of an ellipsoid or ellipse of these experiments at a time.
struct ExactBody {
    double boundary;
    double inside;
};
ExactBody exact_body(const std::string& experiment, double time) {
    using std::numbers::pi;
    const double R = experiment.starts_with("expanding") ? 1 + time / 4 : 1;
    if (experiment.ends_with("circle")) {
        return {2 * pi * R, pi * R * R};
    }
    return experiment == "ellipsoid" ? ExactBody{turning_ellipsoid_measure({1, 3, 2}, 0), 8 * pi}
                                     : ExactBody{4 * pi * R * R, 4 * pi / 3 * R * R * R};
}

/// Errors of the body's boundary and inside in the middle of the first layer, where a turning body is
/// farthest from its own shape.
template<int D>
ExactBody errors(const std::string& experiment, double box, int divisions, int layers) {
    const Hull<D> hull = built<D>(refined(experiment, divisions, layers));
    const double time = 0.5 / layers;
    const SectionReport report = measure_section(slice_hull<D>(columns_of(hull), time));
    const auto exact = exact_body(experiment, time);
    const double inside = std::pow(box, D) - report.enclosed;
    CHECK(report.components == 2);
    CHECK(report.closure < 1e-10);
    CHECK(measure_of(report, patch_number(hull.patches, "walls")) ==
          Approx(2 * D * std::pow(box, D - 1)).epsilon(1e-12));
    return {std::abs(measure_of(report, patch_number(hull.patches, "body")) / exact.boundary - 1),
            std::abs(inside / exact.inside - 1)};
}

/// Halving all spacings, the order tends to 2.
template<int D>
void converge(const std::string& experiment, double box, int divisions) {
    ExactBody before = errors<D>(experiment, box, divisions, 2);
    for (int factor = 2; factor <= 4; factor *= 2) {
        const ExactBody now = errors<D>(experiment, box, factor * divisions, factor * 2);
        const double boundary = std::log2(before.boundary / now.boundary);
        const double inside = std::log2(before.inside / now.inside);
        std::printf("%-18s errors %.3e %.3e, orders %.3f %.3f\n", experiment.c_str(), now.boundary,
                    now.inside, boundary, inside);
        INFO(experiment << ", " << factor * divisions << " divisions");
        CHECK(boundary == Approx(2).margin(0.2));
        CHECK(inside == Approx(2).margin(0.2));
        before = now;
    }
}

/// What slicing refuses, and with which words.
template<class Refusal, int D>
std::string refusal(const Claims<D>& claims, double time, const SliceOptions& options = {}) {
    try {
        slice_hull<D>(claims.columns(), time, options);
    } catch (const Refusal& error) {
        return error.what();
    }
    return {};
}

/// A side cell that lasts from before `time` to after it.
template<int D>
std::size_t cell_across(const Claims<D>& claims, double time) {
    for (std::size_t c = 0; c < claims.cells.size(); ++c) {
        bool before = false;
        bool after = false;
        for (const Index v : claims.cells[c]) {
            before = before || claims.points[v][D] < time;
            after = after || claims.points[v][D] > time;
        }
        if (before && after) {
            return c;
        }
    }
    throw std::logic_error{"no such cell"};
}

} // namespace

TEMPLATE_TEST_CASE_SIG("the section at a level is exactly the boundary of that level, whatever the split",
                       "[slice]", ((int D), D), 2, 3) {
    each_hull<D>([](const Hull<D>& hull, const SlabParts<D>& parts) {
        for (std::size_t level = 0; level < levels.size(); ++level) {
            const Section<D> section = slice_hull<D>(columns_of(hull), levels[level]);
            const Surface<D> boundary = parts.sweep.at(level);
            REQUIRE(facets_in_space(section.surface) == facets_in_space(boundary));
            REQUIRE(section.surface.points.size() == boundary.points.size());
            for (std::size_t v = 0; v < section.vertex_ids.size(); ++v) {
                REQUIRE(section.vertex_ids[v] >= 0);
                REQUIRE(section.track_ids[v] >= 0);
            }
        }
    });
}

TEMPLATE_TEST_CASE_SIG("a time that is a level's but for rounding is that level", "[slice]", ((int D), D), 2,
                       3) {
    const Hull<D> hull =
        stitched<D>(parts_over<D>(specimens::box_with_body<D>()), one_side_of_each_split<D>().back());
    for (const double level : levels) {
        for (const double towards : {0.0, 2.0}) { // which leaves the hull at its ends
            const Section<D> section = slice_hull<D>(columns_of(hull), std::nextafter(level, towards));
            CHECK(same(section, slice_hull<D>(columns_of(hull), level)));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("sections at any time are closed oriented manifolds of the level's topology",
                       "[slice]", ((int D), D), 2, 3) {
    std::mt19937 random{20240};
    std::uniform_real_distribution<double> anywhere{levels.front(), levels.back()};
    each_hull<D>([&](const Hull<D>& hull, const SlabParts<D>&) {
        std::vector<double> times = vertex_times(hull); // the centres' times, too
        for (int k = 0; k < 5; ++k) {
            times.push_back(anywhere(random));
        }
        const Section<D> first = slice_hull<D>(columns_of(hull), levels.front());
        const SectionReport expected = measure_section(first);
        for (const double time : times) {
            INFO("t = " << time);
            const Section<D> section = slice_hull<D>(columns_of(hull), time);
            require_manifold(section);
            const SectionReport report = measure_section(section);
            REQUIRE(euler(section) == euler(first));
            REQUIRE(report.components == expected.components);
            REQUIRE(report.closure < 1e-12 * report.measure);
        }
    });
}

TEMPLATE_TEST_CASE_SIG("sections stay closed when the side's points are moved about in space and time",
                       "[slice]", ((int D), D), 2, 3) {
    std::mt19937 random{77};
    std::uniform_real_distribution<double> jitter{-0.03, 0.03};
    std::uniform_real_distribution<double> anywhere{levels.front(), levels.back()};
    const auto parts = parts_over<D>(GENERATE(specimens::full_box<D>(1), specimens::box_with_body<D>()));
    for (const SideOptions& side : one_side_of_each_split<D>()) {
        Hull<D> hull = stitched<D>(parts, side);
        for (auto& point : hull.points) {
            if (point[D] > levels.front() && point[D] < levels.back()) {
                std::for_each(point.begin(), point.end(), [&](double& x) { x += jitter(random); });
            }
        }
        for (int k = 0; k < 10; ++k) {
            require_manifold(slice_hull<D>(columns_of(hull), anywhere(random)));
            require_manifold(slice_hull<D>(columns_of(hull), hull.points[random() % hull.points.size()][D]));
        }
        if (parts.initial.cells.size() < 10) { // there are as many intervals as points
            REQUIRE(integrated_sections(hull) ==
                    Approx(measure_cells<D>(hull.points, hull.cells).enclosed).epsilon(1e-11));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("the sections' measures add up to what the hull encloses", "[slice]", ((int D), D), 2,
                       3) {
    each_hull<D>([](const Hull<D>& hull, const SlabParts<D>&) {
        REQUIRE(integrated_sections(hull) ==
                Approx(measure_cells<D>(hull.points, hull.cells).enclosed).epsilon(1e-12));
    });
    const Hull<D> body = built<D>(refined(D == 2 ? "expanding-circle" : "ellipsoid", D == 2 ? 40 : 4, 3));
    CHECK(integrated_sections(body) ==
          Approx(measure_cells<D>(body.points, body.cells).enclosed).epsilon(1e-12));
}

TEMPLATE_TEST_CASE_SIG("each facet has the patch and the place of its cell", "[slice]", ((int D), D), 2, 3) {
    const Hull<D> hull = specimens::swept(specimens::box_with_body<D>(), 3);
    for (const double time : {1.0, 1.21, 4.0 / 3, 1.9, 2.0}) {
        const Section<D> section = slice_hull<D>(columns_of(hull), time);
        CHECK(section.surface.patches == hull.patches);
        CHECK(std::is_sorted(section.hull_cell.begin(), section.hull_cell.end()));
        for (std::size_t f = 0; f < section.hull_cell.size(); ++f) {
            REQUIRE(section.surface.patch[f] == hull.patch(section.hull_cell[f]));
        }
        const SectionReport report = measure_section(section);
        REQUIRE(report.patches.size() == 2);
        CHECK(report.patches[0].facets + report.patches[1].facets == report.facets);
        CHECK(report.patches[0].measure + report.patches[1].measure == report.measure);
        CHECK(report.patches[0].measure == Approx(D == 2 ? 20 : 150).epsilon(1e-14)); // the box stands
        CHECK(report.enclosed == Approx(D == 2 ? 24 : 124).epsilon(1e-12));           // the body drifts
        CHECK(report.patches[1].measure == Approx(D == 2 ? 4 : 6).epsilon(1e-12));
    }
}

TEMPLATE_TEST_CASE_SIG("what stands still stays exactly where it is", "[slice]", ((int D), D), 2, 3) {
    Hull<D> hull = specimens::swept(specimens::box_with_body<D>(), 2);
    for (auto& point : hull.points) {
        std::for_each(point.begin(), point.end() - 1, [](double& x) { x *= far / 5; });
    }
    for (int k = 1; k < 60; ++k) {
        const Section<D> section = slice_hull<D>(columns_of(hull), 1 + k / 60.0);
        for (std::size_t f = 0; f < section.hull_cell.size(); ++f) {
            for (const Index v : section.surface.facets[f]) {
                REQUIRE((section.surface.patch[f] == 2 || on_box<D>(section.surface.points[v])));
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("vertices know the tracks that they are on, and those that are the hull's own",
                       "[slice]", ((int D), D), 2, 3) {
    const auto parts = parts_over<D>(specimens::box_with_body<D>());
    const Hull<D> hull = stitched<D>(parts, one_side_of_each_split<D>().front());
    const Section<D> section = slice_hull<D>(columns_of(hull), 1.23);
    std::multiset<TrackId> tracks(section.track_ids.begin(), section.track_ids.end());
    CHECK(tracks.count(no_track) == section.track_ids.size() - parts.sweep.boundary.vertex_count());
    tracks.erase(no_track);
    CHECK(std::set<TrackId>(tracks.begin(), tracks.end()).size() == tracks.size());
    CHECK(
        std::all_of(section.vertex_ids.begin(), section.vertex_ids.end(), [](auto id) { return id == -1; }));
    const Section<D> level = slice_hull<D>(columns_of(hull), levels[1]);
    for (std::size_t v = 0; v < level.vertex_ids.size(); ++v) {
        const auto found = std::find(hull.vertex_ids.begin(), hull.vertex_ids.end(), level.vertex_ids[v]);
        REQUIRE(found != hull.vertex_ids.end());
        const auto at = static_cast<std::size_t>(found - hull.vertex_ids.begin());
        REQUIRE(std::equal(level.surface.points[v].begin(), level.surface.points[v].end(),
                           hull.points[at].begin()));
        REQUIRE(level.track_ids[v] == hull.track_ids[at]);
    }
}

TEMPLATE_TEST_CASE_SIG("a shifted, mirrored or reversed hull has shifted, mirrored or equal sections",
                       "[slice]", ((int D), D), 2, 3) {
    each_hull<D>([](const Hull<D>& hull, const SlabParts<D>&) {
        Hull<D> shifted = hull;
        Hull<D> mirrored = hull;
        Hull<D> reversed = hull;
        for (std::size_t v = 0; v < hull.points.size(); ++v) {
            shifted.points[v][D] += 0.5;
            mirrored.points[v][0] *= -1;
            reversed.points[v][D] *= -1;
        }
        for (std::size_t c = 0; c < hull.cells.size(); ++c) {
            std::swap(mirrored.cells[c][0], mirrored.cells[c][1]);
            std::swap(reversed.cells[c][0], reversed.cells[c][1]);
        }
        for (const double time : {1.0, 1.13, 1.2, 1.5, 1.7}) {
            const Section<D> section = slice_hull<D>(columns_of(hull), time);
            const auto report = measure_section(section);
            const auto later = measure_section(slice_hull<D>(columns_of(shifted), time + 0.5));
            REQUIRE(later.facets == report.facets);
            REQUIRE(later.enclosed == Approx(report.enclosed).epsilon(1e-12));
            REQUIRE(later.measure == Approx(report.measure).epsilon(1e-12));
            const auto reflection = measure_section(slice_hull<D>(columns_of(mirrored), time));
            REQUIRE(reflection.enclosed == Approx(report.enclosed).epsilon(1e-12));
            REQUIRE(reflection.measure == Approx(report.measure).epsilon(1e-12));
            const auto back = measure_section(slice_hull<D>(columns_of(reversed), -time));
            REQUIRE(back.facets == report.facets);
            REQUIRE(back.enclosed == Approx(report.enclosed).epsilon(1e-12));
        }
        // At a level the limits from both sides are one, and a mirror image is one exactly.
        const auto at_level = facets_in_space(slice_hull<D>(columns_of(hull), levels[1]).surface);
        REQUIRE(facets_in_space(slice_hull<D>(columns_of(reversed), -levels[1]).surface) == at_level);
        REQUIRE(facets_in_space(slice_hull<D>(columns_of(mirrored), levels[1]).surface, -1) == at_level);
    });
}

TEMPLATE_TEST_CASE_SIG("a section depends neither on other times nor on the number of threads", "[slice]",
                       ((int D), D), 2, 3) {
    const Hull<D> hull = stitched<D>(parts_over<D>(specimens::full_box<D>(D == 2 ? 100 : 16)),
                                     one_side_of_each_split<D>().back());
    const std::vector<double> times{1.0, 1.05, 1.1, 1.2, 1.25, 1.3, 1.5, 1.69, 1.7};
    set_thread_count(3);
    std::size_t k = 0;
    slice_hull<D>(columns_of(hull), times, [&](Section<D>&& section) {
        set_thread_count(1);
        CHECK(section.time == times[k]);
        CHECK(same(section, slice_hull<D>(columns_of(hull), times[k++])));
        set_thread_count(3);
    });
    set_thread_count(0);
    CHECK(k == times.size());
}

TEST_CASE("sections of the plane experiments converge at order 2", "[slice]") {
    converge<2>("circle", 10, 24);
    converge<2>("expanding-circle", 10, 24);
}

TEST_CASE("sections of the experiments in space converge at order 2", "[slice][long]") {
    converge<3>("sphere", 10, 4);
    converge<3>("expanding-sphere", 10, 4);
    converge<3>("ellipsoid", 16, 5);
}

TEMPLATE_TEST_CASE_SIG("a section comes back from its file", "[slice]", ((int D), D), 2, 3) {
    const scratch::Folder folder;
    const Hull<D> hull = specimens::swept(specimens::box_with_body<D>(), 2);
    const Section<D> section = slice_hull<D>(columns_of(hull), 1.3);
    io::AtomicFile file{folder / "a.vtu"};
    write_section(file, section);
    file.commit();
    const io::Soup soup = io::read_mesh(folder / "a.vtu");
    CHECK(soup.top_dimension() == D - 1);
    CHECK(soup.points.size() == section.surface.points.size());
    const auto& facets = section.surface.facets;
    CHECK(soup.simplices[D - 1].vertices ==
          Array<Index>(facets.front().data(), facets.front().data() + D * facets.size()));
    const auto& patches = std::get<IntegerList>(soup.find_cell_data("patch")->values);
    CHECK(std::equal(patches.begin(), patches.end(), section.surface.patch.begin()));
    CHECK(std::get<Array<double>>(soup.find_field_data("time")->values) == Array<double>{1.3});
    CHECK(std::get<std::vector<std::string>>(soup.find_field_data("patch_name")->values) ==
          std::vector<std::string>{"box", "body"});
}

TEMPLATE_TEST_CASE_SIG("a hull with a hole has no section there, and the cell beside the hole is named",
                       "[slice]", ((int D), D), 2, 3) {
    Claims<D> claims{specimens::swept(specimens::box_with_body<D>(), 2)};
    const std::size_t lost = cell_across(claims, 1.3);
    claims.cells.erase(claims.cells.begin() + static_cast<std::ptrdiff_t>(lost));
    claims.patch.erase(claims.patch.begin() + static_cast<std::ptrdiff_t>(lost));
    SliceOptions options;
    options.cell_number = [](Index cell) { return std::int64_t{cell} + 1000; };
    const std::string words = refusal<GeometryError>(claims, 1.3, options);
    CHECK_THAT(words, Catch::Contains("not closed") && Catch::Contains("open near (") &&
                          Catch::Contains("(patch box)") && Catch::Contains("cell 1"));
    CHECK(refusal<GeometryError>(claims, 1.75).empty()); // the other layer is whole
}

TEMPLATE_TEST_CASE_SIG("cells that are turned over, doubled or all inside out are refused", "[slice]",
                       ((int D), D), 2, 3) {
    const Claims<D> sound{specimens::swept(specimens::box_with_body<D>(), 2)};
    const std::size_t cell = cell_across(sound, 1.3);
    REQUIRE(refusal<Error>(sound, 1.3).empty());

    Claims<D> turned = sound;
    std::swap(turned.cells[cell][0], turned.cells[cell][1]);
    CHECK_THAT(refusal<GeometryError>(turned, 1.3), Catch::Contains("disagree in orientation"));

    Claims<D> doubled = sound;
    doubled.cells.push_back(sound.cells[cell]);
    doubled.patch.push_back(sound.patch[cell]);
    CHECK_THAT(refusal<GeometryError>(doubled, 1.3), Catch::Contains("more than two facets"));

    Claims<D> inside_out = sound;
    for (Simplex<D>& each : inside_out.cells) {
        std::swap(each[0], each[1]);
    }
    CHECK_THAT(refusal<GeometryError>(inside_out, 1.3), Catch::Contains("face inwards"));
}

TEMPLATE_TEST_CASE_SIG("times and arrays that do not fit are refused", "[slice]", ((int D), D), 2, 3) {
    const Claims<D> sound{specimens::swept(specimens::box_with_body<D>(), 2)};
    for (const double time : {0.999, 2.001, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK_THAT(refusal<UsageError>(sound, time), Catch::Contains("outside the hull's [1, 2]"));
    }
    const std::vector<double> falling{1.5, 1.25};
    CHECK_THROWS_AS(slice_hull<D>(sound.columns(), falling, [](Section<D>&&) {}), UsageError);

    Claims<D> stray = sound;
    stray.cells[7][1] = static_cast<Index>(stray.points.size());
    CHECK_THAT(refusal<InputError>(stray, 1.3), Catch::Contains("cell 7 "));
    Claims<D> timeless = sound;
    timeless.points[5][D] = std::nan("");
    CHECK_THAT(refusal<InputError>(timeless, 1.3), Catch::Contains("vertex 5 "));
    Claims<D> short_patch = sound;
    short_patch.patch.pop_back();
    CHECK_THAT(refusal<InputError>(short_patch, 1.3), Catch::Contains("\"patch\""));
}

TEMPLATE_TEST_CASE_SIG("points and cells alone are enough for a section", "[slice]", ((int D), D), 2, 3) {
    const Claims<D> claims{specimens::swept(specimens::box_with_body<D>(), 2)};
    const Section<D> bare = slice_hull<D>(claims.bare(), 1.3);
    const Section<D> full = slice_hull<D>(claims.columns(), 1.3);
    CHECK(bare.surface.facets == full.surface.facets);
    CHECK(bare.surface.points == full.surface.points);
    const SectionReport report = measure_section(bare);
    REQUIRE(report.patches.size() == 1);
    CHECK(report.patches[0].number == 0);
}
