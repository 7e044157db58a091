// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/boundary_changes.h"

#include "core/pieces.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_scan = 1 << 14;

/// A side cell made of an untracked vertex and a facet of the boundary on a level.
template<int D>
struct FacetAtApex {
    Index apex;
    bool above; ///< the facet is later than the apex
    BoundaryFacet<D> facet;
};

template<int D>
std::optional<FacetAtApex<D>> facet_at_apex(const HullView<D>& view, Index cell) {
    Simplex<D> corners = view.cells()[cell];
    std::size_t place = D + 1;
    for (std::size_t k = 0; k <= D; ++k) {
        if (view.track[corners[k]] < 0) {
            if (place <= D) {
                return std::nullopt;
            }
            place = k;
        }
    }
    if (place > D) {
        return std::nullopt;
    }
    std::rotate(corners.begin() + static_cast<std::ptrdiff_t>(place),
                corners.begin() + static_cast<std::ptrdiff_t>(place) + 1, corners.end());
    const double time = view.time_of(corners[0]);
    if (std::any_of(corners.begin(), corners.end() - 1, [&](Index v) { return view.time_of(v) != time; })) {
        return std::nullopt;
    }
    const bool above = time > view.time_of(corners[D]);
    // A facet followed by a later vertex is the inward side of the hull, by an earlier one the outward side.
    if (((D - place) % 2 == 1) == above) {
        std::swap(corners[0], corners[1]);
    }
    FacetAtApex<D> found{corners[D], above, {}};
    std::copy_n(corners.begin(), D, found.facet.vertices.begin());
    found.facet.cap_cell = found.facet.side_cell = cell;
    set_tracks(view, found.facet);
    return found;
}

/// The ridges that an odd number of the facets have, by tracks.
template<int D>
std::vector<std::array<TrackId, D - 1>> rim_of(const std::vector<BoundaryFacet<D>>& facets) {
    std::map<std::array<TrackId, D - 1>, bool> odd;
    for (const BoundaryFacet<D>& facet : facets) {
        for (std::size_t i = 0; i < D; ++i) {
            std::array<TrackId, D - 1> ridge;
            for (std::size_t k = 0, n = 0; k < D; ++k) {
                if (k != i) {
                    ridge[n++] = facet.tracks[k];
                }
            }
            odd[ridge] = !odd[ridge];
        }
    }
    std::vector<std::array<TrackId, D - 1>> rim;
    for (const auto& [ridge, is_odd] : odd) {
        if (is_odd) {
            rim.push_back(ridge);
        }
    }
    return rim;
}

template<int D>
bool is_change(const BoundaryFacetChange<D>& change) {
    if (change.below.empty() || change.above.empty()) {
        return false;
    }
    const bool same =
        std::equal(change.below.begin(), change.below.end(), change.above.begin(), change.above.end(),
                   [](const BoundaryFacet<D>& a, const BoundaryFacet<D>& b) { return a.tracks == b.tracks; });
    return !same && rim_of<D>(change.below) == rim_of<D>(change.above);
}

template<int D>
std::vector<TrackId> tracks_in(const std::vector<BoundaryFacet<D>>& facets) {
    std::vector<TrackId> tracks;
    for (const BoundaryFacet<D>& facet : facets) {
        tracks.insert(tracks.end(), facet.tracks.begin(), facet.tracks.end());
    }
    std::sort(tracks.begin(), tracks.end());
    return tracks;
}

/// Vertices of some facets whose tracks the other facets do not have.
template<int D>
void add_vertices_without(const HullView<D>& view, const std::vector<BoundaryFacet<D>>& facets,
                          const std::vector<BoundaryFacet<D>>& others, std::vector<Index>& vertices) {
    const std::vector<TrackId> known = tracks_in<D>(others);
    for (const BoundaryFacet<D>& facet : facets) {
        for (const Index vertex : facet.vertices) {
            if (!std::binary_search(known.begin(), known.end(), view.track[vertex])) {
                vertices.push_back(vertex);
            }
        }
    }
}

} // namespace

template<int D>
std::vector<BoundaryFacetChange<D>> find_boundary_changes(const HullView<D>& view) {
    std::vector<FacetAtApex<D>> all = parallel_gather<FacetAtApex<D>>(
        view.cells().size(), cells_per_scan,
        [&](std::size_t begin, std::size_t end, std::vector<FacetAtApex<D>>& list) {
            for (std::size_t c = begin; c < end; ++c) {
                if (view.in_cap(c)) {
                    continue;
                }
                if (auto found = facet_at_apex(view, static_cast<Index>(c))) {
                    list.push_back(*found);
                }
            }
        });
    std::sort(all.begin(), all.end(), [](const FacetAtApex<D>& a, const FacetAtApex<D>& b) {
        return std::tie(a.apex, a.facet.tracks, a.facet.cap_cell) <
               std::tie(b.apex, b.facet.tracks, b.facet.cap_cell);
    });
    std::vector<BoundaryFacetChange<D>> changes;
    for (auto run = all.begin(); run != all.end();) {
        BoundaryFacetChange<D> change{};
        const Index apex = run->apex;
        for (; run != all.end() && run->apex == apex; ++run) {
            (run->above ? change.above : change.below).push_back(run->facet);
        }
        if (is_change(change)) {
            change.time = view.time_of(change.above.front().vertices[0]);
            changes.push_back(std::move(change));
        }
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const auto& a, const auto& b) { return a.time < b.time; });
    return changes;
}

template<int D>
TrackEnds track_ends(const HullView<D>& view, const std::vector<BoundaryFacetChange<D>>& changes) {
    TrackEnds ends;
    for (const BoundaryFacetChange<D>& change : changes) {
        add_vertices_without<D>(view, change.above, change.below, ends.begun);
        add_vertices_without<D>(view, change.below, change.above, ends.ended);
    }
    std::sort(ends.begun.begin(), ends.begun.end());
    std::sort(ends.ended.begin(), ends.ended.end());
    return ends;
}

template<int D>
std::vector<BoundaryFacet<D>> after_changes(std::vector<BoundaryFacet<D>> facets,
                                            const std::vector<BoundaryFacetChange<D>>& changes) {
    std::map<std::array<TrackId, D>, BoundaryFacet<D>> now;
    for (const BoundaryFacet<D>& facet : facets) {
        now.emplace(facet.tracks, facet);
    }
    for (const BoundaryFacetChange<D>& change : changes) {
        for (const BoundaryFacet<D>& facet : change.below) {
            now.erase(facet.tracks);
        }
        for (const BoundaryFacet<D>& facet : change.above) {
            now.insert_or_assign(facet.tracks, facet);
        }
    }
    facets.clear();
    for (const auto& [tracks, facet] : now) {
        facets.push_back(facet);
    }
    return facets;
}

template std::vector<BoundaryFacetChange<2>> find_boundary_changes<2>(const HullView<2>&);
template std::vector<BoundaryFacetChange<3>> find_boundary_changes<3>(const HullView<3>&);
template TrackEnds track_ends<2>(const HullView<2>&, const std::vector<BoundaryFacetChange<2>>&);
template TrackEnds track_ends<3>(const HullView<3>&, const std::vector<BoundaryFacetChange<3>>&);
template std::vector<BoundaryFacet<2>> after_changes<2>(std::vector<BoundaryFacet<2>>,
                                                        const std::vector<BoundaryFacetChange<2>>&);
template std::vector<BoundaryFacet<3>> after_changes<3>(std::vector<BoundaryFacet<3>>,
                                                        const std::vector<BoundaryFacetChange<3>>&);

} // namespace slabhull
