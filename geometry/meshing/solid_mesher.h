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

/// Fills the inside of a closed surface, in a child process. What comes back is to be verified.
/// Needs: the boundary of a domain, see require_domain_boundary().
/// Throws GeometryError when the mesher fails, UsageError when this build does not have it.
CapMesh<3> fill_with_tetgen(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                            const CapOptions& options);
CapMesh<3> fill_with_hxt(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                         const CapOptions& options);

bool has_tetgen();
bool has_hxt();

/// First words from a mesher's child; points, cells and neighbours follow.
struct MesherHeading {
    std::int32_t status = 0; ///< 0 for success, else what went wrong
    std::int64_t points = 0;
    std::int64_t cells = 0;
    std::int64_t neighbors = 0;   ///< as many as cells, or none: then they are found here
    std::array<char, 200> said{}; ///< the mesher's own words, for errors
};

/// Longest edge of a cell, in wanted spacings, that is still let be: makes the mean edge about as long as the
/// spacing.
inline constexpr double longest_edge = 1.7;

/// Runs `job` in a child and takes the mesh that it sends.
/// Throws GeometryError saying how the child ended, `words` for a heading that is not of success.
CapMesh<3> fill_in_child(const Surface<3>& surface, const std::function<void(const Send&)>& job,
                         const std::function<std::string(const MesherHeading&)>& words);

} // namespace slabhull
