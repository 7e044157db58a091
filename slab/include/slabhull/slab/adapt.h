// SPDX-License-Identifier: BSD-3-Clause
// Local changes of a cap's connectivity while it moves: what CapReuse::adapt does.
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace slabhull {

/// What the boundary's edges in a patch are held to.
struct PatchAdaptation {
    std::optional<double> size; ///< target length
    bool fixed = false;         ///< its connectivity stays
};

/// What a cap that moves is held to.
struct AdaptOptions {
    /// Largest target length of edges inside. The target at a place is that of a SizeField made from the
    /// boundary's edge lengths at the start of the march.
    double size = std::numeric_limits<double>::infinity();
    double growth = 0.3;
    double angle = 10; ///< degrees: cells with a smaller (dihedral) angle are to be improved
    /// Edges inside are kept within these multiples of their target length.
    double shortest = 0.7; // with 0.6, splits outweigh collapses, and cells become more for hundreds of slabs
    double longest = 1.6;

    /// Whether edges of the boundary are kept to their target lengths, too. That of a vertex is the mean
    /// length of its edges at the start of the march, or the smallest size given for its patches.
    bool boundary = false;
    double feature_angle = 40; ///< degrees: sharper edges of the boundary are kept, and facets turn no more
    double distance = 0.25;    ///< that operations may part the boundary from what it was, in target lengths
    std::map<PatchNumber, PatchAdaptation> patches;
};

enum class OperationKind : std::uint8_t {
    split,    ///< of an edge, by a new vertex
    collapse, ///< of an edge, which ends a vertex
    flip,     ///< of a facet, or of an edge with all its cells: no vertex begins or ends
    shift,    ///< of a vertex along the boundary: its track ends, and one begins beside it
};

/// For files: size (0: none), growth, angle, shortest, longest.
std::vector<double> settings_as_numbers(const AdaptOptions& options);
/// Throws GeometryError for other than five finite numbers.
AdaptOptions settings_of_numbers(const std::vector<double>& numbers);

/// A local change of connectivity in a layer: cells of the mesh at the layer's start become other cells with
/// the same boundary at its end. In space-time, they bound a cell that is coned from `apex`.
template<int D>
struct Operation {
    OperationKind kind;
    std::size_t removed_end = 0; ///< in AdaptLog::removed, behind the operation before
    std::size_t added_end = 0;   ///< in AdaptLog::added
    Point<D + 1> apex;           ///< strictly between the layer's levels
    bool on_boundary = false;    ///< it changes the boundary, too
};

/// All that happened to the cap between the levels of a slab; what a filling needs. A column is a vertex of
/// the mesh on all levels on which it exists. Columns are numbered by ascending track.
template<int D>
struct AdaptLog {
    std::vector<double> times; ///< of the levels

    Array<TrackId> tracks; ///< of the columns
    /// Of each level: its vertices as columns, ascending, and their places.
    std::vector<std::vector<Index>> columns;
    std::vector<Array<Point<D>>> places;

    Array<Simplex<D>> cells; ///< at the first level, as columns, positive in space
    std::vector<Operation<D>> operations;
    std::vector<std::size_t> layer_end; ///< of each layer, in `operations`
    /// Numbers of the cells that operations remove. The layer's new cells take the numbers of those removed,
    /// ascending, then further ones; numbers left over go to the last cells, the smallest number to the last.
    std::vector<Index> removed;
    std::vector<Simplex<D>> added; ///< as columns

    std::size_t layers() const { return times.size() - 1; }
};

/// How a slab was adapted.
struct AdaptReport {
    std::size_t splits = 0;
    std::size_t collapses = 0;
    std::size_t flips = 0;
    std::size_t shifts = 0;
    std::size_t on_boundary = 0; ///< how many of these operations changed the boundary
    std::size_t moved = 0;       ///< vertices displaced to improve their cells
    int halvings = 0;            ///< how often all layers were halved, since cells would have been inside out
    std::size_t refused = 0;     ///< operations that would help, but cannot be coned with positive volumes
    double smallest_angle = 0;   ///< degrees, at the end
    double shortest_ratio = 0;   ///< least length of an inner edge over its target, at the end
    double longest_ratio = 0;    ///< the largest
    /// The same of the boundary's edges, if these are kept to their targets ...
    std::optional<std::array<double, 2>> boundary_ratios;
    std::optional<std::array<double, 2>> boundary_ratios_before; ///< ... and at the slab's start
};

/// How a slab's cap was adapted, and the log of it.
template<int D>
struct Adaptation {
    AdaptReport report;
    AdaptLog<D> log;
};

} // namespace slabhull
