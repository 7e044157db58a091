// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace slabhull {

/// Where the terminating cap of a slab comes from: meshed anew; the initial one with its vertices moved as
/// long as its cells stay good (geometry/cap_motion.h), else meshed anew; or the initial one with its
/// vertices moved and its connectivity changed where cells ask for it (slab/adapt.h).
enum class CapReuse { none, move, adapt };

} // namespace slabhull
