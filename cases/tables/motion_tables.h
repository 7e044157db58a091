// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/motion.h"

#include <filesystem>

namespace slabhull {

/// Times that a table must cover.
struct TimeInterval {
    double start;
    double end;
};

// Motions given by a file of rows (io::read_motion_table). Columns: `time`; of an angle A either `A`, in
// radians, or `A_deg`. Both throw InputError naming file, line and column for a table that is unsuitable, has
// unknown columns, or does not cover the time span.

/// Columns time and angle.
template<int D>
MotionPointer<D> rotation_from_file(const std::filesystem::path& path, const Point<D>& axis,
                                    const Point<D>& centre, const TimeInterval& span);

/// Columns time, x, y (, z), or none of these: no displacement; and the turn. D = 3: roll, pitch, yaw, or
/// qw, qx, qy, qz, or none. D = 2: angle, or the columns of D = 3 with z, roll and pitch all zero, or none.
template<int D>
MotionPointer<D> rigid_table_from_file(const std::filesystem::path& path, const Point<D>& centre,
                                       const TimeInterval& span);

} // namespace slabhull
