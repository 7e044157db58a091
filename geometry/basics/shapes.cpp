// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/shapes.h"

#include "geometry/basics/vector_algebra.h"

#include "slabhull/core/error.h"
#include "slabhull/core/index.h"
#include "slabhull/core/memory.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

using namespace detail;

template<int D>
using Lattice = std::array<std::size_t, D>;

// --- Boxes ---------------------------------------------------------------------------------------

/// Numbers the boundary points of the lattice [0, n_1] x .. x [0, n_D], slice by slice along the last
/// direction: the first and last slice are complete, the others have their boundary points only.
template<int D>
class BoundaryNumbering {
public:
    explicit BoundaryNumbering(const Lattice<D>& divisions) : divisions_{divisions} {
        for (std::size_t d = 0; d < D; ++d) {
            const std::size_t ring = d == 0 ? 0 : rings_[d - 1];
            const std::size_t slice = d == 0 ? 1 : slices_[d - 1];
            rings_[d] = 2 * slice + (divisions[d] - 1) * ring;
            slices_[d] = slice * (divisions[d] + 1);
        }
    }
    std::size_t size() const { return rings_[D - 1]; }
    std::size_t operator()(const Lattice<D>& at) const { return on_boundary(at, D - 1); }

private:
    std::size_t on_boundary(const Lattice<D>& at, std::size_t d) const {
        if (d == 0) {
            return at[0] == 0 ? 0 : 1;
        }
        if (at[d] == 0) {
            return in_slice(at, d - 1);
        }
        const std::size_t before = slices_[d - 1] + (at[d] - 1) * rings_[d - 1];
        return before + (at[d] == divisions_[d] ? in_slice(at, d - 1) : on_boundary(at, d - 1));
    }
    std::size_t in_slice(const Lattice<D>& at, std::size_t d) const {
        return d == 0 ? at[0] : at[0] + (divisions_[0] + 1) * at[1];
    }

    Lattice<D> divisions_;
    Lattice<D> rings_{};  ///< number of boundary points of the lattice of the first d + 1 directions
    Lattice<D> slices_{}; ///< number of all its points
};

template<int D>
Lattice<D> box_divisions(const Point<D>& min, const Point<D>& max, double size) {
    require_finite(min, "the lower corner of a box");
    require_finite(max, "the upper corner of a box");
    require_positive(size, "the size of the edges of a box");
    Lattice<D> divisions;
    for (std::size_t i = 0; i < D; ++i) {
        if (!(min[i] < max[i])) {
            throw UsageError{fmt::format(
                "a box from {} to {} is empty: its upper corner must be larger in every coordinate",
                to_text(min), to_text(max))};
        }
        // A length that is a multiple of the size up to rounding gets no extra division.
        const double wanted = std::ceil((max[i] - min[i]) / size * (1 - 1e-12));
        if (!(wanted < no_index)) {
            throw LimitError{fmt::format("a box edge of length {} in parts of size {} has too many of them",
                                         max[i] - min[i], size)};
        }
        divisions[i] = static_cast<std::size_t>(std::max(1.0, wanted));
    }
    return divisions;
}

/// Calls visit(at) for all lattice points 0 <= at <= last of the face where at[axis] is `level`, first
/// direction fastest.
template<int D, class Visit>
void for_each_on_face(const Lattice<D>& last, std::size_t axis, std::size_t level, const Visit& visit) {
    std::size_t count = 1;
    for (std::size_t d = 0; d < D; ++d) {
        count *= d == axis ? 1 : last[d] + 1;
    }
    for (std::size_t k = 0; k < count; ++k) {
        Lattice<D> at;
        std::size_t rest = k;
        for (std::size_t d = 0; d < D; ++d) {
            at[d] = d == axis ? level : rest % (last[d] + 1);
            rest = d == axis ? rest : rest / (last[d] + 1);
        }
        visit(at);
    }
}

void append_outward(Array<Facet<2>>& facets, const BoundaryNumbering<2>& number, const Lattice<2>& at,
                    std::size_t axis, bool upper) {
    Lattice<2> next = at;
    ++next[1 - axis];
    Facet<2> edge{static_cast<Index>(number(at)), static_cast<Index>(number(next))};
    const bool outward = (axis == 1) == upper; // clockwise about the box
    if (!outward) {
        std::swap(edge[0], edge[1]);
    }
    facets.push_back(edge);
}

void append_outward(Array<Facet<3>>& facets, const BoundaryNumbering<3>& number, const Lattice<3>& at,
                    std::size_t axis, bool upper) {
    std::size_t u = (axis + 1) % 3;
    std::size_t v = (axis + 2) % 3;
    if (!upper) {
        std::swap(u, v); // so that u x v points outward
    }
    std::array<Index, 4> square; // counter-clockwise, seen from outside
    for (std::size_t corner = 0; corner < 4; ++corner) {
        Lattice<3> place = at;
        place[u] += corner == 1 || corner == 2 ? 1 : 0;
        place[v] += corner >= 2 ? 1 : 0;
        square[corner] = static_cast<Index>(number(place));
    }
    const std::size_t first = (at[u] + at[v]) % 2; // diagonals of alternating direction
    const auto corner = [&](std::size_t k) { return square[(first + k) % 4]; };
    facets.push_back({corner(0), corner(1), corner(2)});
    facets.push_back({corner(0), corner(2), corner(3)});
}

template<int D>
Array<Point<D>> box_points(const Point<D>& min, const Point<D>& max, const Lattice<D>& divisions,
                           const BoundaryNumbering<D>& number) {
    const auto coordinate = [&](std::size_t d, std::size_t k) {
        const double share = static_cast<double>(k) / static_cast<double>(divisions[d]);
        return k == divisions[d] ? max[d] : min[d] + (max[d] - min[d]) * share;
    };
    Array<Point<D>> points(number.size());
    for (std::size_t axis = 0; axis < D; ++axis) {
        for (const std::size_t level : {std::size_t{0}, divisions[axis]}) {
            for_each_on_face<D>(divisions, axis, level, [&](const Lattice<D>& at) {
                Point<D>& point = points[number(at)];
                for (std::size_t d = 0; d < D; ++d) {
                    point[d] = coordinate(d, at[d]);
                }
            });
        }
    }
    return points;
}

/// Number of facets, in double so that it cannot overflow.
template<int D>
double box_facet_count(const Lattice<D>& divisions) {
    double count = 0;
    for (std::size_t axis = 0; axis < D; ++axis) {
        double face = D == 3 ? 2 : 1;
        for (std::size_t d = 0; d < D; ++d) {
            face *= d == axis ? 1 : static_cast<double>(divisions[d]);
        }
        count += 2 * face;
    }
    return count;
}

// --- Bodies ---------------------------------------------------------------------------------------

template<int D>
void require_body(const Point<D>& centre, const Point<D>& semi_axes, int divisions, int fewest, int most) {
    require_finite(centre, "the centre of an ellipsoid or ellipse");
    for (const double axis : semi_axes) {
        require_positive(axis, "a semi-axis of an ellipsoid or ellipse");
    }
    if (divisions < fewest || divisions > most) {
        throw UsageError{fmt::format("the divisions of an ellipsoid or ellipse must be {} to {}, not {}",
                                     fewest, most, divisions)};
    }
}

template<int D>
void set_patch(Surface<D>& surface, const Patch& patch) {
    surface.patch.assign(surface.facets.size(), patch.number);
    surface.patches = {patch};
}

/// Arc lengths of an ellipse from parameter 0 to each multiple of 2 pi / samples, in units of its longer
/// semi-axis. By the midpoint rule, which converges faster than any power over a full period of a smooth
/// integrand, that is, for the whole ellipse.
std::vector<double> arc_lengths(const Point<2>& semi_axes, std::size_t samples) {
    const double longer = std::max(semi_axes[0], semi_axes[1]);
    const double step = 2 * std::numbers::pi / static_cast<double>(samples);
    std::vector<double> lengths(samples + 1);
    for (std::size_t k = 0; k < samples; ++k) {
        const double parameter = (static_cast<double>(k) + 0.5) * step;
        const double speed = std::hypot(semi_axes[0] / longer * std::sin(parameter),
                                        semi_axes[1] / longer * std::cos(parameter));
        lengths[k + 1] = lengths[k] + step * speed;
    }
    return lengths;
}

/// Parameters of n points of an ellipse at equal distances along it, from 0.
std::vector<double> equidistant_parameters(const Point<2>& semi_axes, std::size_t n) {
    std::vector<double> parameters(n);
    if (semi_axes[0] == semi_axes[1]) {
        for (std::size_t i = 0; i < n; ++i) {
            parameters[i] = 2 * std::numbers::pi * (static_cast<double>(i) / static_cast<double>(n));
        }
        return parameters;
    }
    const std::size_t samples = std::clamp<std::size_t>(8 * n, 4096, 1 << 20);
    const std::vector<double> lengths = arc_lengths(semi_axes, samples);
    const double step = 2 * std::numbers::pi / static_cast<double>(samples);
    std::size_t k = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double wanted = lengths.back() * (static_cast<double>(i) / static_cast<double>(n));
        while (lengths[k + 1] < wanted) {
            ++k;
        }
        const double share = (wanted - lengths[k]) / (lengths[k + 1] - lengths[k]);
        parameters[i] = (static_cast<double>(k) + share) * step;
    }
    return parameters;
}

/// The unit icosahedron, faces oriented outward.
struct Icosahedron {
    std::array<Point<3>, 12> corners;
    std::array<Facet<3>, 20> faces;
};

Icosahedron icosahedron() {
    const double g = std::numbers::phi;
    Icosahedron body{{{{-1, g, 0},
                       {1, g, 0},
                       {-1, -g, 0},
                       {1, -g, 0},
                       {0, -1, g},
                       {0, 1, g},
                       {0, -1, -g},
                       {0, 1, -g},
                       {g, 0, -1},
                       {g, 0, 1},
                       {-g, 0, -1},
                       {-g, 0, 1}}},
                     {{{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}}};
    for (Point<3>& corner : body.corners) {
        corner = times(1 / norm(corner), corner);
    }
    return body;
}

/// Vertices of the icosahedron whose faces are cut into n^2 triangles: corners first, then edges, then the
/// interiors of the faces, row by row. A point of a face has integer weights (i, j, k), i + j + k = n, for
/// the face's corners.
class Geodesic {
public:
    explicit Geodesic(int frequency) : n_{static_cast<std::size_t>(frequency)} {
        for (const Facet<3>& face : base_.faces) {
            for (std::size_t c = 0; c < 3; ++c) {
                const Index a = face[c];
                const Index b = face[(c + 1) % 3];
                edges_.try_emplace({std::min(a, b), std::max(a, b)}, edges_.size());
            }
        }
    }

    std::size_t vertex_count() const { return 10 * n_ * n_ + 2; }

    /// Calls visit(number, point) for every vertex; those on edges and corners are visited once per face.
    template<class Visit>
    void for_each_vertex(const Visit& visit) const {
        for (std::size_t f = 0; f < base_.faces.size(); ++f) {
            for (std::size_t k = 0; k <= n_; ++k) {
                for (std::size_t j = 0; j + k <= n_; ++j) {
                    visit(vertex(f, j, k), point(f, j, k));
                }
            }
        }
    }

    /// Calls visit(a, b, c) for every triangle, counter-clockwise from outside.
    template<class Visit>
    void for_each_triangle(const Visit& visit) const {
        for (std::size_t f = 0; f < base_.faces.size(); ++f) {
            for (std::size_t k = 0; k < n_; ++k) {
                for (std::size_t j = 0; j + k < n_; ++j) {
                    visit(vertex(f, j, k), vertex(f, j + 1, k), vertex(f, j, k + 1));
                    if (j + k + 1 < n_) {
                        visit(vertex(f, j + 1, k), vertex(f, j + 1, k + 1), vertex(f, j, k + 1));
                    }
                }
            }
        }
    }

private:
    /// Number of the vertex of face f with weights (n - j - k, j, k).
    Index vertex(std::size_t f, std::size_t j, std::size_t k) const {
        const Facet<3>& face = base_.faces[f];
        const std::size_t i = n_ - j - k;
        if (i == n_ || j == n_ || k == n_) {
            return i == n_ ? face[0] : j == n_ ? face[1] : face[2];
        }
        if (k == 0) {
            return on_edge(face[0], face[1], j);
        }
        if (i == 0) {
            return on_edge(face[1], face[2], k);
        }
        if (j == 0) {
            return on_edge(face[2], face[0], i);
        }
        const std::size_t inner = (n_ - 1) * (n_ - 2) / 2;
        const std::size_t rows_before = (k - 1) * (n_ - 1) - k * (k - 1) / 2;
        return static_cast<Index>(12 + 30 * (n_ - 1) + f * inner + rows_before + (j - 1));
    }

    /// The vertex `steps` steps from corner a to corner b.
    Index on_edge(Index a, Index b, std::size_t steps) const {
        const std::size_t from_lower = a < b ? steps : n_ - steps;
        const std::size_t edge = edges_.find({std::min(a, b), std::max(a, b)})->second;
        return static_cast<Index>(12 + edge * (n_ - 1) + (from_lower - 1));
    }

    /// Weights sin(share * edge angle) instead of the shares give equal arcs on edges and triangles of nearly
    /// equal size inside. (Plain shares make triangles twice as large in the middle of the faces.)
    Point<3> point(std::size_t f, std::size_t j, std::size_t k) const {
        static const double edge_angle = std::atan(2.0);
        const std::array<std::size_t, 3> weights{n_ - j - k, j, k};
        Point<3> sum{};
        for (std::size_t c = 0; c < 3; ++c) {
            const double share = static_cast<double>(weights[c]) / static_cast<double>(n_);
            sum = plus(sum, times(std::sin(share * edge_angle), base_.corners[base_.faces[f][c]]));
        }
        return times(1 / norm(sum), sum);
    }

    std::size_t n_;
    Icosahedron base_ = icosahedron();
    std::map<std::pair<Index, Index>, std::size_t> edges_;
};

/// Maps u on the unit sphere to the ellipsoid: A w / |w| with w = A^(-1/2) u.
Point<3> on_ellipsoid(const Point<3>& u, const Point<3>& semi_axes) {
    const double longest = *std::max_element(semi_axes.begin(), semi_axes.end());
    Point<3> w;
    for (std::size_t i = 0; i < 3; ++i) {
        w[i] = u[i] * std::sqrt(longest / semi_axes[i]);
    }
    const double length = norm(w);
    for (std::size_t i = 0; i < 3; ++i) {
        w[i] *= semi_axes[i] / length;
    }
    return w;
}

int checked_divisions(double wanted, int fewest, double size) {
    if (!(wanted < 1e9)) {
        throw LimitError{fmt::format("a body with edges of size {} has too many of them", size)};
    }
    return std::max(fewest, static_cast<int>(std::ceil(wanted * (1 - 1e-12))));
}

// --- Joining ----------------------------------------------------------------------------------------

void add_patch(PatchList& patches, const Patch& patch) {
    for (const Patch& known : patches) {
        if (known == patch) {
            return;
        }
        if (known.number == patch.number) {
            throw UsageError{fmt::format("patch number {} has two names, \"{}\" and \"{}\"", patch.number,
                                         known.name, patch.name)};
        }
        if (known.name == patch.name && !patch.name.empty()) {
            throw UsageError{fmt::format("the patch name \"{}\" stands for two numbers, {} and {}",
                                         patch.name, known.number, patch.number)};
        }
    }
    patches.push_back(patch);
}

template<int D>
void append(Surface<D>& whole, const Surface<D>& piece) {
    const std::size_t first = whole.points.size();
    checked_index(first + piece.points.size(), "points of the joined surface");
    checked_index(whole.facets.size() + piece.facets.size(), "facets of the joined surface");
    whole.points.insert(whole.points.end(), piece.points.begin(), piece.points.end());
    for (Facet<D> facet : piece.facets) {
        for (Index& vertex : facet) {
            vertex += static_cast<Index>(first);
        }
        whole.facets.push_back(facet);
    }
    whole.patch.insert(whole.patch.end(), piece.patch.begin(), piece.patch.end());
    for (const Patch& patch : piece.patches) {
        add_patch(whole.patches, patch);
    }
}

} // namespace

template<int D>
Surface<D> box_surface(const Point<D>& min, const Point<D>& max, double size, const Patch& patch) {
    const Lattice<D> divisions = box_divisions<D>(min, max, size);
    if (!(box_facet_count<D>(divisions) < no_index)) {
        throw LimitError{fmt::format(
            "a box from {} to {} with edges of size {} has more than 2^32 facets; give a larger size",
            to_text(min), to_text(max), size)};
    }
    constexpr double bytes_per_facet = 100; // the surface and its half-edges take more
    const double bytes = bytes_per_facet * static_cast<double>(box_facet_count<D>(divisions));
    const auto free = static_cast<double>(available_memory());
    if (!(bytes < free)) {
        throw LimitError{fmt::format(
            "a box from {} to {} with edges of size {} has some {:.2g} facets: they take "
            "{:.3g} GB at least, and {:.3g} GB are free; give a larger size",
            to_text(min), to_text(max), size, bytes / bytes_per_facet, 1e-9 * bytes, 1e-9 * free)};
    }
    const BoundaryNumbering<D> number{divisions};
    Surface<D> surface;
    surface.points = box_points<D>(min, max, divisions, number);
    surface.facets.reserve(static_cast<std::size_t>(box_facet_count<D>(divisions)));
    Lattice<D> last_cell = divisions;
    std::for_each(last_cell.begin(), last_cell.end(), [](std::size_t& n) { --n; });
    for (std::size_t axis = 0; axis < D; ++axis) {
        for (const bool upper : {false, true}) {
            for_each_on_face<D>(last_cell, axis, upper ? divisions[axis] : 0, [&](const Lattice<D>& at) {
                append_outward(surface.facets, number, at, axis, upper);
            });
        }
    }
    set_patch<D>(surface, patch);
    return surface;
}

template<>
Surface<2> ellipsoid_body<2>(const Point<2>& centre, const Point<2>& semi_axes, int divisions,
                             const Patch& patch) {
    require_body<2>(centre, semi_axes, divisions, 3, 100'000'000);
    const auto n = static_cast<std::size_t>(divisions);
    Surface<2> surface;
    surface.points.reserve(n);
    for (const double parameter : equidistant_parameters(semi_axes, n)) {
        surface.points.push_back(
            {centre[0] + semi_axes[0] * std::cos(parameter), centre[1] + semi_axes[1] * std::sin(parameter)});
    }
    surface.facets.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        surface.facets[i] = {static_cast<Index>(i),
                             static_cast<Index>((i + 1) % n)}; // the domain is on the right
    }
    set_patch<2>(surface, patch);
    return surface;
}

template<>
Surface<3> ellipsoid_body<3>(const Point<3>& centre, const Point<3>& semi_axes, int divisions,
                             const Patch& patch) {
    require_body<3>(centre, semi_axes, divisions, 1, 10'000);
    const Geodesic sphere{divisions};
    Surface<3> surface;
    surface.points.resize(sphere.vertex_count());
    sphere.for_each_vertex([&](Index vertex, const Point<3>& u) {
        surface.points[vertex] = plus(centre, on_ellipsoid(u, semi_axes));
    });
    surface.facets.reserve(2 * (sphere.vertex_count() - 2));
    sphere.for_each_triangle([&](Index a, Index b, Index c) {
        surface.facets.push_back({a, c, b}); // outward from the domain is into the body
    });
    set_patch<3>(surface, patch);
    return surface;
}

template<>
int ellipsoid_divisions<2>(const Point<2>& semi_axes, double size) {
    require_body<2>({}, semi_axes, 3, 3, 3);
    require_positive(size, "the size of the edges of an ellipse");
    return checked_divisions(
        std::max(semi_axes[0], semi_axes[1]) * arc_lengths(semi_axes, 4096).back() / size, 3, size);
}

template<>
int ellipsoid_divisions<3>(const Point<3>& semi_axes, double size) {
    require_body<3>({}, semi_axes, 1, 1, 1);
    require_positive(size, "the size of the edges of an ellipsoid");
    // Thomsen: area = 4 pi ((ab)^p + (ac)^p + (bc)^p / 3)^(1/p); then 20 n^2 equilateral triangles fill it.
    constexpr double p = 1.6075;
    const auto [a, b, c] = semi_axes;
    const double mean = (std::pow(a * b, p) + std::pow(a * c, p) + std::pow(b * c, p)) / 3;
    const double area = 4 * std::numbers::pi * std::pow(mean, 1 / p);
    return checked_divisions(std::sqrt(area / (5 * std::sqrt(3.0))) / size, 1, size);
}

template<int D>
Surface<D> join(std::span<const Surface<D>> pieces) {
    Surface<D> whole;
    for (const Surface<D>& piece : pieces) {
        append<D>(whole, piece);
    }
    std::sort(whole.patches.begin(), whole.patches.end(),
              [](const Patch& a, const Patch& b) { return a.number < b.number; });
    return whole;
}

template Surface<2> box_surface<2>(const Point<2>&, const Point<2>&, double, const Patch&);
template Surface<3> box_surface<3>(const Point<3>&, const Point<3>&, double, const Patch&);
template Surface<2> join<2>(std::span<const Surface<2>>);
template Surface<3> join<3>(std::span<const Surface<3>>);

} // namespace slabhull
