// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/displacement_series.h"
#include "slabhull/geometry/trajectory.h"
#include "slabhull/io/formats.h"
#include "slabhull/io/space_time_files.h"
#include "slabhull/slab/adapt.h"
#include "slabhull/slab/cap_reuse.h"
#include "slabhull/slab/fill.h"
#include "slabhull/topology/prism_split.h"

#include <array>
#include <cstdint>
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
    std::string patch;            ///< of all facets, or
    bool patches_of_file = false; ///< .. of those in no named part: named parts of the file are patches
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
    std::vector<std::string> regions; ///< groups of cells that are the domain; empty: all cells
    io::ReadOptions reading;
};

/// The domain as an outer boundary with bodies inside, to be meshed first.
struct InitialBodies {
    std::vector<BodyFile> files;
    std::vector<EllipsoidBody> ellipsoids;
    std::variant<BoxSpec, BodyFile> outer;
};

/// Files that say how the vertices of a patch are displaced, one for each time.
struct DisplacementSpec {
    std::vector<std::filesystem::path> files; ///< by time; or, when empty:
    std::filesystem::path pattern;            ///< '*' in its file name stands for a number
    std::vector<double> times;                ///< empty: where the files say
    std::string array = "displacement";       ///< of VTU files
    std::optional<double> tolerance;          ///< between vertices and rows; by default by the patch's extent
    TimeInterpolation interpolation = TimeInterpolation::cubic;
};

struct MotionSpec {
    enum class Kind {
        rotation,
        translation,
        expansion,
        velocity,
        rigid_table,
        sequence,
        displacement_series,
        stretch
    };
    Kind kind = Kind::translation;
    Numbers axis{0, 0, 1};
    Numbers centre;
    Numbers velocity;
    double rate = 0;
    std::vector<std::string> formula;
    std::map<std::string, double> constants;
    std::filesystem::path table;   ///< of a rigid table; of a rotation where it is not empty, for the rate
    std::vector<MotionSpec> steps; ///< of a sequence, inner first
    DisplacementSpec displacements;

    /// Whether a field of velocities describes it, which motion_of() makes.
    bool is_field() const { return kind != Kind::displacement_series && kind != Kind::stretch; }
};

struct ProjectionSpec {
    enum class Kind { sphere, ellipsoid, cylinder, plane, file };
    Kind kind = Kind::sphere;
    Numbers centre;    ///< a point of the axis for a cylinder, a point of the plane
    Numbers direction; ///< axis of a cylinder, normal of a plane
    Numbers semi_axes; ///< all equal for a sphere or circle
    double radius = 0; ///< of a cylinder
    std::filesystem::path file;
};

/// By extrusion of caps that are one mesh moved, or unstructured in space-time (D = 2).
enum class FillMethod { march, tetgen };

/// The table [fill]: slabs are filled with space-time simplices.
struct FillSpec {
    FillMethod method = FillMethod::march;
    UnstructuredFill unstructured;
    std::vector<std::string> formats{"mfem"};
    int pentatope_code = io::usual_pentatope_code;
};

/// A case as a case file says it (docs/case-file.md), with everything checked that can be without reading
/// other files.
struct Case {
    std::string title;
    std::filesystem::path file; ///< that it stands in, for messages; empty where there is none
    std::uint32_t checksum = 0; ///< of the file's bytes
    int dimension = 3;
    std::string experiment; ///< empty unless it is one
    int level = 0;
    std::variant<InitialMesh, InitialBodies> initial;

    double start = 0;
    double end = 1;
    int slabs = 1;
    std::optional<int> layers; ///< of each slab's side ...
    std::optional<double>
        spacing; ///< ... or the longest duration of a layer; else they follow from the motion
    double layer_tolerance = 0.05; ///< LayerOptions::tolerance
    bool adapt = false;            ///< a slab ends before its boundary tangles ...
    double adapt_floor = 0.01;     ///< ... but lasts at least this part of what it should

    std::map<std::string, MotionSpec> motions; ///< by patch
    std::map<std::string, ProjectionSpec> projections;
    TrajectoryOptions trajectory;
    Split split = Split::C;
    Diagonals diagonals = Diagonals::shape; ///< of splits B and D
    double cap_size = std::numeric_limits<double>::infinity();
    double cap_growth = 0.3;
    double cap_quality = 1.414;
    bool cap_curve_order = true;                  ///< `cap.order = "curve"`
    SolidMesher cap_mesher = SolidMesher::tetgen; ///< D = 3
    int cap_blocks = 0;                           ///< D = 3; 0: chosen by memory
    CapReuse cap_reuse = CapReuse::none;
    double cap_reuse_angle = 5; ///< degrees; a moved cap with a smaller (dihedral) angle is meshed anew

    double adapt_size = std::numeric_limits<double>::infinity(); ///< bound on target lengths inside
    double adapt_angle = 10;                                     ///< degrees aimed at
    bool adapt_boundary = false; ///< whether the boundary's connectivity is adapted, too
    double adapt_feature_angle = 40;
    double adapt_distance = 0.25;
    std::map<std::string, PatchAdaptation> adapt_patches; ///< by name

    bool check_embedding = true;  ///< hulls must be proven not to cross themselves
    std::optional<FillSpec> fill; ///< needs CapReuse::move or adapt, unless by TetGen

    std::filesystem::path directory = "out";
    std::vector<std::string> formats{"vtu", "msh"};
    std::map<std::string, io::WriteOptions> writing; ///< how, by format

    io::WriteOptions writing_of(const std::string& format) const {
        const auto found = writing.find(format);
        return found == writing.end() ? io::WriteOptions{} : found->second;
    }
    /// When slab `slab` begins; that of `slabs` is the end.
    double slab_begin(int slab) const;
    /// The end of the slab that begins at `time`, unless tangling cuts it short.
    double slab_end(double time) const;
    bool layers_follow_motion() const { return !layers && !spacing; }
    /// The times of the levels of a slab, from its beginning to its end: these two alone where layers follow
    /// from the motion.
    std::vector<double> level_times(double begin, double end) const;
    std::vector<double> level_times(int slab) const {
        return level_times(slab_begin(slab), slab_begin(slab + 1));
    }
};

/// Reads a case file. Paths in it are taken relative to it.
/// Throws InputError when it cannot be read, UsageError naming key, line and what was expected otherwise.
Case read_case(const std::filesystem::path& path);
/// The same of a text, as if it stood in the file `path`, which messages name and which need not exist.
Case parse_case(const std::string& text, const std::filesystem::path& path);

/// One of the paper's six experiments at a level (a row of its tables), ready to run.
/// Throws UsageError naming the experiments or the levels that there are.
Case experiment_case(const std::string& name, int level);

/// Where most simplices of an experiment's hull are, for D = 3 (for D = 2 there is one set of spacings).
enum class Bulk {
    side, ///< as in the paper: many layers in split E, caps that are coarse inside
    caps  ///< the caps' meshing is nearly all the work: few layers in split C, caps that are fine inside
};

/// The same with any refinement: the spacings of body, box and time are divided by it. For `Bulk::side`,
/// refinements of about 1 are level 1.
Case experiment_at(const std::string& name, double refinement, Bulk bulk = Bulk::side);

} // namespace slabhull
