// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/file_cursor.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace slabhull::io {

/// Throws unless x is finite and, because OpenMesh reads it so, within the range of single precision.
inline void require_coordinate(const FileCursor& in, double x, const std::string& whose) {
    if (!std::isfinite(x)) {
        in.fail(whose + " has a coordinate that is not a finite number");
    }
    if (std::abs(x) > static_cast<double>(std::numeric_limits<float>::max())) {
        in.fail(fmt::format("{} has the coordinate {}, which is too large", whose, x));
    }
}

} // namespace slabhull::io
