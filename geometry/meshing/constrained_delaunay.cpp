// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/constrained_delaunay.h"

#include "core/place_in_words.h"
#include "geometry/meshing/z_order.h"

#include "slabhull/core/error.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace slabhull {

namespace {

/// The side of the boundary that a triangle is on, and the edge from which that was found.
struct Mark {
    enum class Side { unknown, inside, outside } side = Side::unknown;
    Index edge = no_index;
    Index cell = no_index; ///< number in the result
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<Mark, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Storage = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Storage,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

constexpr double huge_size = 1e45;

Entity vertex_entity(Index number) {
    return {"vertex", number, ""};
}

/// A fixed pseudo-random number for each number (the finaliser of splitmix64).
std::uint64_t scramble(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

class Triangulator {
public:
    explicit Triangulator(const Surface<2>& surface) : surface_{surface} {}

    CapMesh<2> run() {
        check_numbers();
        check_curves();
        check_sizes();
        insert_points();
        insert_edges();
        mark_sides();
        return collect();
    }

private:
    Entity edge_entity(Index number) const {
        const PatchNumber patch = number < surface_.patch.size() ? surface_.patch[number] : 0;
        return {"edge", number, patch == 0 ? "" : patch_name(surface_.patches, patch)};
    }

    [[noreturn]] void refuse_edges(const std::string& what, Index first, Index second,
                                   const char* advice) const {
        const Point<2>& near = surface_.points[surface_.facets[first][0]];
        throw GeometryError{fmt::format("boundary edges {} and {} {} near {}; {}", first, second, what,
                                        place_in_words(near), advice),
                            {edge_entity(first), edge_entity(second)}};
    }

    void check_numbers() const {
        if (surface_.facets.empty()) {
            throw GeometryError{"the boundary has no edges; a domain needs at least one closed curve"};
        }
        for (std::size_t v = 0; v < surface_.points.size(); ++v) {
            const Point<2>& p = surface_.points[v];
            if (!std::isfinite(p[0]) || !std::isfinite(p[1])) {
                throw GeometryError{
                    fmt::format("boundary vertex {} has a coordinate that is not a number", v),
                    {vertex_entity(static_cast<Index>(v))}};
            }
        }
        for (std::size_t f = 0; f < surface_.facets.size(); ++f) {
            for (const Index v : surface_.facets[f]) {
                if (v >= surface_.points.size()) {
                    throw GeometryError{
                        fmt::format("boundary edge {} names vertex {}, of {}", f, v, surface_.points.size()),
                        {edge_entity(static_cast<Index>(f))}};
                }
            }
        }
    }

    /// Every vertex must be the end of one edge and the start of one.
    void check_curves() const {
        std::vector<std::array<Index, 2>> uses(surface_.points.size(), {0, 0});
        for (const Facet<2>& edge : surface_.facets) {
            ++uses[edge[0]][0];
            ++uses[edge[1]][1];
        }
        for (std::size_t v = 0; v < uses.size(); ++v) {
            if (uses[v][0] != 1 || uses[v][1] != 1) {
                throw GeometryError{
                    fmt::format("boundary vertex {} at {} starts {} edges and ends {}; in closed "
                                "curves of consistent direction both are one",
                                v, place_in_words(surface_.points[v]), uses[v][0], uses[v][1]),
                    {vertex_entity(static_cast<Index>(v))}};
            }
        }
    }

    /// The refinement multiplies six lengths; these products must stay within the range of double.
    void check_sizes() const {
        for (std::size_t f = 0; f < surface_.facets.size(); ++f) {
            const Point<2>& a = surface_.points[surface_.facets[f][0]];
            const Point<2>& b = surface_.points[surface_.facets[f][1]];
            const double length = std::hypot(a[0] - b[0], a[1] - b[1]);
            const bool coincident = a == b; // reported later, with its vertices
            if (!coincident && !(length > 1 / huge_size && std::hypot(a[0], a[1]) < huge_size)) {
                throw GeometryError{
                    fmt::format("boundary edge {} at {} is {:.3g} long; lengths and coordinates must be "
                                "between {:g} and {:g}",
                                f, place_in_words(a), length, 1 / huge_size, huge_size),
                    {edge_entity(static_cast<Index>(f))}};
            }
        }
    }

    /// In rounds of doubling size, each along a Z curve: near-linear for any order of the curves ("BRIO",
    /// Amenta, Choi and Rote 2003). CGAL's own spatial sort uses a random generator whose state persists
    /// between calls.
    void insert_points() {
        struct Turn {
            int round;
            std::uint64_t place;
            Index vertex;
            auto operator<=>(const Turn&) const = default;
        };
        const ZOrder<2> curve{surface_.points};
        std::vector<Turn> turns;
        turns.reserve(surface_.points.size());
        for (std::size_t v = 0; v < surface_.points.size(); ++v) {
            turns.push_back(
                {-std::countl_zero(scramble(v)), curve(surface_.points[v]), checked_index(v, "points")});
        }
        std::sort(turns.begin(), turns.end());
        vertices_.resize(surface_.points.size());
        Cdt::Face_handle near;
        for (const Turn& turn : turns) {
            const Point<2>& p = surface_.points[turn.vertex];
            const Cdt::Vertex_handle v = cdt_.insert(Kernel::Point_2{p[0], p[1]}, near);
            v->info() = turn.vertex;
            vertices_[turn.vertex] = v;
            near = v->face();
        }
        if (cdt_.number_of_vertices() != surface_.points.size()) {
            refuse_coincident();
        }
        if (cdt_.dimension() < 2) {
            throw GeometryError{
                "all boundary vertices lie on one line; a domain needs a curve with an inside"};
        }
    }

    [[noreturn]] void refuse_coincident() const {
        std::vector<Index> order(surface_.points.size());
        std::iota(order.begin(), order.end(), Index{0});
        const auto& points = surface_.points;
        std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return points[a] < points[b]; });
        const auto twin = std::adjacent_find(order.begin(), order.end(),
                                             [&](Index a, Index b) { return points[a] == points[b]; });
        throw GeometryError{
            fmt::format("boundary vertices {} and {} coincide at {}; weld them or move them apart", twin[0],
                        twin[1], place_in_words(points[twin[0]])),
            {vertex_entity(twin[0]), vertex_entity(twin[1])}};
    }

    void insert_edges() {
        for (std::size_t f = 0; f < surface_.facets.size(); ++f) {
            const Facet<2>& edge = surface_.facets[f];
            try {
                cdt_.insert_constraint(vertices_[edge[0]], vertices_[edge[1]]);
            } catch (const Cdt::Intersection_of_constraints_exception&) {
                refuse_crossing(static_cast<Index>(f));
            }
            if (!cdt_.is_edge(vertices_[edge[0]], vertices_[edge[1]])) {
                refuse_vertex_on(static_cast<Index>(f));
            }
        }
    }

    Kernel::Segment_2 segment(std::size_t facet) const {
        const Facet<2>& edge = surface_.facets[facet];
        return {vertices_[edge[0]]->point(), vertices_[edge[1]]->point()};
    }

    /// Reports that edge `last` crosses an earlier one.
    [[noreturn]] void refuse_crossing(Index last) const {
        Index other = 0;
        const Facet<2>& b = surface_.facets[last];
        const auto crosses = [&](Index f) {
            const Facet<2>& a = surface_.facets[f];
            const bool joined = a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
            return !joined && CGAL::do_intersect(segment(f), segment(last));
        };
        while (other + 1 < last && !crosses(other)) {
            ++other;
        }
        refuse_edges("cross", other, last, "the boundary must not meet itself");
    }

    [[noreturn]] void refuse_vertex_on(Index facet) const {
        Index touching = 0;
        const auto touches = [&](Index v) {
            return v != surface_.facets[facet][0] && v != surface_.facets[facet][1] &&
                   segment(facet).has_on(vertices_[v]->point());
        };
        while (touching + 1 < surface_.points.size() && !touches(touching)) {
            ++touching;
        }
        throw GeometryError{
            fmt::format("boundary vertex {} at {} lies on boundary edge {}; the boundary must not "
                        "touch itself",
                        touching, place_in_words(surface_.points[touching]), facet),
            {vertex_entity(touching), edge_entity(facet)}};
    }

    /// Each edge has the domain on its right. The sides of its two triangles spread up to the next edges.
    void mark_sides() {
        for (std::size_t f = 0; f < surface_.facets.size(); ++f) {
            const Cdt::Edge left = left_of(surface_.facets[f]);
            spread(left.first->neighbor(left.second), {Mark::Side::inside, static_cast<Index>(f)});
            spread(left.first, {Mark::Side::outside, static_cast<Index>(f)});
        }
    }

    /// The triangle to the left of an edge, and the edge's local number in it.
    Cdt::Edge left_of(const Facet<2>& edge) const {
        Cdt::Face_handle face;
        int side = 0;
        cdt_.is_edge(vertices_[edge[0]], vertices_[edge[1]], face, side);
        if (face->vertex(Cdt::ccw(side)) == vertices_[edge[0]]) {
            return {face, side};
        }
        return cdt_.mirror_edge({face, side});
    }

    void spread(Cdt::Face_handle start, const Mark& mark) {
        check_mark(start, mark);
        if (start->info().side != Mark::Side::unknown) {
            return;
        }
        std::vector<Cdt::Face_handle> front{start};
        start->info() = mark;
        while (!front.empty()) {
            const Cdt::Face_handle face = front.back();
            front.pop_back();
            for (int i = 0; i < 3; ++i) {
                const Cdt::Face_handle next = face->neighbor(i);
                if (!face->is_constrained(i) && next->info().side == Mark::Side::unknown) {
                    next->info() = mark;
                    front.push_back(next);
                }
            }
        }
    }

    void check_mark(Cdt::Face_handle face, const Mark& mark) const {
        const Mark& present = face->info();
        if (present.side != Mark::Side::unknown && present.side != mark.side) {
            refuse_edges("put the domain on opposite sides", present.edge, mark.edge,
                         "the domain must lie to the right of each edge, and no curve outside the outer one");
        }
    }

    CapMesh<2> collect() {
        CapMesh<2> mesh;
        mesh.points = surface_.points;
        std::vector<Cdt::Face_handle> inside;
        for (const auto face : cdt_.all_face_handles()) {
            if (face->info().side == Mark::Side::inside) {
                refuse_infinite(face);
                face->info().cell = checked_index(inside.size(), "triangles");
                inside.push_back(face);
            }
        }
        for (const Cdt::Face_handle face : inside) {
            Simplex<2> cell;
            Neighbors<2> neighbors;
            for (int i = 0; i < 3; ++i) {
                const auto k = static_cast<std::size_t>(i);
                cell[k] = face->vertex(i)->info();
                neighbors[k] = face->is_constrained(i) ? no_index : face->neighbor(i)->info().cell;
            }
            mesh.cells.push_back(cell);
            mesh.neighbors.push_back(neighbors);
        }
        return mesh;
    }

    void refuse_infinite(Cdt::Face_handle face) const {
        if (cdt_.is_infinite(face)) {
            const Index edge = face->info().edge;
            throw GeometryError{
                fmt::format("boundary edge {} near {} puts the domain outside all curves; the domain "
                            "must lie to the right of each edge",
                            edge, place_in_words(surface_.points[surface_.facets[edge][0]])),
                {edge_entity(edge)}};
        }
    }

    const Surface<2>& surface_;
    Cdt cdt_;
    std::vector<Cdt::Vertex_handle> vertices_;
};

} // namespace

CapMesh<2> constrained_delaunay(const Surface<2>& surface) {
    try {
        return Triangulator{surface}.run();
    } catch (const CGAL::Failure_exception& failure) {
        throw GeometryError{fmt::format("the boundary cannot be triangulated: {}", failure.what())};
    }
}

} // namespace slabhull
