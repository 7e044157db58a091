// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/progress.h"
#include "slabhull/slab/domain.h"
#include "slabhull/slab/slab.h"

#include <optional>
#include <utility>
#include <vector>

namespace slabhull {

/// The state of a march: all that its next slab depends on, except the settings.
template<int D>
struct MarchState {
    SpatialMesh<D> cap; ///< the next slab's initial cap
    double time = 0;    ///< time of `cap`
    int slab = 0;       ///< number of the next slab
    IdCounter ids;
    /// The boundary of `cap`, with its places at the motion's start, which series of displacements and
    /// stretching patches refer to. Its connectivity stays, unless AdaptOptions::boundary is set.
    Boundary<D> boundary;
    /// In ranks: the cells of `cap` that this one has; `cap` itself then has none.
    std::optional<CapCells<D>> cells{};
};

/// A march that begins with a domain at time `time`.
template<int D>
MarchState<D> march_from(Domain<D> domain, double time);

/// The same for a mesh that is sorted and numbered as that of a Domain. Throws GeometryError when its
/// boundary facets are no closed manifold.
template<int D>
MarchState<D> march_from(SpatialMesh<D> cap, double time, const IdCounter& ids);

/// The state of a march whose boundary is `boundary`, after a slab that starts from there; the slab's hull
/// stays. What March::accept() goes on from.
template<int D>
MarchState<D> state_after(const Boundary<D>& boundary, const Slab<D>& slab);

/// Builds slab after slab on a moving domain. A solver that predicts and corrects may propose slabs as often
/// as it likes: all start from the same initial cap, and nothing changes until one is accepted. All proposals
/// with the same number of layers and the same split give the same ids to the same vertices of cap, side and
/// terminating boundary, whatever the motion.
template<int D>
class March {
public:
    March(MarchState<D> state, SlabSettings<D> settings)
        : state_{std::move(state)}, settings_{std::move(settings)}, first_id_{first_id()} {}

    const MarchState<D>& state() const { return state_; }
    /// The settings, which may change between proposals.
    SlabSettings<D>& settings() { return settings_; }

    /// Builds the next slab over the levels `times`, the first of which is the march's time. Its hull is not
    /// checked as a whole. Throws as build_slab() does; TangledBoundary says how far a slab could go.
    Slab<D> propose(std::vector<double> times, StageClock& clock) const;
    Slab<D> propose(std::vector<double> times) const;

    /// As propose(), for a march that never goes back: the initial cap is released once it is in the hull, so
    /// that it is not held twice. After that the march can only accept this slab.
    Slab<D> build(std::vector<double> times, StageClock& clock);
    /// The same of a slab that was prepared for this march's boundary and settings, see CapsAhead.
    Slab<D> build(PreparedSlab<D> prepared, StageClock& clock);

    /// Advances the march to the slab's end and releases the slab's hull. Throws UsageError for a slab that
    /// was not proposed from here.
    void accept(Slab<D>&& slab);
    /// The same; the slab keeps its hull.
    void accept(const Slab<D>& slab);

    /// Calls `progress` during propose() and build(). If it returns false they stop within a second: they
    /// throw Interrupted and leave the march unchanged.
    void on_progress(Progress progress) { progress_ = progress ? std::move(progress) : goes_on; }

private:
    static bool goes_on(const WorkState&) { return true; }
    void require_times(const std::vector<double>& times) const;
    /// Identifies the initial cap; -1 if it has no vertices.
    CapToStitch<D> give_up_cap();
    PersistentId first_id() const { return state_.cap.vertex_ids.empty() ? -1 : state_.cap.vertex_ids[0]; }

    MarchState<D> state_;
    SlabSettings<D> settings_;
    PersistentId first_id_;
    Progress progress_ = goes_on;
};

extern template class March<2>;
extern template class March<3>;

} // namespace slabhull
