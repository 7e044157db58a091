// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/slice.h"

#include "core/pieces.h"
#include "core/place_in_words.h"
#include "slab/check/findings.h"
#include "slab/slice/active_cells.h"
#include "slab/slice/cut_table.h"
#include "slab/slice/level.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/manifold.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <map>
#include <numeric>

namespace slabhull {

namespace {

template<int D>
struct CutFacet {
    std::array<CutPoint, D> corners;
    Index cell;
};

/// Cuts one hull at level after level.
template<int D>
class Slicer {
public:
    Slicer(const HullColumns<D>& hull, const SliceOptions& options)
        : hull_{hull}, options_{options}, vertex_id_{read_column<PersistentId>(hull.vertex_id)},
          track_{read_column<TrackId>(hull.track_id)}, patch_{read_column<PatchNumber>(hull.patch)} {}

    Section<D> cut(const Level& level, std::span<const Index> cells) const {
        Section<D> section;
        section.time = level.time;
        section.surface.patches = hull_.patches;
        const std::vector<CutFacet<D>> facets = cut_cells(level, cells);
        if (facets.empty()) {
            throw GeometryError{fmt::format("no cell of the hull crosses t = {}", level.time)};
        }
        add_facets(section, facets, add_points(section, level, facets));
        close(section);
        return section;
    }

private:
    std::vector<CutFacet<D>> cut_cells(const Level& level, std::span<const Index> cells) const {
        constexpr std::size_t grain = 1 << 14;
        return parallel_gather<CutFacet<D>>(
            cells.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<CutFacet<D>>& facets) {
                for (std::size_t k = begin; k < end; ++k) {
                    cut_cell(level, cells[k], facets);
                }
            });
    }

    void cut_cell(const Level& level, Index cell, std::vector<CutFacet<D>>& facets) const {
        const Simplex<D>& vertices = hull_.cells[cell];
        unsigned upper = 0;
        for (std::size_t i = 0; i <= D; ++i) {
            upper |= static_cast<unsigned>(level.above(time_of(vertices[i]))) << i;
        }
        const CellCut<D>& cut = cut_table<D>[upper];
        for (std::size_t f = 0; f < cut.count; ++f) {
            CutFacet<D> facet{{}, cell};
            for (std::size_t i = 0; i < D; ++i) {
                facet.corners[i] =
                    level.cut_edge(vertices[cut.facets[f][i].lower], vertices[cut.facets[f][i].upper],
                                   [&](Index v) { return time_of(v); });
            }
            if (!collapsed(facet.corners)) {
                facets.push_back(facet);
            }
        }
    }

    double time_of(Index vertex) const { return hull_.points[vertex][D]; }

    /// Returns the number of each corner of each facet.
    std::vector<Index> add_points(Section<D>& section, const Level& level,
                                  const std::vector<CutFacet<D>>& facets) const {
        NumberedCutPoints numbered = number_corners(facets);
        for (const CutPoint& point : numbered.points) {
            add_point(section, level, point);
        }
        return std::move(numbered.number);
    }

    void add_point(Section<D>& section, const Level& level, const CutPoint& cut) const {
        section.surface.points.push_back(place_cut<D>(level, cut, hull_.points).point);
        const bool is_vertex = cut.lower == cut.upper;
        section.vertex_ids.push_back(is_vertex && !vertex_id_.empty() ? vertex_id_[cut.lower] : -1);
        const bool on_track = !track_.empty() && track_[cut.lower] == track_[cut.upper];
        section.track_ids.push_back(on_track ? track_[cut.lower] : no_track);
    }

    void add_facets(Section<D>& section, const std::vector<CutFacet<D>>& facets,
                    const std::vector<Index>& number) const {
        for (std::size_t f = 0; f < facets.size(); ++f) {
            Facet<D>& facet = section.surface.facets.emplace_back();
            std::copy_n(number.begin() + static_cast<std::ptrdiff_t>(f * D), D, facet.begin());
            section.hull_cell.push_back(facets[f].cell);
            section.surface.patch.push_back(patch_.empty() ? 0 : patch_[facets[f].cell]);
        }
    }

    /// Finds the section's adjacency; throws an error that tells where the section is not closed.
    void close(Section<D>& section) const {
        auto adjacency = build_adjacency<D - 1>(section.surface.facets, section.surface.points.size());
        if (!adjacency.defects.empty()) {
            refuse(section, adjacency.defects);
        }
        section.neighbors = std::move(adjacency.neighbors);
        Array<Index> all(section.surface.facets.size());
        std::iota(all.begin(), all.end(), Index{0});
        if (const double enclosed = enclosed_by<D>(section.surface, all); !(enclosed > 0)) {
            throw GeometryError{
                fmt::format("the section at t = {} encloses {:.6g}: the hull's cells face inwards",
                            section.time, enclosed)};
        }
    }

    [[noreturn]] void refuse(const Section<D>& section,
                             const std::vector<FacetDefect<D - 1>>& defects) const {
        using Kind = typename FacetDefect<D - 1>::Kind;
        const FacetDefect<D - 1>& first = defects.front();
        const char* what = first.kind == Kind::open       ? "it is open"
                           : first.kind == Kind::overfull ? "more than two facets meet"
                                                          : "two facets disagree in orientation";
        std::vector<Entity> entities;
        std::vector<std::int64_t> numbers;
        for (const Index f : first.cells) {
            const Index cell = section.hull_cell[f];
            numbers.push_back(options_.cell_number ? options_.cell_number(cell) : cell);
            entities.push_back(
                {"cell", numbers.back(), patch_name(section.surface.patches, section.surface.patch[f])});
        }
        throw GeometryError{
            fmt::format("the section at t = {} is not closed: {} near {}, at cell{} {} (patch {}) of the "
                        "hull; {} such place{}. `slabhull check` tells what is wrong with the hull",
                        section.time, what, place_in_words(section.surface.points[first.facet[0]]),
                        numbers.size() > 1 ? "s" : "", fmt::join(numbers, ", "), entities.front().patch,
                        defects.size(), defects.size() > 1 ? "s" : ""),
            entities};
    }

    const HullColumns<D>& hull_;
    const SliceOptions& options_;
    Array<PersistentId> vertex_id_; ///< these three are empty when not given
    Array<TrackId> track_;
    Array<PatchNumber> patch_;
};

void require_rows(const Column<std::int64_t>& column, std::size_t rows, const char* name) {
    if (column.given() && (column.rows() != rows || column.components() != 1)) {
        throw InputError{fmt::format("\"{}\" has {} rows of {}, expected {} of 1", name, column.rows(),
                                     column.components(), rows)};
    }
}

template<int D>
void require_fitting(const HullColumns<D>& hull, const SliceOptions& options) {
    require_rows(hull.vertex_id, hull.points.size(), "vertex_id");
    require_rows(hull.track_id, hull.points.size(), "track_id");
    require_rows(hull.patch, hull.cells.size(), "patch");
    const auto names_no_vertex = [&](Index v) { return v >= hull.points.size(); };
    const auto bad = std::find_if(hull.cells.begin(), hull.cells.end(), [&](const Simplex<D>& cell) {
        return std::any_of(cell.begin(), cell.end(), names_no_vertex);
    });
    if (bad != hull.cells.end()) {
        const auto cell = static_cast<Index>(bad - hull.cells.begin());
        const std::int64_t number = options.cell_number ? options.cell_number(cell) : cell;
        throw InputError{fmt::format("cell {} names a vertex that does not exist", number),
                         {{"cell", number, {}}}};
    }
}

void require_times(std::span<const double> times, const TimeSpan& span) {
    for (std::size_t k = 0; k < times.size(); ++k) {
        if (!span.contains(times[k])) {
            throw UsageError{
                fmt::format("t = {} is outside the hull's [{}, {}]", times[k], span.first, span.last)};
        }
        if (k > 0 && !(times[k - 1] < times[k])) {
            throw UsageError{
                fmt::format("the times of sections must ascend: {} comes after {}", times[k], times[k - 1])};
        }
    }
}

} // namespace

double TimeSpan::tolerance() const {
    constexpr double ulps = 4;
    return ulps * std::numeric_limits<double>::epsilon() * std::max(std::abs(first), std::abs(last));
}

template<int D>
TimeSpan time_span(const HullColumns<D>& hull) {
    if (hull.points.empty()) {
        throw InputError{"the hull has no vertices"};
    }
    TimeSpan span{hull.points[0][D], hull.points[0][D]};
    for (std::size_t v = 0; v < hull.points.size(); ++v) {
        const Point<D + 1>& point = hull.points[v];
        if (!std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); })) {
            throw InputError{fmt::format("vertex {} has a coordinate that is not finite", v),
                             {{"vertex", static_cast<std::int64_t>(v), {}}}};
        }
        span = {std::min(span.first, point[D]), std::max(span.last, point[D])};
    }
    return span;
}

template<int D>
void slice_hull(const HullColumns<D>& hull, std::span<const double> times,
                const std::function<void(Section<D>&&)>& use, const SliceOptions& options) {
    require_fitting(hull, options);
    const TimeSpan span = time_span(hull);
    require_times(times, span);
    const double tolerance = span.tolerance();
    const Slicer<D> slicer{hull, options};
    ActiveCells<D> active{hull, times, tolerance};
    for (std::size_t k = 0; k < times.size(); ++k) {
        const Level level{times[k], tolerance, times[k] < span.last - tolerance};
        use(slicer.cut(level, active.at(k)));
    }
}

template<int D>
Section<D> slice_hull(const HullColumns<D>& hull, double time, const SliceOptions& options) {
    Section<D> result;
    slice_hull<D>(
        hull, {&time, 1}, [&](Section<D>&& section) { result = std::move(section); }, options);
    return result;
}

template<int D>
SectionReport measure_section(const Section<D>& section) {
    const Surface<D>& surface = section.surface;
    SectionReport report;
    report.dimension = D;
    report.time = section.time;
    report.vertices = surface.points.size();
    report.facets = surface.facets.size();
    report.components = count_components<D - 1>(section.neighbors);
    std::map<PatchNumber, PatchMeasure> patches;
    Point<D> sum{};
    Array<Index> all(surface.facets.size());
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        const Point<D> normal =
            simplex_normal<D - 1>(corners_of<D - 1, D>(surface.facets[f], surface.points));
        PatchMeasure& patch = patches[surface.patch[f]];
        ++patch.facets;
        patch.measure += norm(normal);
        std::transform(sum.begin(), sum.end(), normal.begin(), sum.begin(), std::plus<>{});
        all[f] = static_cast<Index>(f);
    }
    for (auto& [number, patch] : patches) {
        patch.number = number;
        report.measure += patch.measure;
        report.patches.push_back(patch);
    }
    report.enclosed = enclosed_by<D>(surface, all);
    report.closure = norm(sum);
    return report;
}

template TimeSpan time_span<2>(const HullColumns<2>&);
template TimeSpan time_span<3>(const HullColumns<3>&);
template void slice_hull<2>(const HullColumns<2>&, std::span<const double>,
                            const std::function<void(Section<2>&&)>&, const SliceOptions&);
template void slice_hull<3>(const HullColumns<3>&, std::span<const double>,
                            const std::function<void(Section<3>&&)>&, const SliceOptions&);
template Section<2> slice_hull<2>(const HullColumns<2>&, double, const SliceOptions&);
template Section<3> slice_hull<3>(const HullColumns<3>&, double, const SliceOptions&);
template SectionReport measure_section<2>(const Section<2>&);
template SectionReport measure_section<3>(const Section<3>&);

} // namespace slabhull
