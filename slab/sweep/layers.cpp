// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/layers.h"

#include "slab/sweep/layer_meter.h"
#include "slab/sweep/share_levels.h"
#include "slab/sweep/sweep_start.h"
#include "slabhull/core/communicator.h"
#include "slabhull/slab/hull_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
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

/// How far a sweep has come: its end, or where it was given up.
struct SweepEnd {
    enum Step : std::size_t { moving, measuring, projecting };
    std::array<std::size_t, 2> at{}; ///< the layer, and the step in it
    std::exception_ptr error{};
};

/// The larger values of two fits, of which `later` is of later layers.
void take_in(const LayerFit& later, LayerFit& fit) {
    fit.deviation = std::max(fit.deviation, later.deviation);
    fit.turn = std::max(fit.turn, later.turn);
    if (later.growth > fit.growth) {
        fit.growth = later.growth;
        fit.patch = later.patch;
        fit.time = later.time;
    }
}

/// What one process would have found, that had measured all layers one after the other: where several ranks
/// gave up, the earliest step counts, with its error if it has one, and no later layer.
LayerFit fit_of_all(const LayerFit& mine, const SweepEnd& end, Communicator& ranks) {
    const auto ends = ranks.gather(end.at);
    const auto fits = ranks.gather(mine);
    const auto first = std::min_element(ends.begin(), ends.end());
    together(ranks, [&] {
        if (end.error && end.at == *first) {
            std::rethrow_exception(end.error);
        }
    });
    const bool given_up = std::any_of(ends.begin(), ends.end(), [&](const auto& at) { return at != *first; });
    const std::ptrdiff_t last = given_up ? first - ends.begin() + 1 : std::ssize(ends);
    LayerFit fit = fits.front();
    std::for_each(fits.begin() + 1, fits.begin() + last,
                  [&](const LayerFit& of_rank) { take_in(of_rank, fit); });
    return fit;
}

template<int D>
struct SweepTask {
    const Boundary<D>& boundary;
    const SpatialMesh<D>& cap;
    const PatchMotions<D>& motions;
    double motion_start;
    const TrajectoryOptions& trajectory;
    const LayerOptions& options;
    Communicator* ranks;

    MeasuredSweep<D> run(std::vector<double> times, bool to_the_end) const {
        MeasuredSweep<D> result{started_sweep(boundary, cap, std::move(times)), {}};
        SoleRank alone;
        Communicator& all = ranks != nullptr ? *ranks : alone;
        SweepEnd end;
        try {
            sweep_through(result, to_the_end, all, end);
        } catch (const GeometryError&) {
            end.error = std::current_exception();
        }
        result.fit = fit_of_all(result.fit, end, all);
        return result;
    }

private:
    /// Sweeps the boundary through all levels, and measures this rank's layers, of which it keeps the levels.
    void sweep_through(MeasuredSweep<D>& result, bool to_the_end, const Communicator& all,
                       SweepEnd& end) const {
        Sweep<D>& sweep = result.sweep;
        BoundaryMover<D> mover{sweep, motions, motion_start, trajectory};
        LayerMeter<D> meter{mover, sweep, options, sweep.layers(), sweep.times.front(), sweep.times.back()};
        result.fit = meter.fit();
        const HullRange measured = range_of_rank(sweep.layers(), all);
        const HullRange kept = levels_of(measured);
        for (std::size_t layer = 0; layer < sweep.layers(); ++layer) {
            const double from = sweep.times[layer];
            const double to = sweep.times[layer + 1];
            end.at = {layer, SweepEnd::moving};
            Array<Point<D>> places = mover.drift(sweep.positions.back(), from, to);
            end.at = {layer, SweepEnd::measuring};
            if (measured.contains(layer)) {
                meter.measure(sweep.positions.back(), places, from, to);
                result.fit = meter.fit();
                if (!to_the_end && result.fit.growth >= hopeless) {
                    return;
                }
            } else if (layer + 1 == measured.first) {
                meter.pass(places);
            }
            end.at = {layer, SweepEnd::projecting};
            mover.project(places, to);
            sweep.positions.push_back(std::move(places));
            if (layer > 0 && !kept.contains(layer)) {
                sweep.release(layer); // the motion goes on from the next level
            }
        }
        sweep.projected = mover.projected();
        end.at = {sweep.layers(), SweepEnd::moving};
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
                                const LayerOptions& options, Communicator* ranks) {
    require_sense(options);
    return SweepTask<D>{boundary, cap, motions, motion_start, trajectory, options, ranks}.run(
        std::move(times), true);
}

template<int D>
MeasuredSweep<D> sweep_in_layers(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                 const PatchMotions<D>& motions, double motion_start,
                                 std::array<double, 2> time, const TrajectoryOptions& trajectory,
                                 const LayerOptions& options, Communicator* ranks) {
    require_sense(options);
    LayerOptions automatic = options;
    automatic.automatic = true;
    const SweepTask<D> task{boundary, cap, motions, motion_start, trajectory, automatic, ranks};
    return LayerSearch<D>{task, time}.run();
}

template MeasuredSweep<2> sweep_measured<2>(const Boundary<2>&, const SpatialMesh<2>&, const PatchMotions<2>&,
                                            double, std::vector<double>, const TrajectoryOptions&,
                                            const LayerOptions&, Communicator*);
template MeasuredSweep<3> sweep_measured<3>(const Boundary<3>&, const SpatialMesh<3>&, const PatchMotions<3>&,
                                            double, std::vector<double>, const TrajectoryOptions&,
                                            const LayerOptions&, Communicator*);
template MeasuredSweep<2> sweep_in_layers<2>(const Boundary<2>&, const SpatialMesh<2>&,
                                             const PatchMotions<2>&, double, std::array<double, 2>,
                                             const TrajectoryOptions&, const LayerOptions&, Communicator*);
template MeasuredSweep<3> sweep_in_layers<3>(const Boundary<3>&, const SpatialMesh<3>&,
                                             const PatchMotions<3>&, double, std::array<double, 2>,
                                             const TrajectoryOptions&, const LayerOptions&, Communicator*);

} // namespace slabhull
