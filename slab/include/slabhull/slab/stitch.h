// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/cap_cells.h"
#include "slabhull/slab/hull_part.h"
#include "slabhull/slab/id_counter.h"
#include "slabhull/slab/sweep.h"
#include "slabhull/topology/hull.h"
#include "slabhull/topology/prism_split.h"
#include "slabhull/topology/spatial_mesh.h"

#include <span>
#include <utility>

namespace slabhull {

template<int D>
struct CapMesh;

/// A terminating cap as a spatial mesh: new ids for its points, the tracks and patches of the boundary.
/// `mesh` has the boundary's vertices first.
template<int D>
SpatialMesh<D> terminating_cap(const Boundary<D>& boundary, CapMesh<D>&& mesh, IdCounter& ids);

/// How the side is split into simplices.
struct SideOptions {
    Split split;
    Diagonals diagonals = Diagonals::shape;
};

/// Number of the side's vertices in neither cap: those on inner levels, and the centres of the split.
template<int D>
std::size_t side_vertex_count(const Sweep<D>& sweep, Split split);

/// Number of the side's simplices; in floating point, since it may exceed an integer's range.
double side_simplex_count(std::size_t facets, std::size_t layers, Split split);

/// A cap to be stitched into a hull. If it is given up, each array is released as soon as it is in the hull,
/// so that it is not held twice.
template<int D>
class CapToStitch {
public:
    CapToStitch(const SpatialMesh<D>& kept) : mesh_{kept} {}
    CapToStitch(SpatialMesh<D>&& given_up) : mesh_{given_up}, given_up_{&given_up} {}

    const SpatialMesh<D>& mesh() const { return mesh_; }
    /// Sets the tracks of its vertices in the hull, if not the mesh's own.
    void give_tracks(Array<TrackId> tracks) { tracks_ = std::move(tracks); }
    std::span<const TrackId> tracks() const {
        return tracks_.empty() ? std::span<const TrackId>{mesh_.track_ids}
                               : std::span<const TrackId>{tracks_};
    }
    /// In ranks: the cells of the cap, of which mesh() then has none. They are given up.
    void give_cells(CapCells<D>& cells) { cells_ = &cells; }
    CapCells<D>& cells() const { return *cells_; }
    /// While it lives, mesh() has the cells that were given for it. Needs: a cap that is given up.
    class WithCells {
    public:
        explicit WithCells(CapToStitch& cap) : cap_{cap} { exchange(); }
        WithCells(const WithCells&) = delete;
        WithCells& operator=(const WithCells&) = delete;
        ~WithCells() { exchange(); }

    private:
        void exchange() {
            cap_.given_up_->cells.swap(cap_.cells_->cells);
            cap_.given_up_->neighbors.swap(cap_.cells_->neighbors);
        }

        CapToStitch& cap_;
    };
    /// Releases an array of a cap that is given up.
    template<class T>
    void release(Array<T> SpatialMesh<D>::*array) {
        if (given_up_ != nullptr) {
            Array<T>{}.swap(given_up_->*array); // assigning {} would keep the memory
        }
    }

private:
    const SpatialMesh<D>& mesh_;
    SpatialMesh<D>* given_up_ = nullptr;
    Array<TrackId> tracks_;
    CapCells<D>* cells_ = nullptr;
};

/// The terminating cap of a stitched hull, with its boundary facets, in the cap's own numbers.
template<int D>
SpatialMesh<D> terminating_cap_of(const Hull<D>& hull, Array<Facet<D>> boundary_facets);

/// Joins the initial cap, the side made from the sweep and the terminating cap into one closed hull: steps 5
/// to 7. Vertices: those of the initial cap, then the side's by layer (levels, face centres, prism centres),
/// then the terminating cap's. Adjacency comes by construction: the caps' own, the split's template, and the
/// boundary's dual graph. Needs: `split` of dimension D; caps with their adjacency, whose boundary facets are
/// the sweep's, in order. Throws GeometryError when the boundary is not closed or a cap does not fit it
/// (which the caps' own checks make impossible), LimitError when the hull is too large for its indices. Cost:
/// near-linear. The result does not depend on the number of threads.
template<int D>
Hull<D> stitch(CapToStitch<D> initial, const Sweep<D>& sweep, CapToStitch<D> terminating,
               const SideOptions& options, IdCounter& ids);

/// This rank's part of the hull that stitch() would make, see range_of_part(), and the order of the whole.
/// Every rank is given the caps' points and the ids, and some of the sweep's levels and of the caps' cells
/// (CapToStitch::give_cells()), which are sent to where their part is: `sweep` keeps the levels that the part
/// needs, and the first and the last. Each rank takes time and memory for its own cells and for what follows
/// from the boundary: its graph, and the diagonals of the layers that the part touches. The hull's points
/// cost a bit each. Collective. Throws as stitch() does, and UsageError for more ranks than cells.
template<int D>
HullPart<D> stitch_part(CapToStitch<D> initial, Sweep<D>& sweep, CapToStitch<D> terminating,
                        const SideOptions& options, IdCounter& ids, Communicator& ranks, HullOrder<D>& order);

} // namespace slabhull
