// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/layers.h"

#include "slab/sweep/layer_meter.h"
#include "slab/sweep/sweep_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace slabhull {

namespace {

/// Up to this number of layers, an error may come from too few layers.
constexpr int last_doubt = 64;
/// Largest factor between two tries: a poorly resolved path says little about the number needed.
constexpr double most_growth = 8;
/// A sweep that needs this many times more layers is abandoned at once.
constexpr double hopeless = 2;

template<int D>
struct SweepTask {
    const Boundary<D>& boundary;
    const SpatialMesh<D>& cap;
    const PatchMotions<D>& motions;
    double motion_start;
    const TrajectoryOptions& trajectory;
    const LayerOptions& options;

    MeasuredSweep<D> run(std::vector<double> times, bool to_the_end) const {
        MeasuredSweep<D> result{started_sweep(boundary, cap, std::move(times)), {}};
        Sweep<D>& sweep = result.sweep;
        BoundaryMover<D> mover{sweep, motions, motion_start, trajectory};
        LayerMeter<D> meter{mover, sweep, options, sweep.layers(), sweep.times.front(), sweep.times.back()};
        for (std::size_t level = 1; level < sweep.times.size(); ++level) {
            const double from = sweep.times[level - 1];
            const double to = sweep.times[level];
            Array<Point<D>> places = mover.drift(sweep.positions.back(), from, to);
            meter.measure(sweep.positions.back(), places, from, to);
            if (!to_the_end && meter.fit().growth >= hopeless) {
                break;
            }
            mover.project(places, to);
            sweep.positions.push_back(std::move(places));
        }
        sweep.projected = mover.projected();
        result.fit = meter.fit();
        return result;
    }
};

/// Raises the number of layers until a sweep is sound.
template<int D>
class LayerSearch {
public:
    LayerSearch(const SweepTask<D>& task, std::array<double, 2> time) : task_{task}, time_{time} {}

    MeasuredSweep<D> run() const {
        for (int layers = std::max(1, task_.options.at_least);;) {
            require_distinct(layers);
            std::optional<MeasuredSweep<D>> swept = attempt(layers);
            if (swept && swept->fit.sound()) {
                return std::move(*swept);
            }
            layers = more(layers, swept ? &swept->fit : nullptr);
        }
    }

private:
    /// A sweep with so many layers; empty after an error that more layers may cure.
    std::optional<MeasuredSweep<D>> attempt(int layers) const {
        try {
            return task_.run(even_levels(time_[0], time_[1], static_cast<std::size_t>(layers)), false);
        } catch (const GeometryError&) {
            if (layers >= last_doubt || layers >= task_.options.most) {
                throw;
            }
            return std::nullopt;
        }
    }

    int more(int layers, const LayerFit* fit) const {
        const double growth = fit != nullptr ? std::min(fit->growth, most_growth) : 2.0;
        const double wanted = std::max(layers + 1.0, std::ceil(layers * growth));
        if (wanted > task_.options.most && fit != nullptr) {
            refuse(*fit);
        }
        return static_cast<int>(std::min<double>(wanted, task_.options.most));
    }

    void require_distinct(int layers) const {
        const double rounding =
            std::numeric_limits<double>::epsilon() * std::max(std::abs(time_[0]), std::abs(time_[1]));
        if (!((time_[1] - time_[0]) / layers > 4 * rounding)) {
            throw TooManyLayers(fmt::format("the slab from t = {} to {} is too short for the {} layers that "
                                            "its motion needs: rounding leaves no two levels at one time",
                                            time_[0], time_[1], layers));
        }
    }

    [[noreturn]] void refuse(const LayerFit& fit) const {
        const std::string patch = patch_name(task_.boundary.patches(), fit.patch);
        throw TooManyLayers(
            fmt::format(
                "the motion of patch {} would need more than {} layers in the slab from t = {:.9g} to "
                "{:.9g}: with {}, it is {:.4g} local edge lengths off its chords and turns by {:.4g} "
                "degrees in a layer, worst near t = {:.9g}; check the motion, or make slabs shorter "
                "([time] slabs), or let chords be longer ([time] layer_tolerance, layers, spacing)",
                patch, task_.options.most, time_[0], time_[1], fit.layers, fit.deviation, fit.turn, fit.time),
            {{"patch", fit.patch, patch}});
    }

    const SweepTask<D>& task_;
    std::array<double, 2> time_;
};

void require_sense(const LayerOptions& options) {
    const bool sound = options.tolerance > 0 && options.turn > 0 && options.edges_across >= 0 &&
                       options.most >= 1 && options.at_least <= options.most;
    if (!sound) {
        throw UsageError{fmt::format("layers by the motion need a positive tolerance and turn, and at_least "
                                     "no larger than most, not {}, {}, {} and {}",
                                     options.tolerance, options.turn, options.at_least, options.most)};
    }
}

} // namespace

template<int D>
MeasuredSweep<D> sweep_measured(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                const PatchMotions<D>& motions, double motion_start,
                                std::vector<double> times, const TrajectoryOptions& trajectory,
                                const LayerOptions& options) {
    require_sense(options);
    return SweepTask<D>{boundary, cap, motions, motion_start, trajectory, options}.run(std::move(times),
                                                                                       true);
}

template<int D>
MeasuredSweep<D> sweep_in_layers(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                 const PatchMotions<D>& motions, double motion_start,
                                 std::array<double, 2> time, const TrajectoryOptions& trajectory,
                                 const LayerOptions& options) {
    require_sense(options);
    LayerOptions automatic = options;
    automatic.automatic = true;
    const SweepTask<D> task{boundary, cap, motions, motion_start, trajectory, automatic};
    return LayerSearch<D>{task, time}.run();
}

template MeasuredSweep<2> sweep_measured<2>(const Boundary<2>&, const SpatialMesh<2>&, const PatchMotions<2>&,
                                            double, std::vector<double>, const TrajectoryOptions&,
                                            const LayerOptions&);
template MeasuredSweep<3> sweep_measured<3>(const Boundary<3>&, const SpatialMesh<3>&, const PatchMotions<3>&,
                                            double, std::vector<double>, const TrajectoryOptions&,
                                            const LayerOptions&);
template MeasuredSweep<2> sweep_in_layers<2>(const Boundary<2>&, const SpatialMesh<2>&,
                                             const PatchMotions<2>&, double, std::array<double, 2>,
                                             const TrajectoryOptions&, const LayerOptions&);
template MeasuredSweep<3> sweep_in_layers<3>(const Boundary<3>&, const SpatialMesh<3>&,
                                             const PatchMotions<3>&, double, std::array<double, 2>,
                                             const TrajectoryOptions&, const LayerOptions&);

} // namespace slabhull
