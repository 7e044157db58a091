// SPDX-License-Identifier: BSD-3-Clause
// TetGen 1.5 (H. Si, ACM TOMS 41(2), 2015) as the mesher of 3D caps. It crashes on surfaces that cross
// themselves, prints, keeps global state and throws bare numbers: so it runs in a child process, and what it
// sends is verified.
#include "slabhull/geometry/cap_mesher.h"

#include "child_process.h"
#include "hole_seeds.h"
#include "mesh_order.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"

#include <fmt/format.h>
#include <tetgen.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <limits>
#include <new>
#include <string>
#include <vector>

namespace slabhull {

namespace {

/// First words from the child.
struct Heading {
    std::int32_t status = 0; ///< 0 for success, else what TetGen threw
    std::int64_t points = 0;
    std::int64_t cells = 0;
};
constexpr std::int32_t out_of_memory = 1; // TetGen's own number for it

// --- In the child
// ---------------------------------------------------------------------------------------------

/// What TetGen's callback, a bare function, looks at.
const SizeField<3>* wanted_size = nullptr;

double squared_distance(const REAL* p, const REAL* q) {
    const double x = p[0] - q[0];
    const double y = p[1] - q[1];
    const double z = p[2] - q[2];
    return x * x + y * y + z * z;
}

/// Longest edge of a cell, in wanted spacings, that is still let be: makes the mean edge about as long as the
/// spacing.
constexpr double longest_edge = 1.7;

/// Whether a tetrahedron is to be split for its size. TetGen hands in a volume of 0, so look at the corners.
/// (Its own way, a size per boundary vertex, interpolates between opposite walls and knows neither growth nor
/// a largest size.)
bool too_large(REAL* a, REAL* b, REAL* c, REAL* d, REAL*, REAL) {
    const std::array<const REAL*, 4> corners{a, b, c, d};
    Point<3> centroid{};
    double longest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            centroid[k] += corners[i][k] / 4;
        }
        for (std::size_t j = 0; j < i; ++j) {
            longest = std::max(longest, squared_distance(corners[i], corners[j]));
        }
    }
    const double bound = longest_edge * (*wanted_size)(centroid);
    return longest > bound * bound;
}

/// The surface in TetGen's terms. It is never destroyed, for the child just ends: its lists need not come
/// from `new`.
struct TetgenInput {
    TetgenInput(const Surface<3>& surface, const std::vector<Point<3>>& holes);

    tetgenio plc;
    std::vector<int> corners;
    std::vector<tetgenio::polygon> triangles;
    std::vector<tetgenio::facet> facets;
};

TetgenInput::TetgenInput(const Surface<3>& surface, const std::vector<Point<3>>& holes)
    : corners(3 * surface.facets.size()), triangles(surface.facets.size()), facets(surface.facets.size()) {
    for (std::size_t f = 0; f < facets.size(); ++f) {
        std::copy(surface.facets[f].begin(), surface.facets[f].end(),
                  corners.begin() + 3 * static_cast<long>(f));
        triangles[f] = {corners.data() + 3 * f, 3};
        facets[f] = {&triangles[f], 1, nullptr, 0};
    }
    // TetGen only reads what it is given
    plc.pointlist = const_cast<REAL*>(surface.points.data()->data());
    plc.numberofpoints = static_cast<int>(surface.points.size());
    plc.facetlist = facets.data();
    plc.numberoffacets = static_cast<int>(facets.size());
    plc.holelist = const_cast<REAL*>(holes.empty() ? nullptr : holes.data()->data());
    plc.numberofholes = static_cast<int>(holes.size());
    plc.tetunsuitable = too_large;
}

/// TetGen's lists are ours bit for bit: its cells are positively oriented too, neighbour i is across from
/// corner i, and its -1 for no neighbour has the bits of no_index.
void send_mesh(const Send& send, const tetgenio& mesh) {
    static_assert(sizeof(int) == sizeof(Index) && sizeof(Point<3>) == 3 * sizeof(REAL));
    const Heading heading{0, mesh.numberofpoints, mesh.numberoftetrahedra};
    const std::size_t list = static_cast<std::size_t>(mesh.numberoftetrahedra) * sizeof(Simplex<3>);
    send(&heading, sizeof heading);
    send(mesh.pointlist, static_cast<std::size_t>(mesh.numberofpoints) * sizeof(Point<3>));
    send(mesh.tetrahedronlist, list);
    send(mesh.neighborlist, list);
}

/// p: a boundary is given; Y: keep it; n: neighbours; Q: quiet; q: bounds on radius-edge ratio and dihedral
/// angle.
std::string switches(const CapOptions& options) {
    return fmt::format("pYnQq{:.4f}/{:.4f}", options.radius_edge, options.min_dihedral);
}

void mesh_and_send(const Surface<3>& surface, const std::vector<Point<3>>& holes, const SizeField<3>& size,
                   const CapOptions& options, const Send& send) {
    std::int32_t status = 0;
    try {
        wanted_size = &size;
        auto* input = new TetgenInput{surface, holes};
        auto* mesh = new tetgenio; // neither is deleted: the child ends
        tetrahedralize(switches(options).data(), &input->plc, mesh);
        return send_mesh(send, *mesh);
    } catch (const int thrown) {
        status = thrown;
    } catch (const std::bad_alloc&) {
        status = out_of_memory;
    }
    const Heading heading{status, 0, 0};
    send(&heading, sizeof heading);
}

// --- In the parent
// ----------------------------------------------------------------------------------------------

std::string thrown_in_words(std::int32_t status) {
    switch (status) {
    case out_of_memory:
        return "ran out of memory";
    case 3:
        return "found that the surface crosses itself";
    case 4:
    case 5:
        return "found facets or vertices too close to each other to tell apart";
    case 10:
        return "did not accept the surface";
    default:
        return fmt::format("gave up with its internal error {}", status);
    }
}

std::string end_in_words(const ChildEnd& end, const Heading& heading) {
    if (end.received) {
        return thrown_in_words(heading.status);
    }
    if (end.signal == SIGKILL) {
        return "was killed, most likely for want of memory (it needs about 300 bytes per tetrahedron)";
    }
    const std::string how =
        end.signal != 0 ? fmt::format("signal {}", end.signal) : fmt::format("exit code {}", end.exit_code);
    return fmt::format("crashed ({}); it does so on a surface that crosses, touches or nearly touches itself",
                       how);
}

bool receive_mesh(const Receive& receive, Heading& heading, CapMesh<3>& mesh) {
    if (!receive(&heading, sizeof heading)) {
        return false;
    }
    mesh.points.resize(static_cast<std::size_t>(heading.points));
    mesh.cells.resize(static_cast<std::size_t>(heading.cells));
    mesh.neighbors.resize(static_cast<std::size_t>(heading.cells));
    const auto fill = [&](auto& array) { return receive(array.data(), array.size() * sizeof array[0]); };
    return fill(mesh.points) && fill(mesh.cells) && fill(mesh.neighbors);
}

/// TetGen's indices are ints.
void require_fits(const Surface<3>& surface) {
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max());
    if (surface.points.size() > most || surface.facets.size() > most / 3) {
        throw LimitError{fmt::format("the 3D mesher cannot number {} points and {} facets",
                                     surface.points.size(), surface.facets.size())};
    }
}

void require_sane(const CapOptions& options) {
    if (!(options.radius_edge >= 1 && options.radius_edge <= 100)) {
        throw UsageError{
            fmt::format("the radius-edge bound must be between 1 and 100, not {}", options.radius_edge)};
    }
    if (!(options.min_dihedral >= 0 && options.min_dihedral <= 20)) {
        throw UsageError{fmt::format("the wanted dihedral angle must be between 0 and 20 degrees, not {}",
                                     options.min_dihedral)};
    }
}

} // namespace

template<>
CapMesh<3> mesh_cap<3>(const Surface<3>& surface, const CapOptions& options) {
    require_sane(options);
    require_fits(surface);
    require_domain_boundary(surface, {}, false); // TetGen crashes, or never ends, on anything else
    const std::vector<Point<3>> holes = hole_seeds(surface);
    const SizeField<3> size{surface.points, boundary_spacing<3>(surface.points, surface.facets),
                            options.grading};

    CapMesh<3> mesh;
    Heading heading;
    const ChildEnd end =
        run_in_child([&](const Send& send) { mesh_and_send(surface, holes, size, options, send); },
                     [&](const Receive& receive) { return receive_mesh(receive, heading, mesh); });
    if (!end.received || heading.status != 0) {
        throw GeometryError{fmt::format("the 3D mesher, given a surface of {} triangles and {} points, {}",
                                        surface.facets.size(), surface.points.size(),
                                        end_in_words(end, heading))};
    }
    if (options.along_curve) {
        order_along_curve(mesh, surface.points.size());
    }
    verify_cap(mesh, surface);
    return mesh;
}

} // namespace slabhull
