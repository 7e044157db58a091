// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/check/hull_view.h"

#include <optional>
#include <vector>

namespace slabhull {

/// A change of the boundary's connectivity in a layer of the side: the facets below become those above, which
/// have the same rim.
template<int D>
struct BoundaryFacetChange {
    double time; ///< of the facets above
    std::vector<BoundaryFacet<D>> below;
    std::vector<BoundaryFacet<D>> above;
};

/// The changes of the boundary's connectivity, by time. Each is recognised by its apex: a vertex without
/// track whose cells have facets of the boundary on two levels, not the same ones, around the same ridges.
/// Needs: tracks, adjacency. Cost: one pass over the side, and sorting the cells at its centres and apexes.
template<int D>
std::vector<BoundaryFacetChange<D>> find_boundary_changes(const HullView<D>& view);

/// The changes of a hull under examination, found when they are first asked for: most hulls have none.
template<int D>
class BoundaryChanges {
public:
    /// `view` must outlive this, and not change once they were asked for.
    explicit BoundaryChanges(const HullView<D>& view) : view_{view} {}

    const std::vector<BoundaryFacetChange<D>>& operator()() {
        if (!found_) {
            found_ = find_boundary_changes(view_);
        }
        return *found_;
    }

private:
    const HullView<D>& view_;
    std::optional<std::vector<BoundaryFacetChange<D>>> found_;
};

/// Vertices at which changes begin tracks, and end them; ascending.
struct TrackEnds {
    std::vector<Index> begun;
    std::vector<Index> ended;
};

template<int D>
TrackEnds track_ends(const HullView<D>& view, const std::vector<BoundaryFacetChange<D>>& changes);

/// What the facets of a cap's boundary have become after all changes, sorted by tracks.
template<int D>
std::vector<BoundaryFacet<D>> after_changes(std::vector<BoundaryFacet<D>> facets,
                                            const std::vector<BoundaryFacetChange<D>>& changes);

} // namespace slabhull
