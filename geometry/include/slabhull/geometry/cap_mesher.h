// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/geometry/size_field.h"
#include "slabhull/topology/boundary.h"
#include "slabhull/topology/spatial_mesh.h"

namespace slabhull {

class Communicator;

/// The mesher of 3D domains: TetGen, or HXT, a part of Gmsh.
enum class SolidMesher { tetgen, hxt };
/// Whether this build has the mesher.
bool has_mesher(SolidMesher mesher);

struct CapOptions {
    Grading grading;
    SolidMesher mesher = SolidMesher::tetgen; ///< (D = 3)
    /// Number of parts that the domain is meshed in, each by its own process (D = 3). 0: one, unless the free
    /// memory does not suffice.
    int blocks = 0;
    double radius_edge = 1.414; ///< largest ratio of circumradius to shortest edge (D = 3)
    double min_dihedral = 10;   ///< wanted dihedral angle in degrees (D = 3)
    double min_angle = 20;      ///< wanted angle in degrees (D = 2)
    /// Orders interior points and cells along a space-filling curve instead of leaving the mesher's order (D
    /// = 3; for D = 2 always): walks and checks run about twice as fast on such a mesh.
    bool curve_order = true;
    /// Ranks that mesh the blocks together, each those whose number is its own modulo their count; nullptr:
    /// this process alone. All of them call mesh_cap(), with the same arguments and `blocks` given (D = 3).
    /// All get the points, and each a range of the cells: see CapMesh.
    Communicator* ranks = nullptr;
};

/// A mesh of the domain inside a surface. In ranks, each has all points, and consecutive cells, those of a
/// lower rank before: of a mesh in several blocks about equally many, else the first rank has all. Numbers
/// are those of the whole mesh.
template<int D>
struct CapMesh {
    Array<Point<D>> points; ///< the surface's first, in order and bit for bit, then new interior ones
    Array<Simplex<D>> cells;
    Array<Neighbors<D>> neighbors; ///< no_index across the boundary
    int blocks = 1;                ///< number of blocks it was meshed in
};

/// Meshes the domain bounded by `surface`. The boundary of the result is exactly its facets, with no points
/// added on them.
/// D = 3: TetGen or HXT in a child process, so that a crash becomes an error; with several blocks, as many at
/// once as there are threads (thread_count()), after their interfaces are meshed. D = 2: a constrained
/// Delaunay triangulation (CGAL), refined without splitting boundary edges. The spacing inside is that of a
/// SizeField made from the boundary's own spacing and `options.grading`: the mean edge is about as long.
/// Cells on the boundary are as large as its facets, whatever the wanted spacing. Needs: the boundary of a
/// domain, see require_domain_boundary(); call that first, with the user's names for the facets. For D = 3 it
/// is called again, at 2 % of the time: TetGen crashes, or never ends, on anything else.
/// Throws GeometryError if the mesher fails or its boundary differs from the surface; it names the facets.
/// UsageError for a radius_edge outside [1, 100], a min_dihedral outside [0, 20], blocks outside [0, 4096],
/// or a mesher that this build does not have (D = 3). Cost (D = 3): about 6 microseconds per tetrahedron, and
/// some 300 bytes of each in the child. Deterministic, whatever the number of threads; with 0 blocks, for the
/// same number of blocks.
template<int D>
CapMesh<D> mesh_cap(const Surface<D>& surface, const CapOptions& options);

template<>
CapMesh<2> mesh_cap<2>(const Surface<2>& surface, const CapOptions& options);
template<>
CapMesh<3> mesh_cap<3>(const Surface<3>& surface, const CapOptions& options);

/// The same for a boundary with the positions of `surface` that was already checked:
/// require_domain_boundary() is not called again.
template<int D>
CapMesh<D> mesh_cap(const Boundary<D>& boundary, const Surface<D>& surface, const CapOptions& options);

template<>
CapMesh<2> mesh_cap<2>(const Boundary<2>& boundary, const Surface<2>& surface, const CapOptions& options);
template<>
CapMesh<3> mesh_cap<3>(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options);

/// Proves that a cap mesh fills the inside of a surface. Its points begin with the surface's, bit for bit.
/// Its boundary facets are the surface's, orientation included. Every cell is positively oriented (exactly)
/// and on the other side of each shared facet from its neighbour. Every point is used. If the surface bounds
/// a domain, this excludes overlaps and gaps.
/// Throws GeometryError naming what is missing, added, inverted or unmatched.
/// Cost: linear; about 2 % of the meshing.
template<int D>
void verify_cap(const CapMesh<D>& mesh, const Surface<D>& surface);

/// A mesh that the first of several ranks has made: all get its points and number of blocks, the cells stay
/// there. Collective.
template<int D>
CapMesh<D> with_shared_points(CapMesh<D> mesh, Communicator& ranks);

} // namespace slabhull
