// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/child_process.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/size_field.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>

namespace slabhull {

/// Fills the inside of a closed surface, in a child process. The caller must verify the result.
/// Needs: the boundary of a domain, see require_domain_boundary().
/// Throws GeometryError if the mesher fails, UsageError if this build does not have it.
CapMesh<3> fill_with_tetgen(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                            const CapOptions& options);
CapMesh<3> fill_with_hxt(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                         const CapOptions& options);

/// With the mesher that is chosen.
CapMesh<3> fill_solid(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                      const CapOptions& options);

bool has_tetgen();
bool has_hxt();

/// The header that a mesher's child sends; points, cells and neighbours follow.
struct MesherHeading {
    std::int32_t status = 0; ///< 0 for success, else what went wrong
    std::int64_t points = 0;
    std::int64_t cells = 0;
    std::int64_t neighbors = 0;   ///< as many as cells, or none: then they are computed here
    std::array<char, 200> said{}; ///< the mesher's message, for errors
};

/// Longest edge of a cell, in wanted spacings, that is not split: makes the mean edge about as long as the
/// spacing.
inline constexpr double longest_edge = 1.7;

/// Runs a mesher in a child, and receives the mesh that it sends.
using RunMesher = std::function<ChildEnd(const std::function<bool(const Receive&)>& receive)>;
/// Throws GeometryError saying how the child ended, or with `words` if the heading reports a failure.
CapMesh<3> fill_in_child(const Surface<3>& surface, const RunMesher& run,
                         const std::function<std::string(const MesherHeading&)>& words);

} // namespace slabhull
