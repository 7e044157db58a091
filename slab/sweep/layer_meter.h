// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/sweep/boundary_mover.h"
#include "slabhull/slab/layers.h"

#include <span>
#include <vector>

namespace slabhull {

/// Measures how far trajectories leave their chords in the layers of a slab, and how far facets turn.
/// Between two samples a trajectory is the cubic with the velocities at both. The cubic's defect, the
/// difference between its own velocity and the motion's, bounds its error: Enright, "Continuous numerical
/// methods for ODEs with defect control", J. Comput. Appl. Math. 125 (2000).
template<int D>
class LayerMeter {
public:
    /// For a slab of `layers` from `begin` to `end`. `sweep` gives the boundary and its first places; all
    /// must outlive the meter.
    LayerMeter(BoundaryMover<D>& mover, const Sweep<D>& sweep, const LayerOptions& options,
               std::size_t layers, double begin, double end);

    /// Measures a layer in which the motions take vertices from `start` to `end`. Layers come one after the
    /// other.
    void measure(const Array<Point<D>>& start, const Array<Point<D>>& end, double from, double to);
    /// Instead of measuring the layer before the first that is measured: `end` as there.
    void pass(const Array<Point<D>>& end);

    /// The fit over the layers measured so far.
    const LayerFit& fit() const { return fit_; }

private:
    using Group = typename BoundaryMover<D>::MotionGroup;

    struct Layer {
        const Array<Point<D>>& start;
        const Array<Point<D>>& end;
        double from;
        double to;
        Point<D> on_chord(Index vertex, double time) const;
    };
    /// The places of all vertices and, for groups moved by a field, the velocities of their vertices.
    struct Sample {
        double time;
        Array<Point<D>> places;
        std::vector<std::vector<Point<D>>> velocities;
    };
    /// Largest values over some of the vertices or facets.
    struct Worst {
        double deviation = 0;
        double turn = 0;
        double growth = 0;
        Index at = no_index; ///< where the growth is largest
    };
    using Frame = std::array<Point<D>, D>;

    std::vector<double> allowed_deviations(double tolerance, double edges_across) const;
    static std::vector<double> rows_within(const std::vector<Group>& groups, double begin, double end);
    std::vector<double> sample_times(double from, double to) const;
    Sample sample_at(double time, Array<Point<D>> places) const;
    void measure_deviations(const Layer& layer, const Sample& before, const Sample& after);
    void measure_at(const Layer& layer, const Group& group, std::span<const Point<D>> places, double time);
    void measure_field(const Layer& layer, const Group& group, std::size_t g, const Sample& before,
                       const Sample& after);
    void measure_turns(const std::vector<Frame>& start, const Array<Point<D>>& places, double time);
    std::vector<Frame> frames_at(const Array<Point<D>>& places) const;
    void note(Worst& worst, Index vertex, double distance) const;
    void keep_vertices(std::span<const Worst> found, const Group& group, double time);
    void keep(const Worst& worst, PatchNumber patch, double time);

    BoundaryMover<D>& mover_;
    const Boundary<D>& boundary_;
    const LayerOptions& options_;
    int samples_;               ///< least number in a layer
    std::vector<double> rows_;  ///< times of tables' rows within the slab
    std::vector<Index> moving_; ///< facets that move
    std::vector<double> allowed_;
    std::vector<double> edges_; ///< mean at each vertex, at the layer's start ...
    std::vector<double> local_; ///< ... and the shorter of that and the one at its end
    LayerFit fit_;
};

} // namespace slabhull
