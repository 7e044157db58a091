// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/stitch.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

namespace {

/// The lateral faces of a layer: for each facet and corner, the number of the edge opposite to that corner.
/// Only D = 3 has centres on them.
struct LateralEdges {
    std::vector<std::array<Index, 3>> of_facet;
    std::vector<std::array<Index, 2>> vertices; ///< ascending
};

LateralEdges lateral_edges(const Surface<3>& surface) {
    struct Corner {
        std::array<Index, 2> edge;
        Index facet;
        Index corner;
    };
    std::vector<Corner> corners;
    corners.reserve(3 * surface.facets.size());
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        const auto& facet = surface.facets[f];
        for (Index i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax(facet[(i + 1) % 3], facet[(i + 2) % 3]);
            corners.push_back({{low, high}, static_cast<Index>(f), i});
        }
    }
    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        return std::tie(a.edge, a.facet) < std::tie(b.edge, b.facet);
    });
    LateralEdges edges;
    edges.of_facet.resize(surface.facets.size());
    for (const Corner& corner : corners) {
        if (edges.vertices.empty() || edges.vertices.back() != corner.edge) {
            edges.vertices.push_back(corner.edge);
        }
        edges.of_facet[corner.facet][corner.corner] = static_cast<Index>(edges.vertices.size() - 1);
    }
    return edges;
}

/// Where the vertices of the hull's parts begin.
template<int D>
class Layout {
public:
    Layout(const SpatialMesh<D>& initial, const Sweep<D>& sweep, Split split, std::size_t lateral_faces)
        : sweep_{sweep}, boundary_{sweep.surface.points.size()}, points_{points_of(split)},
          face_centres_{points_.face_centres ? lateral_faces : 0},
          prism_centres_{points_.prism_centres ? sweep.surface.facets.size() : 0}, side_{initial.points.size()} {}

    std::size_t side_begin() const { return side_; }
    std::size_t terminating_begin() const {
        return side_ + sweep_.layers() * (face_centres_ + prism_centres_) + (sweep_.layers() - 1) * boundary_;
    }
    /// Hull vertex of a swept vertex on a level.
    std::size_t vertex(std::size_t level, Index v) const {
        if (level == 0) {
            return sweep_.cap_vertex[v];
        }
        return level == sweep_.layers() ? terminating_begin() + v : layer_begin(level) - boundary_ + v;
    }
    std::size_t face_centre(std::size_t layer, Index edge) const { return layer_begin(layer) + edge; }
    std::size_t prism_centre(std::size_t layer, std::size_t facet) const {
        return layer_begin(layer) + face_centres_ + facet;
    }
    std::size_t face_centres() const { return face_centres_; }
    std::size_t prism_centres() const { return prism_centres_; }

private:
    /// First centre of a layer; the vertices of the level below it come just before.
    std::size_t layer_begin(std::size_t layer) const {
        return side_ + layer * (face_centres_ + prism_centres_ + boundary_);
    }

    const Sweep<D>& sweep_;
    std::size_t boundary_;
    SplitPoints points_;
    std::size_t face_centres_;
    std::size_t prism_centres_;
    std::size_t side_;
};

template<int D>
class Stitcher {
public:
    Stitcher(const SpatialMesh<D>& initial, const Sweep<D>& sweep, const SpatialMesh<D>& terminating, Split split,
             IdCounter& ids)
        : initial_{initial}, sweep_{sweep}, terminating_{terminating}, split_{split}, ids_{ids},
          edges_{edges_of(sweep.surface)}, layout_{initial, sweep, split, edges_.vertices.size()} {}

    Hull<D> run() {
        describe();
        place_vertices();
        place_cells();
        connect();
        return std::move(hull_);
    }

private:
    static LateralEdges edges_of(const Surface<D>& surface) {
        if constexpr (D == 3) {
            return lateral_edges(surface);
        } else {
            return {};
        }
    }

    void describe() {
        hull_.initial_cells = initial_.cells.size();
        hull_.layers = sweep_.layers();
        hull_.cells_per_prism = static_cast<std::size_t>(simplices_per_prism(split_));
        hull_.side_cells = hull_.layers * sweep_.surface.facets.size() * hull_.cells_per_prism;
        hull_.facet_patch = sweep_.surface.patch;
        hull_.patches = sweep_.surface.patches;
        hull_.time = {sweep_.times.front(), sweep_.times.back()};
    }

    static Point<D + 1> at_time(const Point<D>& x, double t) {
        Point<D + 1> point;
        std::copy(x.begin(), x.end(), point.begin());
        point[D] = t;
        return point;
    }

    void place_vertices() {
        const std::size_t count = layout_.terminating_begin() + terminating_.points.size();
        checked_index(count, "hull vertices");
        hull_.points.resize(count);
        hull_.vertex_ids.resize(count);
        hull_.track_ids.assign(count, no_track);
        place_cap(initial_, 0, sweep_.times.front());
        place_side();
        place_cap(terminating_, layout_.terminating_begin(), sweep_.times.back());
    }

    void place_cap(const SpatialMesh<D>& cap, std::size_t begin, double t) {
        for (std::size_t v = 0; v < cap.points.size(); ++v) {
            hull_.points[begin + v] = at_time(cap.points[v], t);
        }
        std::copy(cap.vertex_ids.begin(), cap.vertex_ids.end(), hull_.vertex_ids.begin() + offset(begin));
        std::copy(cap.track_ids.begin(), cap.track_ids.end(), hull_.track_ids.begin() + offset(begin));
    }

    static std::ptrdiff_t offset(std::size_t begin) { return static_cast<std::ptrdiff_t>(begin); }

    void place_side() {
        const std::size_t begin = layout_.side_begin();
        const std::size_t end = layout_.terminating_begin();
        PersistentId id = ids_.take(end - begin);
        for (std::size_t v = begin; v < end; ++v) {
            hull_.vertex_ids[v] = id++;
        }
        for (std::size_t level = 1; level < sweep_.layers(); ++level) {
            place_level(level);
        }
        for (std::size_t layer = 0; layer < sweep_.layers(); ++layer) {
            place_centres(layer);
        }
    }

    void place_level(std::size_t level) {
        for (Index v = 0; v < sweep_.surface.points.size(); ++v) {
            const std::size_t vertex = layout_.vertex(level, v);
            hull_.points[vertex] = at_time(sweep_.positions[level][v], sweep_.times[level]);
            hull_.track_ids[vertex] = initial_.track_ids[sweep_.cap_vertex[v]];
        }
    }

    void place_centres(std::size_t layer) {
        if (layout_.face_centres() > 0) {
            for (Index e = 0; e < edges_.vertices.size(); ++e) {
                hull_.points[layout_.face_centre(layer, e)] = mean_of_column(layer, edges_.vertices[e]);
            }
        }
        if (layout_.prism_centres() > 0) {
            for (std::size_t f = 0; f < sweep_.surface.facets.size(); ++f) {
                hull_.points[layout_.prism_centre(layer, f)] = mean_of_column(layer, sweep_.surface.facets[f]);
            }
        }
    }

    /// Mean of the points that `vertices` have below and above a layer.
    template<std::size_t N>
    Point<D + 1> mean_of_column(std::size_t layer, const std::array<Index, N>& vertices) const {
        Point<D> sum{};
        for (const std::size_t level : {layer, layer + 1}) {
            for (const Index v : vertices) {
                for (std::size_t k = 0; k < D; ++k) {
                    sum[k] += sweep_.positions[level][v][k];
                }
            }
        }
        for (double& coordinate : sum) {
            coordinate /= 2.0 * static_cast<double>(N);
        }
        return at_time(sum, 0.5 * (sweep_.times[layer] + sweep_.times[layer + 1]));
    }

    void place_cells() {
        hull_.cells.resize(hull_.terminating_begin() + terminating_.cells.size());
        for (std::size_t c = 0; c < initial_.cells.size(); ++c) {
            hull_.cells[c] = initial_.cells[c];
            std::swap(hull_.cells[c][0], hull_.cells[c][1]); // the initial cap looks back in time
        }
        const std::size_t prisms = sweep_.layers() * sweep_.surface.facets.size();
        parallel_for(prisms, 4096, [this](std::size_t begin, std::size_t end) {
            for (std::size_t prism = begin; prism < end; ++prism) {
                place_prism(prism);
            }
        });
        const auto shift = static_cast<Index>(layout_.terminating_begin());
        for (std::size_t c = 0; c < terminating_.cells.size(); ++c) {
            Simplex<D> cell = terminating_.cells[c];
            for (Index& v : cell) {
                v += shift;
            }
            hull_.cells[hull_.terminating_begin() + c] = cell;
        }
    }

    void place_prism(std::size_t prism) {
        const std::size_t layer = prism / sweep_.surface.facets.size();
        const std::size_t facet = prism % sweep_.surface.facets.size();
        const auto points = prism_points(layer, facet);
        std::array<PersistentId, D> ids;
        for (std::size_t i = 0; i < D; ++i) {
            // Tracks order the columns of vertices the same way on every level and in every slab.
            ids[i] = initial_.track_ids[sweep_.cap_vertex[sweep_.surface.facets[facet][i]]];
        }
        std::size_t cell = hull_.initial_cells + prism * hull_.cells_per_prism;
        for (const auto& local : template_of<D>(split_, ids).cells) {
            for (std::size_t i = 0; i <= D; ++i) {
                hull_.cells[cell][i] = points[local[i]];
            }
            ++cell;
        }
    }

    std::array<Index, PrismPoint<D>::count> prism_points(std::size_t layer, std::size_t facet) const {
        std::array<Index, PrismPoint<D>::count> points{};
        const auto put = [&points](int local, std::size_t vertex) {
            points[static_cast<std::size_t>(local)] = static_cast<Index>(vertex);
        };
        for (int i = 0; i < D; ++i) {
            const Index v = sweep_.surface.facets[facet][static_cast<std::size_t>(i)];
            put(PrismPoint<D>::bottom(i), layout_.vertex(layer, v));
            put(PrismPoint<D>::top(i), layout_.vertex(layer + 1, v));
            if (layout_.face_centres() > 0) {
                const Index edge = edges_.of_facet[facet][static_cast<std::size_t>(i)];
                put(PrismPoint<D>::face_centre(i), layout_.face_centre(layer, edge));
            }
        }
        put(PrismPoint<D>::centre, layout_.prism_centre(layer, facet));
        return points;
    }

    void connect() {
        Adjacency<D> adjacency = build_adjacency<D>(hull_.cells, hull_.points.size());
        if (!adjacency.defects.empty()) {
            throw GeometryError(fmt::format("the caps and the side of the slab from t = {} to {} do not close: {} facets "
                                            "are not in exactly two simplices",
                                            hull_.time[0], hull_.time[1], adjacency.defects.size()));
        }
        hull_.neighbors = std::move(adjacency.neighbors);
    }

    const SpatialMesh<D>& initial_;
    const Sweep<D>& sweep_;
    const SpatialMesh<D>& terminating_;
    Split split_;
    IdCounter& ids_;
    LateralEdges edges_;
    Layout<D> layout_;
    Hull<D> hull_;
};

} // namespace

template<int D>
SpatialMesh<D> terminating_cap(const SpatialMesh<D>& initial, const Sweep<D>& sweep, CapMesh<D>&& mesh,
                               IdCounter& ids) {
    SpatialMesh<D> cap;
    cap.boundary_facets = sweep.surface.facets;
    cap.boundary_patch = sweep.surface.patch;
    cap.patches = sweep.surface.patches;
    cap.vertex_ids.resize(mesh.points.size());
    PersistentId id = ids.take(mesh.points.size());
    for (PersistentId& given : cap.vertex_ids) {
        given = id++;
    }
    cap.track_ids.assign(mesh.points.size(), no_track);
    for (std::size_t v = 0; v < sweep.cap_vertex.size(); ++v) {
        cap.track_ids[v] = initial.track_ids[sweep.cap_vertex[v]];
    }
    cap.points = std::move(mesh.points);
    cap.cells = std::move(mesh.cells);
    cap.neighbors = std::move(mesh.neighbors);
    return cap;
}

template<int D>
Hull<D> stitch(const SpatialMesh<D>& initial, const Sweep<D>& sweep, const SpatialMesh<D>& terminating, Split split,
               IdCounter& ids) {
    return Stitcher<D>{initial, sweep, terminating, split, ids}.run();
}

template SpatialMesh<2> terminating_cap<2>(const SpatialMesh<2>&, const Sweep<2>&, CapMesh<2>&&, IdCounter&);
template SpatialMesh<3> terminating_cap<3>(const SpatialMesh<3>&, const Sweep<3>&, CapMesh<3>&&, IdCounter&);
template Hull<2> stitch<2>(const SpatialMesh<2>&, const Sweep<2>&, const SpatialMesh<2>&, Split, IdCounter&);
template Hull<3> stitch<3>(const SpatialMesh<3>&, const Sweep<3>&, const SpatialMesh<3>&, Split, IdCounter&);

} // namespace slabhull
