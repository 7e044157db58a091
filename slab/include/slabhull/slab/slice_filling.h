// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/slice.h"
#include "slabhull/topology/filling.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>

namespace slabhull {

/// Where a point of a section lies in the filling: on the edge from a vertex below the instant to one above.
/// `share` is 0 at the lower one and 1 at the upper; `lower == upper` at a vertex.
struct PointOnEdge {
    Index lower = no_index;
    Index upper = no_index;
    double share = 0;

    /// The value there of a function that is linear in each simplex, from its values at the vertices.
    double value(std::span<const double> at_vertices) const {
        return std::lerp(at_vertices[lower], at_vertices[upper], share);
    }
};

/// The domain at one instant, cut out of a filling: a conforming mesh of simplices of dimension D.
template<int D>
struct FillingSection {
    double time = 0;
    Array<Point<D>> points;
    Array<PointOnEdge> edge; ///< of each point

    Array<Simplex<D>> cells;                  ///< positively oriented
    Array<Neighbors<D>> neighbors;            ///< no_index across the boundary
    Array<Index> filling_cell;                ///< that each cell is cut from
    Array<Facet<D>> boundary_facets;          ///< outward
    Array<FacetAttribute> boundary_attribute; ///< of the filling's facet; 0 where the filling has no facets
};

/// The span of a filling's vertices. Throws InputError when there are none, or coordinates that are not
/// finite.
template<int D>
TimeSpan time_span(const FillingColumns<D>& filling);

/// Cuts a filling at an instant. An instant at a level is the limit from above, at the filling's end from
/// below: the section then is the mesh on that level. The cut of a simplex is a product of two simplices (a
/// tetrahedron, or a prism over a triangle, for D = 3). It is divided along staircases by vertex numbers,
/// which two neighbours do alike, so the section conforms.
///
/// Throws UsageError for a time outside the filling's, InputError for vertices that do not exist and
/// coordinates that are not finite, GeometryError when the cut is no manifold or its boundary is not that of
/// the filling (`check_filling()` says what is wrong with the filling). Cost: near-linear in the filling's
/// cells. The result does not depend on the number of threads. Source: the staircase triangulation of
/// products of simplices (De Loera, Rambau, Santos, Triangulations, 6.2).
template<int D>
FillingSection<D> slice_filling(const FillingColumns<D>& filling, double time);

struct FillingSectionReport {
    int dimension = 0; ///< of space
    double time = 0;
    std::size_t vertices = 0;
    std::size_t cells = 0;
    double measure = 0;       ///< area or volume of the domain
    double smallest_cell = 0; ///< its signed measure; not positive where a level all but meets a vertex
    std::map<FacetAttribute, std::size_t> facets_by_attribute;
};

template<int D>
FillingSectionReport measure_section(const FillingSection<D>& section);

} // namespace slabhull
