// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/motion.h"

#include <vector>

namespace slabhull {

// Motions of a rigid body given by rows, one per time. Between rows they are cubic splines with two
// continuous derivatives ("not-a-knot" ends), exact at the rows; the velocity is their derivative. For rows
// that sample a smooth motion, the error in between is of order 4 in their spacing, that of the velocity of
// order 3; two rows give a line, three a parabola. map() composes and inverts the rigid placements in closed
// form, so the body's position at the first row does not matter.
//
// The factories throw UsageError, with the entity "row" (counted from 0) where one is at fault: fewer than
// two rows, times not strictly ascending, a value not finite. velocity() and map() throw GeometryError,
// naming the times of the table, at times outside them by more than a billionth of their range.

/// Angles in radians by time. Angles are not reduced: more than half a turn between rows is taken literally.
struct AngleTable {
    std::vector<double> times;
    std::vector<double> angles;
};

/// Rotation about the axis through `centre` by the tabulated angle, right-handed (D = 2: counter-clockwise,
/// `axis` is ignored).
template<int D>
MotionPointer<D> rotation(const Point<D>& axis, const Point<D>& centre, const AngleTable& table);

/// Placements of a rigid body by time: a point x of the body at rest is at centre + shift + R (x - centre).
template<int D>
struct RigidTable {
    std::vector<double> times;
    std::vector<Point<D>> shifts; ///< one per time, or none: no displacement

    /// In radians, one set per time, or none. D = 2: counter-clockwise. D = 3: roll, pitch and yaw, with
    /// R = Rx(roll) Ry(pitch) Rz(yaw): the body yaws first. This is how OpenFOAM composes the angles of its
    /// tabulated6DoFMotion and sixDoFMotion (quaternion::XYZ in primitives/quaternion/quaternionI.H).
    /// Not reduced: more than half a turn between rows is taken literally.
    std::vector<Point<D == 2 ? 1 : 3>> angles;

    /// D = 3, instead of angles: unit quaternions w, x, y, z, of either sign, one per time, or none. They are
    /// normalised, given the sign nearer to the row before, interpolated by a spline, and normalised again.
    /// Two rows may be at most 179 degrees of rotation apart: beyond that its sense is ambiguous.
    std::vector<Point<4>> quaternions;
};

/// Motion with the rigid body. Throws UsageError also for arrays of different lengths, angles beside
/// quaternions, quaternions that are not of length 1 within 0.001 or for D = 2; velocity() and map() throw
/// GeometryError also if the spline of the quaternions comes near zero, since the rows are too far apart.
template<int D>
MotionPointer<D> rigid_table(const RigidTable<D>& table, const Point<D>& centre);

} // namespace slabhull
