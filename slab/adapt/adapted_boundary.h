// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/adapt_mesh.h"
#include "slab/adapt/boundary_operations.h"
#include "slab/adapt/patch_surfaces.h"
#include "slab/adapt/side_layer.h"
#include "slabhull/slab/sweep.h"

#include <span>
#include <vector>

namespace slabhull {

/// What moves a boundary whose connectivity may change.
template<int D>
struct BoundaryMotion {
    const Boundary<D>& boundary; ///< bounds the initial cap
    const PatchMotions<D>& motions;
    double motion_start;
    const TrajectoryOptions& trajectory;
};

/// The boundary of a cap that is adapted, from layer to layer.
template<int D>
class AdaptedBoundary {
public:
    /// `mesh` is the cap at the first level, whose boundary has the places `positions.front()`; those of
    /// later levels hold while the connectivity stays. All must outlive this.
    AdaptedBoundary(const BoundaryMotion<D>& motion, const std::vector<double>& times,
                    const std::vector<Array<Point<D>>>& positions, std::span<const double> spacing,
                    const AdaptMesh<D>& mesh);

    /// Places of its vertices at the end of a layer. Throws TangledBoundary.
    const Array<Point<D>>& move(std::size_t layer);
    BoundaryOperations<D> operations(std::size_t layer, const AdaptMesh<D>& mesh,
                                     const AdaptOptions& options) const;
    /// Changes it as the layer's operations do, which are about to be applied to the mesh; the mesh's new
    /// vertices get columns from `next_column`. Throws GeometryError if it then crosses itself.
    void change(std::size_t layer, std::span<const Cavity<D>> cavities, const AdaptMesh<D>& mesh,
                Index next_column);
    /// The mesh's vertices on it, after the operations.
    std::vector<Index> vertices_in(const AdaptMesh<D>& mesh) const;

    bool changed() const { return changed_; }
    /// Least and largest length of its edges over what is wanted.
    std::array<double, 2> length_ratios() const;
    LayeredSweep<D> sweep() &&;

private:
    struct Opened;
    Opened remaining(std::span<const Cavity<D>> cavities, const AdaptMesh<D>& mesh) const;
    BoundaryChange<D> add(const Cavity<D>& cavity, Index new_column, Opened& opened) const;

    BoundaryMotion<D> motion_;
    const std::vector<double>& times_;
    const std::vector<Array<Point<D>>>& positions_;
    PatchSurfaces<D> surfaces_;
    Boundary<D> boundary_; ///< at the present level
    std::vector<Index> columns_;
    std::vector<double> spacing_;
    Array<Point<D>> places_; ///< at the present level ...
    Array<Point<D>> end_;    ///< ... and at the layer's end
    LayeredSweep<D> sweep_;
    bool changed_ = false;
};

extern template class AdaptedBoundary<2>;
extern template class AdaptedBoundary<3>;

} // namespace slabhull
