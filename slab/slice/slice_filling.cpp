// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/slice_filling.h"

#include "core/pieces.h"

#include "slab/check/findings.h"
#include "slab/slice/level.h"
#include "slabhull/core/error.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/slab/slice.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace slabhull {

namespace {

/// A simplex of dimension N - 1 in the cut of one of dimension N.
template<int N>
struct CutPiece {
    std::array<CutPoint, N> corners;
    Index cut_from;
};

/// Sorts, and returns whether that took an odd number of exchanges.
template<class Range, class Before>
bool sort_with_parity(Range& range, const Before& before) {
    bool odd = false;
    for (std::size_t i = 1; i < range.size(); ++i) {
        for (std::size_t j = i; j > 0 && before(range[j], range[j - 1]); --j) {
            std::swap(range[j], range[j - 1]);
            odd = !odd;
        }
    }
    return odd;
}

/// Cuts a simplex with k vertices below the level and m above. The cut points (i, j) on the edges between
/// them are the vertices of a product of two simplices, and each monotone path from (0, 0) to (k - 1, m - 1)
/// is one of its pieces. Pieces of a positive simplex are positive.
template<int N, class TimeOf>
void cut_simplex(const Level& level, const Simplex<N>& simplex, Index number, const TimeOf& time_of,
                 std::vector<CutPiece<N>>& pieces) {
    const auto above = [&](Index v) { return level.above(time_of(v)); };
    const auto k =
        static_cast<std::size_t>(std::count_if(simplex.begin(), simplex.end(), std::not_fn(above)));
    const std::size_t m = simplex.size() - k;
    if (k == 0 || m == 0) {
        return;
    }
    Simplex<N> vertices = simplex;
    const bool odd_order = sort_with_parity(vertices, [&](Index a, Index b) {
        const bool a_above = above(a);
        return a_above != above(b) ? !a_above : a < b;
    });
    // A path has a bit for each step, which is set where the step is among the vertices below.
    for (unsigned path = 0; path < 1U << (N - 1); ++path) {
        if (static_cast<std::size_t>(std::popcount(path)) != k - 1) {
            continue;
        }
        // The orientation: of the vertices in this order, of the steps as an order of the axes.
        bool odd = odd_order != ((m - 1) % 2 != 0);
        CutPiece<N> piece{{}, number};
        std::size_t i = 0;
        std::size_t j = 0;
        for (std::size_t corner = 0; corner < N; ++corner) {
            piece.corners[corner] = level.cut_edge(vertices[i], vertices[k + j], time_of);
            if ((path >> corner & 1U) != 0) {
                odd = odd != (j % 2 != 0);
                ++i;
            } else {
                ++j;
            }
        }
        if (!collapsed(piece.corners)) {
            if (odd) {
                std::swap(piece.corners[0], piece.corners[1]);
            }
            pieces.push_back(piece);
        }
    }
}

template<int N, class TimeOf>
std::vector<CutPiece<N>> cut_simplices(const Level& level, std::span<const Simplex<N>> simplices,
                                       const TimeOf& time_of) {
    constexpr std::size_t grain = 1 << 14;
    return parallel_gather<CutPiece<N>>(
        simplices.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<CutPiece<N>>& pieces) {
            for (std::size_t c = begin; c < end; ++c) {
                cut_simplex<N>(level, simplices[c], static_cast<Index>(c), time_of, pieces);
            }
        });
}

template<int N>
void require_vertices(std::span<const Simplex<N>> simplices, std::size_t count, const char* kind) {
    for (std::size_t c = 0; c < simplices.size(); ++c) {
        for (const Index v : simplices[c]) {
            if (v >= count) {
                throw InputError{fmt::format("{} {} refers to vertex {} of {}", kind, c, v, count),
                                 {{kind, static_cast<std::int64_t>(c), {}}}};
            }
        }
    }
}

template<int D>
class FillingSlicer {
public:
    FillingSlicer(const FillingColumns<D>& filling, const Level& level) : filling_{filling}, level_{level} {
        section_.time = level.time;
    }

    FillingSection<D> run() {
        add_cells();
        add_boundary();
        return std::move(section_);
    }

private:
    double time_of(Index v) const { return filling_.points[v][D]; }
    auto times() const {
        return [this](Index v) { return time_of(v); };
    }

    void add_cells() {
        const auto pieces = cut_simplices<D + 1>(level_, filling_.cells, times());
        if (pieces.empty()) {
            throw GeometryError{fmt::format("no cell of the filling crosses t = {}", level_.time)};
        }
        NumberedCutPoints numbered = number_corners(pieces);
        cut_points_ = std::move(numbered.points);
        for (const CutPoint& point : cut_points_) {
            add_point(point);
        }
        for (std::size_t c = 0; c < pieces.size(); ++c) {
            Simplex<D>& cell = section_.cells.emplace_back();
            std::copy_n(numbered.number.begin() + static_cast<std::ptrdiff_t>(c * (D + 1)), D + 1,
                        cell.begin());
            section_.filling_cell.push_back(pieces[c].cut_from);
        }
    }

    void add_point(const CutPoint& cut) {
        const PlacedCut<D> placed = place_cut<D>(level_, cut, filling_.points);
        section_.points.push_back(placed.point);
        section_.edge.push_back({cut.lower, cut.upper, placed.share});
    }

    void add_boundary() {
        auto adjacency = build_adjacency<D>(section_.cells, section_.points.size());
        using Kind = typename FacetDefect<D>::Kind;
        for (const FacetDefect<D>& defect : adjacency.defects) {
            if (defect.kind != Kind::open) {
                refuse(defect.kind == Kind::overfull ? "more than two cells have a facet"
                                                     : "two cells overlap",
                       defect);
            }
        }
        section_.neighbors = std::move(adjacency.neighbors);
        const auto attributes = cut_facets();
        for (const FacetDefect<D>& open : adjacency.defects) {
            const Index cell = open.cells.front();
            const Neighbors<D>& beside = section_.neighbors[cell];
            for (std::size_t i = 0; i <= D; ++i) {
                Facet<D> facet = outward_facet<D>(section_.cells[cell], static_cast<int>(i));
                Facet<D> ascending = facet;
                std::sort(ascending.begin(), ascending.end());
                if (beside[i] == no_index && ascending == open.facet) {
                    section_.boundary_facets.push_back(facet);
                }
            }
            section_.boundary_attribute.push_back(attribute_of_facet(attributes, open));
        }
        if (!filling_.facets.empty() && attributes.size() != adjacency.defects.size()) {
            throw GeometryError{fmt::format(
                "the section at t = {} has {} facets on its boundary, and the filling's boundary is "
                "cut in {}; `slabhull check` tells what is wrong with the filling",
                level_.time, adjacency.defects.size(), attributes.size())};
        }
    }

    using Attributes = std::vector<std::pair<Facet<D>, FacetAttribute>>;

    /// The cuts of the filling's boundary facets, their vertices ascending, in order.
    Attributes cut_facets() const {
        const Array<FacetAttribute> given = read_column<FacetAttribute>(filling_.facet_attribute);
        Attributes attributes;
        for (const CutPiece<D>& piece : cut_simplices<D>(level_, filling_.facets, times())) {
            Facet<D> facet{};
            for (std::size_t i = 0; i < D; ++i) {
                const auto found = std::lower_bound(cut_points_.begin(), cut_points_.end(), piece.corners[i]);
                facet[i] = found != cut_points_.end() && *found == piece.corners[i]
                               ? static_cast<Index>(found - cut_points_.begin())
                               : no_index;
            }
            std::sort(facet.begin(), facet.end());
            attributes.emplace_back(facet, piece.cut_from < given.size() ? given[piece.cut_from] : 0);
        }
        std::sort(attributes.begin(), attributes.end());
        return attributes;
    }

    FacetAttribute attribute_of_facet(const Attributes& attributes, const FacetDefect<D>& open) const {
        if (filling_.facets.empty()) {
            return 0;
        }
        const auto found =
            std::lower_bound(attributes.begin(), attributes.end(), open.facet,
                             [](const auto& entry, const Facet<D>& facet) { return entry.first < facet; });
        if (found == attributes.end() || found->first != open.facet) {
            refuse("a cell has no neighbour inside the domain", open);
        }
        return found->second;
    }

    [[noreturn]] void refuse(const char* what, const FacetDefect<D>& defect) const {
        std::vector<Entity> entities;
        std::string numbers;
        for (const Index cell : defect.cells) {
            entities.push_back({"cell", section_.filling_cell[cell], {}});
            numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", section_.filling_cell[cell]);
        }
        throw GeometryError{
            fmt::format("the section at t = {} is no manifold: {}, cut from cell {} of the filling; "
                        "`slabhull check` tells what is wrong with it",
                        level_.time, what, numbers),
            entities};
    }

    const FillingColumns<D>& filling_;
    Level level_;
    std::vector<CutPoint> cut_points_; ///< of the section's points
    FillingSection<D> section_;
};

} // namespace

template<int D>
TimeSpan time_span(const FillingColumns<D>& filling) {
    HullColumns<D> vertices;
    vertices.points = filling.points;
    return time_span<D>(vertices);
}

template<int D>
FillingSection<D> slice_filling(const FillingColumns<D>& filling, double time) {
    require_vertices<D + 1>(filling.cells, filling.points.size(), "cell");
    require_vertices<D>(filling.facets, filling.points.size(), "facet");
    const TimeSpan span = time_span<D>(filling);
    if (!span.contains(time)) {
        throw UsageError{
            fmt::format("t = {} is outside the filling's [{}, {}]", time, span.first, span.last)};
    }
    const Level level{time, span.tolerance(), time < span.last - span.tolerance()};
    return FillingSlicer<D>{filling, level}.run();
}

template<int D>
FillingSectionReport measure_section(const FillingSection<D>& section) {
    FillingSectionReport report;
    report.dimension = D;
    report.time = section.time;
    report.vertices = section.points.size();
    report.cells = section.cells.size();
    report.smallest_cell = std::numeric_limits<double>::infinity();
    for (const Simplex<D>& cell : section.cells) {
        const double measure = signed_measure<D>(corners_of<D, D>(cell, section.points));
        report.measure += measure;
        report.smallest_cell = std::min(report.smallest_cell, measure);
    }
    for (const FacetAttribute attribute : section.boundary_attribute) {
        ++report.facets_by_attribute[attribute];
    }
    return report;
}

template TimeSpan time_span<2>(const FillingColumns<2>&);
template TimeSpan time_span<3>(const FillingColumns<3>&);
template FillingSection<2> slice_filling<2>(const FillingColumns<2>&, double);
template FillingSection<3> slice_filling<3>(const FillingColumns<3>&, double);
template FillingSectionReport measure_section<2>(const FillingSection<2>&);
template FillingSectionReport measure_section<3>(const FillingSection<3>&);

} // namespace slabhull
