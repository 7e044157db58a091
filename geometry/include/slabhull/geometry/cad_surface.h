// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/projection.h"

#include <iosfwd>
#include <string>

namespace slabhull {

/// STEP (ISO 10303-21: AP203, AP214, AP242), and OpenCASCADE's own text format.
enum class CadFormat { step, brep };

/// Whether this library was built with OpenCASCADE. If not, cad_surface() always throws.
bool has_cad_surfaces();

/// The faces of a CAD model as a projection surface: the closest point of all faces, their edges and corners
/// included. Lengths stay in the file's own unit (its first one, if it has several): a STEP file in metres
/// gives metres, one in millimetres gives millimetres. The closest point is exact to rounding on planes,
/// cylinders, cones, spheres, tori and their trims, and refined to rounding on splines. Near an edge the
/// model itself is only accurate to tolerance(); within it faces take precedence over edges. `name` names the
/// file in messages. Throws UsageError without OpenCASCADE, InputError naming the file if it cannot be read
/// or holds no faces.
/// Cost of a closest point: one pass over the boxes of all faces and edges, then for each face whose box is
/// near enough microseconds if its shape is simple, some 50 to 500 for a spline.
ProjectionSurfacePointer<3> cad_surface(std::istream& in, CadFormat format, const std::string& name);

} // namespace slabhull
