// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/file_cursor.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace slabhull::io {

/// Finite, and within the range of single precision, so that products of three coordinates stay finite.
inline bool is_coordinate(double x) {
    return std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max());
}

inline std::string why_no_coordinate(double x, const std::string& whose) {
    return std::isfinite(x) ? fmt::format("{} has the coordinate {}, which is too large", whose, x)
                            : whose + " has a coordinate that is not a finite number";
}

/// Fails unless `x` is a coordinate.
inline void require_coordinate(const FileCursor& in, double x, const std::string& whose) {
    if (!is_coordinate(x)) {
        in.fail(why_no_coordinate(x, whose));
    }
}

} // namespace slabhull::io
