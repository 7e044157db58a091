// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/march.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

template<int D>
MarchState<D> march_from(SpatialMesh<D> cap, double time, const IdCounter& ids) {
    Boundary<D> boundary = boundary_of(cap);
    return {std::move(cap), time, 0, ids, std::move(boundary)};
}

template<int D>
MarchState<D> march_from(Domain<D> domain, double time) {
    return march_from<D>(std::move(domain.mesh), time, domain.ids);
}

template<int D>
void March<D>::require_times(const std::vector<double>& times) const {
    if (times.size() < 2 || times.front() != state_.time || !(times.front() < times.back())) {
        throw UsageError(
            fmt::format("a slab must go from the march's time, {}, to a later one", state_.time));
    }
    const auto late = std::ranges::adjacent_find(times, [](double a, double b) { return !(a < b); });
    if (late != times.end()) {
        throw UsageError(
            fmt::format("the levels of a slab must ascend, but {} comes after {}", *(late + 1), *late));
    }
    if (state_.cap.points.empty()) {
        throw UsageError("the march has given its initial cap up for a slab that was not accepted");
    }
}

template<int D>
Slab<D> March<D>::propose(std::vector<double> times, StageClock& clock) const {
    require_times(times);
    const ProgressScope scope{progress_};
    return build_slab<D>(state_.cap, state_.boundary, state_.slab, std::move(times), settings_, state_.ids,
                         clock);
}

template<int D>
Slab<D> March<D>::propose(std::vector<double> times) const {
    StageClock clock;
    return propose(std::move(times), clock);
}

template<int D>
CapToStitch<D> March<D>::give_up_cap() {
    CapToStitch<D> cap{std::move(state_.cap)};
    if (state_.cells) {
        cap.give_cells(*state_.cells);
    }
    return cap;
}

template<int D>
Slab<D> March<D>::build(std::vector<double> times, StageClock& clock) {
    require_times(times);
    const ProgressScope scope{progress_};
    return build_slab<D>(give_up_cap(), state_.boundary, state_.slab, std::move(times), settings_, state_.ids,
                         clock);
}

template<int D>
Slab<D> March<D>::build(PreparedSlab<D> prepared, StageClock& clock) {
    require_times(prepared.sweep.times);
    const ProgressScope scope{progress_};
    return build_slab<D>(give_up_cap(), state_.boundary, state_.slab, std::move(prepared), settings_,
                         state_.ids, clock);
}

template<int D>
MarchState<D> state_after(const Boundary<D>& boundary, const Slab<D>& slab) {
    MarchState<D> state{slab.terminating(), slab.hull.time[1], slab.hull.slab + 1, slab.next_ids, {}};
    state.boundary = slab.boundary.value_or(boundary).bounding(state.cap.vertex_ids);
    if (slab.part) {
        state.cells = terminating_cells_of(*slab.part, slab.hull);
    }
    return state;
}

template<int D>
void March<D>::accept(Slab<D>&& slab) {
    accept(slab);
    slab.hull = {};
}

template<int D>
void March<D>::accept(const Slab<D>& slab) {
    const bool from_here =
        slab.part || (!slab.hull.vertex_ids.empty() && slab.hull.vertex_ids[0] == first_id_);
    if (slab.hull.slab != state_.slab || slab.hull.time[0] != state_.time || !from_here) {
        throw UsageError(
            fmt::format("slab {} from t = {} was not proposed by this march, which is at slab {} "
                        "and t = {}",
                        slab.hull.slab, slab.hull.time[0], state_.slab, state_.time));
    }
    state_.cap = {}; // before the next one is made
    state_ = state_after(state_.boundary, slab);
    first_id_ = first_id();
}

template MarchState<2> march_from<2>(Domain<2>, double);
template MarchState<3> march_from<3>(Domain<3>, double);
template MarchState<2> march_from<2>(SpatialMesh<2>, double, const IdCounter&);
template MarchState<3> march_from<3>(SpatialMesh<3>, double, const IdCounter&);
template MarchState<2> state_after<2>(const Boundary<2>&, const Slab<2>&);
template MarchState<3> state_after<3>(const Boundary<3>&, const Slab<3>&);
template class March<2>;
template class March<3>;

} // namespace slabhull
