// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/slab/sweep.h"

#include <array>
#include <cstddef>
#include <vector>

namespace slabhull {

/// How many layers a slab's side has. Between two levels every vertex goes along a straight chord, at an even
/// speed; a layer is short enough when that is near the vertex's trajectory and no facet turns far.
struct LayerOptions {
    /// The number of layers follows from the motion; else the levels are given, and only judged.
    bool automatic = false;
    /// Largest distance between a vertex on its chord and, at the same time, on its trajectory, in local edge
    /// lengths: the mean of the edges at the vertex, at that end of the layer where it is shorter.
    double tolerance = 0.05;
    double turn = 30; ///< degrees that a facet may turn by in a layer, in any direction
    /// A patch with more edges than these across its extent has a tolerance that is smaller in proportion,
    /// when layers are automatic: else the chords' error would be of order 1 in the edge length, and the
    /// facets' own is of order 2. 0: never.
    double edges_across = 20;
    /// Layers are never fewer. A corrected motion that is given the number of the predicted one has that
    /// number again unless it needs more; then all ids are the same.
    int at_least = 1;
    int most = 10'000; ///< more are refused
    /// Whether the number that would do is sought where given layers are too few.
    bool suggest = true;
};

/// How well layers follow a motion.
struct LayerFit {
    std::size_t layers = 0;
    double deviation = 0; ///< the largest, in local edge lengths; infinite where it could not be measured
    double turn = 0;      ///< the largest of a facet in a layer, in degrees
    /// The factor by which layers would have to be more, as far as this motion can be extrapolated: sound
    /// when it is at most 1 ...
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

/// A motion would need more layers than are allowed. The entity is the patch.
class TooManyLayers : public GeometryError {
public:
    using GeometryError::GeometryError;
};

/// The times of levels that part [begin, end] into equal layers.
std::vector<double> even_levels(double begin, double end, std::size_t layers);

/// As sweep_boundary(), and says how well the layers follow the motion: trajectories are sampled at eight
/// times a layer (at 32 a slab where layers are few) and at the rows of tables (at 1,000 a slab at most). In
/// between they are cubics through velocities, which are compared with the motion's own velocity at a time
/// that no period of samples hides: a whole turn between two samples is seen. Cost: about twice that of
/// sweep_boundary().
template<int D>
MeasuredSweep<D> sweep_measured(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                const PatchMotions<D>& motions, double motion_start,
                                std::vector<double> times, const TrajectoryOptions& trajectory,
                                const LayerOptions& options);

/// Sweeps `boundary` from time[0] to time[1] in equal layers, as few as keep within the options: their number
/// is raised until a sweep is sound. So the result is that of sweep_boundary() for these levels, bit for bit.
/// What takes less than a 64th of the slab and is no row of a table may be missed.
/// Throws as sweep_boundary() does, and TooManyLayers naming patch and time. An error at few layers is no
/// verdict, for patches agree as well as they are integrated: up to 64 are tried then.
/// Deterministic, whatever the number of threads. Cost: two to three times that of sweep_measured().
template<int D>
MeasuredSweep<D> sweep_in_layers(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                 const PatchMotions<D>& motions, double motion_start,
                                 std::array<double, 2> time, const TrajectoryOptions& trajectory,
                                 const LayerOptions& options);

} // namespace slabhull
