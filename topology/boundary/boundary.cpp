// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/boundary.h"

#include "core/used_vertices.h"
#include "topology/complex/soup_manifold.h"

#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"
#include "slabhull/topology/halfedge_mesh.h"
#include "slabhull/topology/simplicial_complex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace slabhull {

namespace {

void require_as_many(std::size_t given, std::size_t wanted, const char* what, const char* of_what) {
    if (given != wanted) {
        throw UsageError{fmt::format("{} {} were given for {} {}", given, what, wanted, of_what)};
    }
}

std::unique_ptr<const SimplicialComplex<1>> open_mesh(const Surface<2>& surface,
                                                      const std::function<Entity(Index)>& name) {
    auto adjacency = manifold_adjacency<1>(surface.facets, surface.points.size(), {true, name});
    return std::make_unique<const SimplicialComplex<1>>(
        SimplicialComplex<1>::adopt(surface.facets, std::move(adjacency.neighbors), surface.points.size()));
}

std::unique_ptr<const HalfedgeMesh> open_mesh(const Surface<3>& surface,
                                              const std::function<Entity(Index)>& name) {
    return std::make_unique<const HalfedgeMesh>(surface.facets, surface.points.size(), name);
}

std::array<Index, 2> across(const SimplicialComplex<1>& mesh, std::size_t facet) {
    return mesh.neighbor_array()[facet];
}

std::array<Index, 3> across(const HalfedgeMesh& mesh, std::size_t facet) {
    const auto facets = mesh.neighbors(FacetId{static_cast<Index>(facet)});
    return {facets[0].slot(), facets[1].slot(), facets[2].slot()};
}

/// The corner of facet `there` that facet `here` does not have.
template<int D>
std::uint8_t corner_not_in(const Facet<D>& here, const Facet<D>& there) {
    const auto other = std::find_if(there.begin(), there.end(), [&here](Index v) {
        return std::find(here.begin(), here.end(), v) == here.end();
    });
    return static_cast<std::uint8_t>(other - there.begin());
}

std::size_t ridges_of(const SimplicialComplex<1>& mesh) {
    return mesh.vertex_count();
}
std::size_t ridges_of(const HalfedgeMesh& mesh) {
    return mesh.edge_count();
}

} // namespace

template<int D>
Boundary<D>::Boundary(Surface<D> surface, Array<TrackId> tracks, Array<double> spacing) {
    if (tracks.empty()) {
        tracks.assign(surface.points.size(), no_track);
    }
    require_as_many(tracks.size(), surface.points.size(), "tracks", "vertices");
    if (!spacing.empty()) {
        require_as_many(spacing.size(), surface.points.size(), "spacings", "vertices");
    }
    if (surface.patch.empty()) {
        surface.patch.assign(surface.facets.size(), PatchNumber{0});
    }
    require_as_many(surface.patch.size(), surface.facets.size(), "patches", "facets");
    auto made = std::make_shared<Data>();
    made->surface = std::move(surface);
    made->tracks = std::move(tracks);
    made->spacing = std::move(spacing);
    connect(*made);
    data_ = std::move(made);
}

template<int D>
void Boundary<D>::connect(Data& data) {
    const Surface<D>& surface = data.surface;
    data.mesh = open_mesh(surface, [&surface](Index facet) {
        return Entity{"facet", facet, patch_name(surface.patches, surface.patch[facet])};
    });
    data.ridges = ridges_of(*data.mesh);
    data.neighbors.resize(surface.facets.size());
    data.twin_corner.resize(surface.facets.size());
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        data.neighbors[f] = across(*data.mesh, f);
        for (std::size_t i = 0; i < D; ++i) {
            data.twin_corner[f][i] =
                corner_not_in<D>(surface.facets[f], surface.facets[data.neighbors[f][i]]);
        }
    }
    data.components = FacetComponents<D>{data.neighbors};
}

template<int D>
Surface<D> Boundary<D>::at(Array<Point<D>> places) const {
    return {std::move(places), data().surface.facets, data().surface.patch, data().surface.patches};
}

template<int D>
std::vector<double> Boundary<D>::shortest_edges(std::span<const Point<D>> places) const {
    std::vector<double> shortest(places.size(), std::numeric_limits<double>::infinity());
    for (const Facet<D>& facet : facets()) {
        for (std::size_t i = 0; i < D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const double length = distance(places[facet[i]], places[facet[j]]);
                shortest[facet[i]] = std::min(shortest[facet[i]], length);
                shortest[facet[j]] = std::min(shortest[facet[j]], length);
            }
        }
    }
    return shortest;
}

template<int D>
std::vector<double> Boundary<D>::mean_edges(std::span<const Point<D>> places) const {
    std::vector<double> sum(places.size(), 0.0); // edges inside a surface count twice, once from either side
    std::vector<Index> count(places.size(), 0);
    for (const Facet<D>& facet : facets()) {
        for (std::size_t i = 0; i < D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const double length = distance(places[facet[i]], places[facet[j]]);
                for (const Index v : {facet[i], facet[j]}) {
                    sum[v] += length;
                    ++count[v];
                }
            }
        }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
        sum[v] /= std::max(count[v], Index{1});
    }
    return sum;
}

template<int D>
std::vector<Index> Boundary<D>::vertices_of(const std::vector<PatchNumber>& patches) const {
    std::vector<bool> wanted(vertex_count(), false);
    for (std::size_t f = 0; f < facet_count(); ++f) {
        if (std::find(patches.begin(), patches.end(), patch()[f]) != patches.end()) {
            for (const Index v : facets()[f]) {
                wanted[v] = true;
            }
        }
    }
    std::vector<Index> vertices;
    for (std::size_t v = 0; v < wanted.size(); ++v) {
        if (wanted[v]) {
            vertices.push_back(static_cast<Index>(v));
        }
    }
    return vertices;
}

template<int D>
std::vector<std::vector<Index>> Boundary<D>::patch_loops(PatchNumber number) const requires(D == 3) {
    const auto on_rim = [&](HalfedgeId h) {
        return patch()[mesh().facet(h).slot()] == number &&
               patch()[mesh().facet(mesh().opposite(h)).slot()] != number;
    };
    std::vector<char> met(2 * mesh().edge_count(), 0);
    std::vector<std::vector<Index>> loops;
    for (const HalfedgeId start : mesh().halfedges()) {
        if (met[start.slot()] != 0 || !on_rim(start)) {
            continue;
        }
        std::vector<Index>& loop = loops.emplace_back();
        for (HalfedgeId h = start; met[h.slot()] == 0;) {
            met[h.slot()] = 1;
            loop.push_back(mesh().from(h).slot());
            h = mesh().next(h);
            while (!on_rim(h)) { // turn about the vertex, through facets of the patch
                h = mesh().next(mesh().opposite(h));
            }
        }
    }
    return loops;
}

template<int D>
Boundary<D> Boundary<D>::bounding(std::span<const PersistentId> ids, Array<Index> mesh_vertices) const {
    Boundary moved;
    moved.data_ = data_;
    moved.mesh_vertices_ = std::move(mesh_vertices);
    if (moved.mesh_vertices_.empty()) {
        moved.mesh_vertices_.resize(vertex_count());
        std::iota(moved.mesh_vertices_.begin(), moved.mesh_vertices_.end(), Index{0});
    }
    require_as_many(moved.mesh_vertices_.size(), vertex_count(), "vertices of a mesh",
                    "vertices of its boundary");
    for (const Index v : moved.mesh_vertices_) {
        if (!ids.empty() && v >= ids.size()) {
            throw UsageError{fmt::format("the boundary refers to vertex {} of a mesh of {}", v, ids.size())};
        }
        moved.ids_.push_back(ids.empty() ? PersistentId{-1} : ids[v]);
    }
    return moved;
}

template<int D>
Surface<D> boundary_surface(const SpatialMesh<D>& mesh, Array<Index>& mesh_vertices) {
    Surface<D> surface;
    surface.patch = mesh.boundary_patch;
    surface.patches = mesh.patches;
    surface.facets = mesh.boundary_facets;
    UsedVertices used{mesh.points.size(), surface.facets};
    used.renumber(surface.facets);
    for (const Index v : used.vertices) {
        surface.points.push_back(mesh.points[v]);
    }
    mesh_vertices = std::move(used.vertices);
    return surface;
}

template<int D>
Boundary<D> boundary_of(const SpatialMesh<D>& mesh) {
    Array<Index> vertices;
    Surface<D> surface = boundary_surface(mesh, vertices);
    Array<TrackId> tracks;
    for (const Index v : vertices) {
        tracks.push_back(mesh.track_ids.empty() ? no_track : mesh.track_ids[v]);
    }
    return Boundary<D>{std::move(surface), std::move(tracks)}.bounding(mesh.vertex_ids, std::move(vertices));
}

template class Boundary<2>;
template class Boundary<3>;
template Surface<2> boundary_surface<2>(const SpatialMesh<2>&, Array<Index>&);
template Surface<3> boundary_surface<3>(const SpatialMesh<3>&, Array<Index>&);
template Boundary<2> boundary_of<2>(const SpatialMesh<2>&);
template Boundary<3> boundary_of<3>(const SpatialMesh<3>&);

} // namespace slabhull
