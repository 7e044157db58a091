// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/trajectory.h"
#include "slabhull/topology/prism_split.h"

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace slabhull {

/// A number list as written in a case file: D entries, or 3 for axes.
using Numbers = std::vector<double>;

/// A closed surface (D = 3) or curve (D = 2) from a file, kept as it is.
struct BodyFile {
    std::filesystem::path file;
    std::string patch;
};

/// An ellipsoid or ellipse meshed by Slabhull: those of the experiments.
struct EllipsoidBody {
    Numbers centre;
    Numbers semi_axes;
    int frequency = 1; ///< D = 3: 20 frequency^2 triangles; D = 2: number of edges
    std::string patch;
};

struct BoxSpec {
    Numbers min;
    Numbers max;
    double size = 0;
    std::string patch = "walls";
};

/// The domain as a mesh that exists: boundary facets in no group get the patch "boundary".
struct InitialMesh {
    std::filesystem::path file;
};

/// The domain as an outer boundary with bodies inside, to be meshed first.
struct InitialBodies {
    std::vector<BodyFile> files;
    std::vector<EllipsoidBody> ellipsoids;
    std::variant<BoxSpec, BodyFile> outer;
};

struct MotionSpec {
    enum class Kind { rotation, translation, expansion, velocity };
    Kind kind = Kind::translation;
    Numbers axis{0, 0, 1};
    Numbers centre;
    Numbers velocity;
    double rate = 0;
    std::vector<std::string> formula;
    std::map<std::string, double> constants;
};

struct ProjectionSpec {
    enum class Kind { sphere, ellipsoid, cylinder, plane };
    Kind kind = Kind::sphere;
    Numbers centre;    ///< a point of the axis for a cylinder, a point of the plane
    Numbers direction; ///< axis of a cylinder, normal of a plane
    Numbers semi_axes; ///< all equal for a sphere or circle
    double radius = 0; ///< of a cylinder
};

/// Where the terminating cap of a slab comes from: meshed anew, or the initial one with its vertices moved as
/// long as its cells stay good (geometry/cap_motion.h).
enum class CapReuse { none, move };

/// A case as a case file says it (docs/case-file.md), with everything checked that can be without reading
/// other files.
struct Case {
    std::string title;
    int dimension = 3;
    std::string experiment; ///< empty unless it is one
    int level = 0;
    std::variant<InitialMesh, InitialBodies> initial;

    double start = 0;
    double end = 1;
    int slabs = 1;
    std::optional<int> layers;     ///< of each slab's side ...
    std::optional<double> spacing; ///< ... or the longest duration of a layer

    std::map<std::string, MotionSpec> motions; ///< by patch
    std::map<std::string, ProjectionSpec> projections;
    TrajectoryOptions trajectory;
    Split split = Split::C;
    Diagonals diagonals = Diagonals::shape; ///< of splits B and D
    double cap_size = std::numeric_limits<double>::infinity();
    double cap_growth = 0.3;
    double cap_quality = 1.414;
    bool cap_curve_order = true; ///< `cap.order = "curve"`
    CapReuse cap_reuse = CapReuse::none;
    double cap_reuse_angle = 5; ///< degrees; a moved cap with a smaller (dihedral) angle is meshed anew

    std::filesystem::path directory = "out";
    std::vector<std::string> formats{"vtu", "msh"};

    /// When slab `slab` begins; that of `slabs` is the end.
    double slab_begin(int slab) const;
    /// The times of the levels of a slab, from its beginning to its end.
    std::vector<double> level_times(int slab) const;
};

/// Reads a case file. Paths in it are taken relative to it.
/// Throws InputError when it cannot be read, UsageError naming key, line and what was expected otherwise.
Case read_case(const std::filesystem::path& path);

/// One of the paper's six experiments at a level (a row of its tables), ready to run.
/// Throws UsageError naming the experiments or the levels that there are.
Case experiment_case(const std::string& name, int level);

/// The same with any refinement: the spacings of body, box and time are divided by it.
Case experiment_at(const std::string& name, double refinement);

} // namespace slabhull
