// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/slab.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace slabhull {

/// Prepares the coming slabs of a march whose motions are known, while the caller works on those before. A
/// boundary at a slab's end follows from the boundary alone, and a cap from its boundary alone: so boundaries
/// are swept one after the other, and as many caps as memory and threads allow are meshed at once, those in
/// 3D each in a process of its own. The slabs are the same, bit for bit, as without. For CapReuse::none.
template<int D>
class CapsAhead {
public:
    /// The times of the slab that begins at `begin`, as build_slab() takes them; empty when none comes.
    using Levels = std::function<std::vector<double>(double begin)>;

    /// Begins at once, with the slab from `time`. `boundary` bounds `cap`, of which only the places of the
    /// boundary are asked: cells may be missing. Settings are copied; what their motions refer to is used by
    /// other threads for as long as this lives. On a single thread nothing is prepared.
    CapsAhead(const Boundary<D>& boundary, const SpatialMesh<D>& cap, double time, SlabSettings<D> settings,
              Levels levels);
    CapsAhead(const CapsAhead&) = delete;
    CapsAhead& operator=(const CapsAhead&) = delete;
    /// Stops within a second; processes are ended.
    ~CapsAhead();

    /// The slab at these times: waits for its cap. Empty when it is not prepared: the march took other times
    /// or has another boundary, or its preparation failed; then build_slab() says why. After that nothing
    /// more is prepared. Throws Interrupted when the caller's work is to stop.
    std::optional<PreparedSlab<D>> take(const Boundary<D>& boundary, const std::vector<double>& times);

private:
    class Planner;
    std::unique_ptr<Planner> planner_;
};

extern template class CapsAhead<2>;
extern template class CapsAhead<3>;

} // namespace slabhull
