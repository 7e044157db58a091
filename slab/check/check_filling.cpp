// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/check_filling.h"

#include "core/pieces.h"
#include "slab/check/check_shape.h"
#include "slab/check/filling_links.h"
#include "slab/check/findings.h"
#include "slabhull/geometry/simplex_sign.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_survey = 1 << 14;

/// A facet by its vertices in ascending order, with the parity of its original order.
template<int D>
struct SortedFacet {
    Simplex<D> vertices;
    Index number;
    bool odd;
};

template<int D>
SortedFacet<D> sorted_facet(Simplex<D> facet, Index number) {
    bool odd = false;
    for (std::size_t i = 0; i <= D; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            odd ^= facet[j] > facet[i];
        }
    }
    std::sort(facet.begin(), facet.end());
    return {facet, number, odd};
}

template<int D>
Array<SortedFacet<D>> sorted_facets(std::span<const Simplex<D>> facets) {
    Array<SortedFacet<D>> result(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
        result[f] = sorted_facet<D>(facets[f], static_cast<Index>(f));
    }
    std::sort(result.begin(), result.end(), [](const SortedFacet<D>& a, const SortedFacet<D>& b) {
        return std::tie(a.vertices, a.number) < std::tie(b.vertices, b.number);
    });
    return result;
}

template<int D>
class FillingCheck {
public:
    FillingCheck(const FillingColumns<D>& filling, const Hull<D>* hull, const CheckOptions& options)
        : filling_{filling}, hull_{hull}, findings_{report_, options} {}

    FillingReport run() {
        report_.dimension = D;
        report_.vertices = filling_.points.size();
        report_.cells = filling_.cells.size();
        if (!check_indices<D + 1>(filling_.cells, filling_.points.size(), findings_)) {
            findings_.skip("all but the indices",
                           "there are no cells, or cells name vertices that do not exist");
            return std::move(report_);
        }
        check_names();
        check_facets();
        compare_boundary();
        compare_neighbors();
        if (check_finite<D + 1>(filling_.points, findings_)) {
            check_coincident<D + 1>(filling_.points, findings_);
            check_cells();
            compare_volume();
            check_around();
        } else {
            findings_.skip("shape", "there are coordinates that are not finite");
        }
        if (hull_ != nullptr) {
            compare_places();
        }
        return std::move(report_);
    }

private:
    void check_names() {
        for (const Index c :
             select(report_.cells, [&](std::size_t k) { return repeats_a_vertex(filling_.cells[k]); })) {
            findings_.cell(Defect::repeated_vertex, c, "names a vertex twice");
        }
        std::vector<std::uint8_t> used(report_.vertices, 0);
        parallel_for(report_.cells, cells_per_survey, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                for (const Index v : filling_.cells[c]) {
                    std::atomic_ref{used[v]}.store(1, std::memory_order_relaxed);
                }
            }
        });
        for (const Index v : select(report_.vertices, [&](std::size_t k) { return used[k] == 0; })) {
            findings_.vertex(Defect::unused_vertex, v, "no cell uses it");
        }
    }

    void check_facets() {
        adjacency_ = build_adjacency<D + 1>(filling_.cells, report_.vertices);
        using Kind = typename FacetDefect<D + 1>::Kind;
        for (const FacetDefect<D + 1>& defect : adjacency_.defects) {
            if (defect.kind == Kind::overfull) {
                findings_.vertices(Defect::overfull_facet, defect.facet, defect.cells,
                                   fmt::format("in {} cells", defect.cells.size()));
            } else if (defect.kind == Kind::disoriented) {
                findings_.vertices(Defect::disoriented_facet, defect.facet, defect.cells,
                                   "its cells induce the same orientation on it");
            } else {
                open_.push_back(outward_facet<D + 1>(filling_.cells[defect.cells.front()], defect.facet));
                in_cell_.push_back(defect.cells.front());
            }
        }
        report_.boundary_facets = open_.size();
    }

    /// Compares the boundary with the hull's cells, if there is a hull, and with the claimed facets.
    void compare_boundary() {
        const Array<SortedFacet<D>> found = sorted_facets<D>(open_);
        if (hull_ != nullptr) {
            compare_facets(found, hull_->cells, "the hull");
        }
        const bool told = findings_.any( // of the same facets, most likely
            {Defect::hull_facet_lost, Defect::hull_facet_added, Defect::hull_facet_reversed});
        if (!filling_.facets.empty() && !told) {
            compare_facets(found, filling_.facets, "the list of boundary facets");
        }
        if (filling_.facet_attribute.given()) {
            each_row(filling_.facet_attribute, [&](std::size_t, const std::int64_t* attribute) {
                ++report_.facets_by_attribute[*attribute];
            });
        }
    }

    void compare_facets(const Array<SortedFacet<D>>& found, std::span<const Simplex<D>> expected,
                        const char* whose) {
        const Array<SortedFacet<D>> wanted = sorted_facets<D>(expected);
        auto want = wanted.begin();
        auto have = found.begin();
        while (want != wanted.end() || have != found.end()) {
            if (have == found.end() || (want != wanted.end() && want->vertices < have->vertices)) {
                findings_.vertices(
                    Defect::hull_facet_lost, want->vertices, {},
                    fmt::format("facet {} of {} is in no cell or inside", want->number, whose));
                ++want;
            } else if (want == wanted.end() || have->vertices < want->vertices) {
                findings_.vertices(Defect::hull_facet_added, have->vertices, {&in_cell_[have->number], 1},
                                   fmt::format("in one cell only, and not on {}", whose));
                ++have;
            } else {
                if (want->odd != have->odd) {
                    findings_.vertices(Defect::hull_facet_reversed, have->vertices,
                                       {&in_cell_[have->number], 1},
                                       fmt::format("lies the other way round on {}", whose));
                }
                ++want;
                ++have;
            }
        }
    }

    void compare_neighbors() {
        if (filling_.neighbors.empty()) {
            return;
        }
        if (filling_.neighbors.size() != report_.cells) {
            findings_.other(
                Defect::column_length, {},
                fmt::format("neighbors: {} rows for {} cells", filling_.neighbors.size(), report_.cells));
            return;
        }
        for (const Index c : select(report_.cells, [&](std::size_t k) {
                 return filling_.neighbors[k] != adjacency_.neighbors[k];
             })) {
            findings_.cell(Defect::wrong_neighbor, c,
                           fmt::format("neighbours {} are claimed, {} found",
                                       fmt::join(filling_.neighbors[c], " "),
                                       fmt::join(adjacency_.neighbors[c], " ")));
        }
    }

    struct Sums {
        detail::CompensatedSum volume;
        double smallest = std::numeric_limits<double>::infinity();
        std::array<double, 2> time{std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity()};
        std::vector<std::pair<Index, int>> not_positive;
    };

    void check_cells() {
        const auto survey_piece = [this](std::size_t begin, std::size_t end, Sums& sums) {
            for (std::size_t c = begin; c < end; ++c) {
                survey(static_cast<Index>(c), sums);
            }
        };
        Sums all;
        for (const Sums& piece : parallel_pieces<Sums>(report_.cells, cells_per_survey, survey_piece)) {
            all.volume.add(piece.volume);
            all.smallest = std::min(all.smallest, piece.smallest);
            all.time = {std::min(all.time[0], piece.time[0]), std::max(all.time[1], piece.time[1])};
            for (const auto& [cell, sign] : piece.not_positive) {
                findings_.cell(sign < 0 ? Defect::inverted_cell : Defect::degenerate_cell, cell,
                               sign < 0 ? "its volume is negative" : "it has no volume");
            }
        }
        report_.volume = all.volume.value();
        report_.smallest_volume = all.smallest;
        report_.time = all.time;
    }

    void survey(Index c, Sums& sums) const {
        const auto corners = corners_of<D + 1, D + 1>(filling_.cells[c], filling_.points);
        const double volume = signed_measure<D + 1>(corners);
        sums.volume.add(volume);
        sums.smallest = std::min(sums.smallest, volume);
        for (const Point<D + 1>& corner : corners) {
            sums.time = {std::min(sums.time[0], corner[D]), std::max(sums.time[1], corner[D])};
        }
        const int sign = simplex_sign<D + 1>(corners);
        if (sign <= 0 && !repeats_a_vertex(filling_.cells[c])) {
            sums.not_positive.emplace_back(c, sign);
        }
    }

    void compare_volume() {
        report_.enclosed = measure_cells<D>(filling_.points, open_).enclosed;
        if (!(std::abs(report_.volume - report_.enclosed) <= 1e-12 * std::abs(report_.enclosed))) {
            findings_.other(Defect::volume_mismatch, {},
                            fmt::format("the cells' volume is {}, their boundary encloses {}", report_.volume,
                                        report_.enclosed));
        }
    }

    /// Checks vertices and boundary by their links.
    void check_around() {
        if (findings_.any({Defect::repeated_vertex, Defect::overfull_facet, Defect::disoriented_facet,
                           Defect::inverted_cell, Defect::degenerate_cell, Defect::hull_facet_lost,
                           Defect::hull_facet_added, Defect::hull_facet_reversed})) {
            findings_.skip("links of vertices", "there are cells that are not positive or not paired, or the "
                                                "boundary is another than it should be");
            return;
        }
        check_boundary<D>(report_.vertices, open_, findings_);
        check_links<D>(filling_.points, filling_.cells, {open_, in_cell_}, findings_);
    }

    /// Checks that the hull's vertices come first and that attributes follow its regions and patches.
    void compare_places() {
        const std::size_t common = std::min(hull_->points.size(), report_.vertices);
        for (const Index v :
             select(common, [&](std::size_t k) { return hull_->points[k] != filling_.points[k]; })) {
            findings_.vertex(Defect::hull_vertex_moved, v, "is elsewhere in the hull");
        }
        if (!filling_.facet_attribute.given()) {
            return;
        }
        const Array<SortedFacet<D>> of_hull = sorted_facets<D>(hull_->cells);
        each_row(filling_.facet_attribute, [&](std::size_t f, const std::int64_t* attribute) {
            const SortedFacet<D> facet = sorted_facet<D>(filling_.facets[f], 0);
            const auto same = std::lower_bound(
                of_hull.begin(), of_hull.end(), facet,
                [](const SortedFacet<D>& a, const SortedFacet<D>& b) { return a.vertices < b.vertices; });
            if (same == of_hull.end() || same->vertices != facet.vertices) {
                return; // reported already
            }
            const FacetAttribute expected = attribute_of(*hull_, same->number);
            if (*attribute != expected) {
                findings_.vertices(Defect::wrong_attribute, facet.vertices, {},
                                   fmt::format("attribute {} instead of {}", *attribute, expected));
            }
        });
    }

    const FillingColumns<D>& filling_;
    const Hull<D>* hull_;
    FillingReport report_;
    Findings findings_;
    Adjacency<D + 1> adjacency_;
    Array<Simplex<D>> open_;     ///< facets in one cell, outward
    std::vector<Index> in_cell_; ///< the cell of each
};

} // namespace

template<int D>
FillingColumns<D> columns_of(const Filling<D>& filling) {
    return {filling.points, filling.cells, filling.facets,
            Column<std::int64_t>::over(std::span<const FacetAttribute>{filling.facet_attribute}),
            filling.neighbors};
}

template<int D>
FillingReport check_filling(const FillingColumns<D>& filling, const Hull<D>* hull,
                            const CheckOptions& options) {
    enter_stage("checking the filling");
    return FillingCheck<D>{filling, hull, options}.run();
}

template FillingColumns<2> columns_of<2>(const Filling<2>&);
template FillingColumns<3> columns_of<3>(const Filling<3>&);
template FillingReport check_filling<2>(const FillingColumns<2>&, const Hull<2>*, const CheckOptions&);
template FillingReport check_filling<3>(const FillingColumns<3>&, const Hull<3>*, const CheckOptions&);

} // namespace slabhull
