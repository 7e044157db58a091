// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/side_layer.h"
#include "slabhull/slab/stitch.h"

#include <span>
#include <vector>

namespace slabhull {

/// The side of a hull over a boundary that changes from layer to layer: prisms over facets that stay, split
/// as always, and cones over changes. The walls of a cone are split as the prisms over the facets removed
/// would be, so they fit the prisms beside them.
template<int D>
class LayeredSide {
public:
    LayeredSide(std::size_t initial_points, const LayeredSweep<D>& sweep, const SideOptions& options);

    /// Number of the side's vertices in neither cap.
    std::size_t points() const { return points_.size(); }

    /// Joins the side and two caps. `terminating` begins with the vertices of the last boundary, in order;
    /// `tracks` are those of the columns. Without changes, the hull is that of stitch().
    /// Throws GeometryError when the parts do not close. Cost: near-linear.
    Hull<D> stitch(CapToStitch<D> initial, CapToStitch<D> terminating, std::span<const TrackId> tracks,
                   IdCounter& ids) &&;

private:
    struct LayerBuilder;
    /// Stands in cells for vertex b of the terminating cap: `on_terminating - b`.
    static constexpr Index on_terminating = no_index - 1;

    Index level_vertex(std::size_t level, Index column) const;
    void enter_level(std::size_t level);
    void add_layer(std::size_t layer, const SideOptions& options);
    void add_cone(std::span<const std::array<Index, D>> pieces, Index apex);

    std::size_t initial_points_;
    const LayeredSweep<D>& sweep_;
    std::vector<Point<D + 1>> points_; ///< of the side's vertices
    std::vector<std::int64_t> column_; ///< of each; -1 for centres and apexes
    std::vector<Simplex<D>> cells_;
    std::vector<SidePart> parts_;
    std::vector<std::vector<Index>> vertex_of_column_; ///< by level
};

extern template class LayeredSide<2>;
extern template class LayeredSide<3>;

} // namespace slabhull
