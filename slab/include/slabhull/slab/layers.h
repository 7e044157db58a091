// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/slab/sweep.h"

#include <array>
#include <cstddef>
#include <vector>

namespace slabhull {

class Communicator;

/// The number of layers of a slab's side. Between two levels each vertex moves along a chord at constant
/// speed. A layer is short enough if chords are near trajectories and no facet turns far.
struct LayerOptions {
    /// Whether the number of layers follows from the motion; else levels are given and only assessed.
    bool automatic = false;
    /// Largest distance between a vertex's chord and its trajectory at the same time, in local edge lengths:
    /// the mean edge at the vertex, at the end of the layer where that is shorter.
    double tolerance = 0.05;
    double turn = 30; ///< degrees that a facet may turn by in a layer, in any direction
    /// With automatic layers, a patch with more edges than this across its extent has a proportionally
    /// smaller tolerance. Otherwise the chords' error would be of order 1 in the edge length, while the
    /// facets' own is of order 2. 0: never.
    double edges_across = 20;
    /// Fewest layers. A corrected motion that is given the number of the predicted one gets the same number,
    /// and so the same ids, unless it needs more.
    int at_least = 1;
    int most = 10'000; ///< most layers; more are refused
    /// Whether to search for a sufficient number if the given layers are too few.
    bool suggest = true;
};

/// How well layers follow a motion.
struct LayerFit {
    std::size_t layers = 0;
    double deviation = 0; ///< the largest, in local edge lengths; infinite where it could not be measured
    double turn = 0;      ///< the largest turn of a facet in a layer, in degrees
    /// Estimated factor by which the number of layers must grow; they are enough if it is at most 1 ...
    double growth = 0;
    PatchNumber patch = 0; ///< ... and where it is largest; 0: nothing moves
    double time = 0;

    bool sound() const { return growth <= 1; }
};

template<int D>
struct MeasuredSweep {
    Sweep<D> sweep;
    LayerFit fit;
};

/// A motion needs more layers than allowed. The entity is the patch.
class TooManyLayers : public GeometryError {
public:
    using GeometryError::GeometryError;
};

/// The times of levels that divide [begin, end] into equal layers.
std::vector<double> even_levels(double begin, double end, std::size_t layers);

/// Levels with one more between any two.
std::vector<double> halved_levels(const std::vector<double>& times);

/// As sweep_boundary(), and measures how well the layers follow the motion. Trajectories are sampled at eight
/// times per layer (at least 32 per slab) and at the rows of tables (at most 1,000 per slab). Between samples
/// they are Hermite cubics, whose velocity is compared with the motion's at a time that no period of the
/// samples meets: even a whole turn between two samples is noticed. In ranks each sweeps through all levels,
/// measures its share of the layers, and keeps the levels of these, the first and the last. Cost: about twice
/// that of sweep_boundary().
template<int D>
MeasuredSweep<D> sweep_measured(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                const PatchMotions<D>& motions, double motion_start,
                                std::vector<double> times, const TrajectoryOptions& trajectory,
                                const LayerOptions& options, Communicator* ranks = nullptr);

/// Sweeps `boundary` from time[0] to time[1] in as few equal layers as the options allow: their number is
/// raised until a sweep is sound. So the result is that of sweep_boundary() for these levels, bit for bit.
/// Motion that takes less than a 64th of the slab and has no row in a table may be missed.
/// Throws as sweep_boundary() does, and TooManyLayers naming patch and time. An error at few layers is not
/// final, as the agreement of patches depends on how well they are integrated: up to 64 layers are tried
/// then.
/// Deterministic, whatever the number of threads or ranks (see sweep_measured()). Cost: two to three times
/// that of sweep_measured().
template<int D>
MeasuredSweep<D> sweep_in_layers(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                 const PatchMotions<D>& motions, double motion_start,
                                 std::array<double, 2> time, const TrajectoryOptions& trajectory,
                                 const LayerOptions& options, Communicator* ranks = nullptr);

} // namespace slabhull
