// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/caps_ahead.h"

#include "geometry/meshing/cap_limits.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

namespace slabhull {

namespace {

/// Of a cap that is meshed and kept, per cell: TetGen's process and what comes back.
constexpr double bytes_per_cap_cell = 600;
/// Part of the free memory that caps may take ahead of their slabs.
constexpr double share_of_memory = 0.25;

constexpr auto moment = std::chrono::milliseconds{20};

} // namespace

/// Sweeps the boundary on a thread of its own, which starts a thread for each cap.
template<int D>
class CapsAhead<D>::Planner {
public:
    Planner(const Boundary<D>& boundary, const SpatialMesh<D>& cap, double time, SlabSettings<D> settings,
            Levels levels)
        : boundary_{boundary.bounding({})}, settings_{std::move(settings)}, levels_{std::move(levels)},
          time_{time} {
        for (const Index v : boundary.mesh_vertices()) {
            places_.points.push_back(cap.points[v]);
        }
        thread_ = std::jthread{BackgroundStage{"trajectories"}.counted([this] { run(); })};
    }
    Planner(const Planner&) = delete;
    Planner& operator=(const Planner&) = delete;
    ~Planner() {
        stop();
        thread_.join(); // before the caps, which it may still be adding to
        coming_.clear();
    }

    std::optional<PreparedSlab<D>> take(const Boundary<D>& boundary, const std::vector<double>& times) {
        Coming* next = wait_for_next();
        if (next == nullptr || next->times != times || !is_same(boundary)) {
            stop();
            return std::nullopt;
        }
        next->stage.show();
        while (next->slab.wait_for(moment) == std::future_status::timeout) {
            go_on();
        }
        std::optional<PreparedSlab<D>> taken = next->slab.get();
        const std::lock_guard guard{lock_};
        coming_.pop_front();
        changed_.notify_all();
        return taken;
    }

private:
    struct Coming {
        std::vector<double> times;
        BackgroundStage stage{cap_meshing_stage};
        std::future<std::optional<PreparedSlab<D>>> slab; ///< empty if it failed
    };

    void stop() {
        const std::lock_guard guard{lock_};
        stopping_ = true;
        changed_.notify_all();
    }

    /// Null when nothing more comes. Only the thread that asks removes what it got.
    Coming* wait_for_next() {
        std::unique_lock guard{lock_};
        while (coming_.empty() && !ended_) {
            changed_.wait_for(guard, moment);
            guard.unlock();
            go_on();
            guard.lock();
        }
        return coming_.empty() ? nullptr : &coming_.front();
    }

    /// Whether caps of another boundary have the same facets in the same order, and move alike.
    bool is_same(const Boundary<D>& other) const {
        return std::ranges::equal(boundary_.facets(), other.facets()) &&
               std::ranges::equal(boundary_.patch(), other.patch()) &&
               std::ranges::equal(boundary_.start(), other.start()) &&
               std::ranges::equal(boundary_.tracks(), other.tracks());
    }

    void run() {
        const ProgressScope scope{[this](const WorkState&) { return !stopping_; }};
        try {
            const std::size_t most = caps_at_once();
            while (wait_for_room(most) && prepare_next()) {
            }
        } catch (const std::exception&) { // build_slab() will meet it again, and say so
        }
        const std::lock_guard guard{lock_};
        ended_ = true;
        changed_.notify_all();
    }

    /// By threads and memory; 0 on a single thread, where nothing would be gained.
    std::size_t caps_at_once() const {
        if (thread_count() < 2) {
            return 0;
        }
        const double bytes =
            bytes_per_cap_cell * most_cap_cells<D>(boundary_, places_.points, settings_.cap.grading);
        const double fit = share_of_memory * static_cast<double>(available_memory()) / bytes;
        return static_cast<std::size_t>(std::min(fit, static_cast<double>(thread_count())));
    }

    /// False when nothing more is to be prepared.
    bool wait_for_room(std::size_t most) {
        std::unique_lock guard{lock_};
        changed_.wait(guard, [&] { return stopping_ || most == 0 || coming_.size() < most; });
        return !stopping_ && most > 0;
    }

    /// False at the end of the march.
    bool prepare_next() {
        std::vector<double> times = levels_(time_);
        if (times.empty()) {
            return false;
        }
        PreparedSlab<D> swept = sweep_ahead<D>(boundary_, places_, times, settings_);
        settings_.layers.suggest = settings_.layers.suggest && swept.layers.sound(); // one suggestion will do
        time_ = times.back();
        places_.points = swept.sweep.positions.back();
        Coming next{std::move(times), BackgroundStage{cap_meshing_stage}, {}};
        next.slab =
            std::async(std::launch::async, next.stage.counted([this, swept = std::move(swept)]() mutable {
                return meshed(std::move(swept));
            }));
        const std::lock_guard guard{lock_};
        coming_.push_back(std::move(next));
        changed_.notify_all();
        return true;
    }

    std::optional<PreparedSlab<D>> meshed(PreparedSlab<D> slab) const {
        try {
            mesh_ahead<D>(slab, settings_.cap);
            return slab;
        } catch (const std::exception&) { // as above
            return std::nullopt;
        }
    }

    Boundary<D> boundary_;
    SlabSettings<D> settings_;
    Levels levels_;
    double time_;
    SpatialMesh<D> places_; ///< of the boundary at time_: points alone
    std::mutex lock_;       ///< for all below
    std::condition_variable changed_;
    std::atomic<bool> stopping_{false};
    std::deque<Coming> coming_;
    bool ended_ = false;
    std::jthread thread_;
};

template<int D>
CapsAhead<D>::CapsAhead(const Boundary<D>& boundary, const SpatialMesh<D>& cap, double time,
                        SlabSettings<D> settings, Levels levels)
    : planner_{std::make_unique<Planner>(boundary, cap, time, std::move(settings), std::move(levels))} {}

template<int D>
CapsAhead<D>::~CapsAhead() = default;

template<int D>
std::optional<PreparedSlab<D>> CapsAhead<D>::take(const Boundary<D>& boundary,
                                                  const std::vector<double>& times) {
    return planner_->take(boundary, times);
}

template class CapsAhead<2>;
template class CapsAhead<3>;

} // namespace slabhull
