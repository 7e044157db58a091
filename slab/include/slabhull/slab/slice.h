// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/slab/check.h"
#include "slabhull/topology/spatial_mesh.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace slabhull {

/// The boundary of the domain at one instant: the section of a hull's side at a level of time. Caps
/// contribute only their boundaries.
template<int D>
struct Section {
    double time = 0;
    Surface<D> surface;                ///< closed, outward from the domain, with the patches of the side
    Array<Neighbors<D - 1>> neighbors; ///< the facet across each ridge
    Array<Index> hull_cell;            ///< hull cell that each facet is cut from
    Array<PersistentId> vertex_ids;    ///< id of a hull's vertex at the level, else -1
    Array<TrackId> track_ids;          ///< the track that the level crosses, else no_track
};

struct SliceOptions {
    /// The user's numbers of the hull's cells, for messages; empty: counted from 0.
    std::function<std::int64_t(Index)> cell_number;
};

/// The first and the last time of a hull.
struct TimeSpan {
    double first = 0;
    double last = 0;

    /// Times closer than this, a few units in the last place, count as equal. Levels computed in two ways
    /// differ by as much, and so do times of face and prism centres; a cut so close to a vertex would be all
    /// slivers.
    double tolerance() const;
    bool contains(double time) const { return time >= first - tolerance() && time <= last + tolerance(); }
};

/// The span of a hull's vertices. Throws InputError when there are none, or coordinates that are not finite.
template<int D>
TimeSpan time_span(const HullColumns<D>& hull);

/// Cuts a hull at each of the times, ascending, and hands the sections to `use`.
///
/// A vertex of a section is identified by the hull's edge that it lies on, never by coordinates, so that a
/// closed hull has closed sections. A level that passes through vertices is the limit from above (at the
/// hull's end: from below): cut points of the edges at such a vertex are that vertex, and facets that
/// collapse are left out. So the section at a level of the side is exactly the boundary of that level.
/// Vertices within TimeSpan::tolerance() of a time are taken to be at it. Quadrilaterals are cut in
/// two; the order of facets is that of the cells.
///
/// Throws UsageError for times that do not ascend or are not in the hull's span, InputError for cells or
/// columns that do not fit, GeometryError naming cells and places when a section is not closed or its facets
/// face inwards. Cost: near-linear in the hull's cells and the sections' facets, whatever the number of
/// times; 4 bytes for each cell that meets a time, and what the largest section needs. The result for one
/// time depends neither on the others nor on the number of threads.
template<int D>
void slice_hull(const HullColumns<D>& hull, std::span<const double> times,
                const std::function<void(Section<D>&&)>& use, const SliceOptions& options = {});

/// The section at one time.
template<int D>
Section<D> slice_hull(const HullColumns<D>& hull, double time, const SliceOptions& options = {});

struct PatchMeasure {
    PatchNumber number = 0;
    std::size_t facets = 0;
    double measure = 0; ///< length (D = 2) or area (D = 3)
};

struct SectionReport {
    int dimension = 0; ///< of space
    double time = 0;
    std::size_t vertices = 0;
    std::size_t facets = 0;
    std::size_t components = 0;        ///< closed curves or surfaces
    std::vector<PatchMeasure> patches; ///< patches of the section, by number
    double measure = 0;                ///< of the boundary
    double enclosed = 0;               ///< area or volume of the domain
    double closure = 0;                ///< |sum of the facets' normals|
};

template<int D>
SectionReport measure_section(const Section<D>& section);

} // namespace slabhull
