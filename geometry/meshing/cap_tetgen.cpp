// SPDX-License-Identifier: BSD-3-Clause
// TetGen 1.5 (H. Si, ACM TOMS 41(2), 2015) as the mesher of 3D caps. It crashes on surfaces that cross
// themselves, prints, keeps global state and throws bare numbers. So it runs in a child process, and its
// result is verified.
#include "geometry/meshing/solid_mesher.h"

#include "geometry/meshing/cap_limits.h"
#include "geometry/meshing/hole_seeds.h"

#include "slabhull/core/progress.h"

#include <fmt/format.h>
#include <tetgen.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <string>
#include <vector>

namespace slabhull {

namespace {

constexpr std::int32_t out_of_memory = 1; // TetGen's own number
constexpr std::int32_t endless = 1000;    // ours

// --- In the child
// ---------------------------------------------------------------------------------------------

/// Global, since TetGen's callback is a plain function.
const SizeField<3>* wanted_size = nullptr;

double squared_distance(const REAL* p, const REAL* q) {
    const double x = p[0] - q[0];
    const double y = p[1] - q[1];
    const double z = p[2] - q[2];
    return x * x + y * y + z * z;
}

double most_calls = 0;

/// Near a radius-edge bound of 1 refinement never ends: no sound mesh comes near this.
double most_calls_for(const SizeField<3>& size) {
    constexpr double generous = 30;
    constexpr double least = 1e6;
    return std::max(least, generous * cells_per_cube<3> * size.cube_count());
}

/// Counts the mesh's cells so far: TetGen asks about four tetrahedra for each three that it keeps.
void count_call() {
    static std::int64_t calls = 0;
    if (++calls % 4 == 0) {
        work_done(3);
    }
    if (static_cast<double>(calls) > most_calls) {
        throw int{endless}; // as TetGen's own errors are
    }
}

/// Whether to split a tetrahedron for its size. TetGen passes a volume of 0, so use the corners. (Its own
/// method, a size per boundary vertex, interpolates between opposite walls and knows neither growth nor a
/// largest size.)
bool too_large(REAL* a, REAL* b, REAL* c, REAL* d, REAL*, REAL) {
    count_call();
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

/// The surface as TetGen's input. It is never destroyed, since the child just ends: its lists need not come
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

/// TetGen's lists equal ours bit for bit: its cells are positively oriented, neighbour i is across from
/// corner i, and its -1 for no neighbour has the bits of no_index.
void send_mesh(const Send& send, const tetgenio& mesh) {
    static_assert(sizeof(int) == sizeof(Index) && sizeof(Point<3>) == 3 * sizeof(REAL));
    const MesherHeading heading{0, mesh.numberofpoints, mesh.numberoftetrahedra, mesh.numberoftetrahedra, {}};
    const std::size_t list = static_cast<std::size_t>(mesh.numberoftetrahedra) * sizeof(Simplex<3>);
    send(&heading, sizeof heading);
    send(mesh.pointlist, static_cast<std::size_t>(mesh.numberofpoints) * sizeof(Point<3>));
    send(mesh.tetrahedronlist, list);
    send(mesh.neighborlist, list);
}

/// p: a boundary is given; Y: keep it; n: return neighbours; Q: quiet; q: bounds on radius-edge ratio and
/// dihedral angle.
std::string switches(const CapOptions& options) {
    return fmt::format("pYnQq{:.4f}/{:.4f}", options.radius_edge, options.min_dihedral);
}

/// What the child is told, before the lists of points, facets and holes and those of the size field.
struct TetgenOrder {
    std::uint64_t points = 0;
    std::uint64_t facets = 0;
    std::uint64_t holes = 0;
    SizeField<3>::Packed size;
    std::array<char, 64> switches{};
};

/// Takes lists from the front of bytes.
class ListTaker {
public:
    explicit ListTaker(std::span<const std::byte> bytes) : bytes_{bytes} {}
    template<class List>
    List take(std::size_t count) {
        List list(count);
        const std::span<std::byte> copy = std::as_writable_bytes(std::span{list});
        std::ranges::copy(bytes_.first(copy.size()),
                          copy.begin()); // memcpy takes no null, not even for nothing
        bytes_ = bytes_.subspan(copy.size());
        return list;
    }
    std::span<const std::byte> rest() const { return bytes_; }

private:
    std::span<const std::byte> bytes_;
};

void mesh_and_send(std::span<const std::byte> request, const Send& send) {
    fall_silent(); // TetGen prints even when told to be quiet
    std::int32_t status = 0;
    try {
        TetgenOrder order;
        std::memcpy(&order, request.data(), sizeof order);
        ListTaker lists{request.subspan(sizeof order)};
        Surface<3> surface;
        surface.points = lists.take<Array<Point<3>>>(order.points);
        surface.facets = lists.take<Array<Facet<3>>>(order.facets);
        const auto holes = lists.take<std::vector<Point<3>>>(order.holes);
        const SizeField<3> size{order.size, lists.rest()};
        wanted_size = &size;
        most_calls = most_calls_for(size);
        auto* input = new TetgenInput{surface, holes};
        auto* mesh = new tetgenio; // neither is deleted: the child ends
        tetrahedralize(order.switches.data(), &input->plc, mesh);
        return send_mesh(send, *mesh);
    } catch (const int thrown) {
        status = thrown;
    } catch (const std::bad_alloc&) {
        status = out_of_memory;
    }
    const MesherHeading heading{status, 0, 0, 0, {}};
    send(&heading, sizeof heading);
}

// --- In the parent
// ----------------------------------------------------------------------------------------------

std::string thrown_in_words(const MesherHeading& heading, const CapOptions& options) {
    switch (heading.status) {
    case endless:
        return fmt::format(
            "makes more and more cells and comes to no end with a radius-edge bound of {:g}: give "
            "a larger one (cap.quality), such as the usual 1.414",
            options.radius_edge);
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
        return fmt::format("gave up with its internal error {}", heading.status);
    }
}

} // namespace

bool has_tetgen() {
    return true;
}

CapMesh<3> fill_with_tetgen(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                            const CapOptions& options) {
    const std::vector<Point<3>> holes = hole_seeds(boundary, surface);
    TetgenOrder order{surface.points.size(), surface.facets.size(), holes.size(), size.packed(), {}};
    const std::string chosen = switches(options);
    chosen.copy(order.switches.data(), order.switches.size() - 1);
    const auto bytes = [](const auto& list) { return std::as_bytes(std::span{list}); };
    const Request request{std::as_bytes(std::span{&order, 1}),
                          bytes(surface.points),
                          bytes(surface.facets),
                          bytes(holes),
                          size.source_bytes(),
                          size.box_bytes()};
    return fill_in_child(
        surface, [&](const auto& receive) { return run_in_fresh_child(mesh_and_send, request, receive); },
        [&](const MesherHeading& heading) { return thrown_in_words(heading, options); });
}

} // namespace slabhull
