// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/stitch.h"

#include "slab/stitch/cap_boundary.h"
#include "slab/stitch/prism_choice.h"
#include "slab/stitch/prism_graph.h"
#include "slab/stitch/side_vertices.h"
#include "slabhull/core/error.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/cap_mesher.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

namespace {

constexpr std::size_t items_per_step = 1 << 15;
constexpr std::size_t prisms_per_piece = 1 << 12;

template<class Body>
void for_each_index(std::size_t count, std::size_t grain, const Body& body) {
    parallel_for(count, grain, [&body](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            body(i);
        }
    });
}

template<int D>
Point<D + 1> at_time(const Point<D>& x, double t) {
    Point<D + 1> point;
    std::copy(x.begin(), x.end(), point.begin());
    point[D] = t;
    return point;
}

template<int D>
class Stitcher {
public:
    Stitcher(CapToStitch<D>& initial, const Sweep<D>& sweep, CapToStitch<D>& terminating,
             const SideOptions& options, IdCounter& ids)
        : initial_{initial}, sweep_{sweep}, terminating_{terminating}, options_{options}, ids_{ids},
          recipe_{recipe_of(options.split)}, templates_{templates_of<D>(options.split)},
          graph_{connect_prisms<D>(sweep.boundary, recipe_)}, vertices_{initial.mesh().points.size(), sweep,
                                                                        graph_, recipe_} {}

    /// Places the caps first: the hull takes memory only as it is written, and that of the caps may be
    /// released.
    Hull<D> run() {
        give_back_freed_memory(); // memory used for meshing and sweep
        describe();
        const Array<CellFacet> initial_boundary = boundary_of_cap(initial_.mesh());
        const Array<CellFacet> terminating_boundary = boundary_of_cap(terminating_.mesh());
        name_vertices();
        place_cap(initial_, 0, 0, 0, sweep_.times.front());
        place_cap(terminating_, hull_.terminating_begin(), hull_.terminating_points_begin(),
                  static_cast<Index>(vertices_.end()), sweep_.times.back());
        place_side_vertices();
        place_side_cells();
        join_cap(initial_boundary, 0, 0, Template::bottom);
        join_cap(terminating_boundary, hull_.terminating_begin(), hull_.layers - 1, Template::top);
        return std::move(hull_);
    }

private:
    using Template = PrismTemplate<D>;

    void describe() {
        hull_.initial_points = initial_.mesh().points.size();
        hull_.side_points = vertices_.end() - vertices_.begin();
        hull_.initial_cells = initial_.mesh().cells.size();
        hull_.layers = sweep_.layers();
        hull_.cells_per_prism = static_cast<std::size_t>(simplices_per_prism(options_.split));
        hull_.side_cells = hull_.layers * graph_.facets() * hull_.cells_per_prism;
        hull_.facet_patch.assign(sweep_.boundary.patch().begin(), sweep_.boundary.patch().end());
        hull_.patches = sweep_.boundary.patches();
        hull_.time = {sweep_.times.front(), sweep_.times.back()};
        const std::size_t points = vertices_.end() + terminating_.mesh().points.size();
        const std::size_t cells = hull_.terminating_begin() + terminating_.mesh().cells.size();
        checked_index(points, "hull vertices");
        checked_index(cells, "hull cells");
        hull_.points.resize(points);
        hull_.cells.resize(cells);
        hull_.neighbors.resize(cells);
    }

    /// Ids of the side are new; of its vertices those on levels have tracks.
    void name_vertices() {
        const SpatialMesh<D>& initial = initial_.mesh();
        hull_.vertex_ids.append(initial.vertex_ids);
        hull_.track_ids.append(initial_.tracks());
        hull_.vertex_ids.append_run(ids_.take(hull_.side_points), hull_.side_points, 1);
        const std::size_t centres =
            (hull_.side_points - (sweep_.layers() - 1) * sweep_.boundary.tracks().size()) / sweep_.layers();
        for (std::size_t layer = 0; layer < sweep_.layers(); ++layer) {
            if (layer > 0) {
                hull_.track_ids.append(sweep_.boundary.tracks());
            }
            hull_.track_ids.append_run(no_track, centres, 0);
        }
        hull_.vertex_ids.append(terminating_.mesh().vertex_ids);
        hull_.track_ids.append(terminating_.mesh().track_ids);
    }

    void place_cap(CapToStitch<D>& cap, std::size_t first_cell, std::size_t first_point, Index first_vertex,
                   double t) {
        cap.release(&SpatialMesh<D>::vertex_ids);
        cap.release(&SpatialMesh<D>::track_ids);
        for_each_index(cap.mesh().points.size(), items_per_step, [&](std::size_t v) {
            hull_.points[first_point + v] = at_time<D>(cap.mesh().points[v], t);
        });
        cap.release(&SpatialMesh<D>::points);
        const bool looks_back = first_cell == 0; // the cap faces back in time: cells are reversed
        place_rows(cap.mesh().cells, hull_.cells, first_cell, first_vertex, looks_back);
        cap.release(&SpatialMesh<D>::cells);
        // Across boundary facets the neighbours stay unset: see join_cap().
        place_rows(cap.mesh().neighbors, hull_.neighbors, first_cell, static_cast<Index>(first_cell),
                   looks_back);
        cap.release(&SpatialMesh<D>::neighbors);
    }

    /// Copies rows of indices to the hull's from row `first` on.
    template<class Row>
    static void place_rows(const Array<Row>& rows, Array<Row>& hull, std::size_t first, Index shift,
                           bool turned) {
        for_each_index(rows.size(), items_per_step, [&](std::size_t k) {
            Row row = rows[k];
            for (Index& entry : row) {
                entry += shift;
            }
            if (turned) {
                std::swap(row[0], row[1]);
            }
            hull[first + k] = row;
        });
    }

    void place_side_vertices() {
        for (std::size_t level = 1; level < sweep_.layers(); ++level) {
            for_each_index(sweep_.boundary.vertex_count(), items_per_step, [&](std::size_t v) {
                hull_.points[vertices_.on_level(level, static_cast<Index>(v))] =
                    at_time<D>(sweep_.positions[level][v], sweep_.times[level]);
            });
        }
        for (std::size_t layer = 0; layer < sweep_.layers(); ++layer) {
            place_centres(layer);
        }
    }

    void place_centres(std::size_t layer) {
        if (!vertices_.has_face_centres() && !vertices_.has_prism_centres()) {
            return;
        }
        for_each_index(graph_.facets(), prisms_per_piece, [&](std::size_t facet) {
            const auto& corners = sweep_.boundary.facets()[facet];
            if (vertices_.has_prism_centres()) {
                hull_.points[vertices_.prism_centre(layer, facet)] = mean_of_columns(layer, corners);
            }
            for (std::size_t q = 0; q < PrismGraph<D>::quads_of_facet && vertices_.has_face_centres(); ++q) {
                if (graph_.owns(facet, q) && graph_.is_centred(facet, q)) {
                    const auto [j, k] = quad_corners<D>(q);
                    hull_.points[vertices_.face_centre(layer, graph_.quad[facet][q])] =
                        mean_of_columns(layer, std::array{corners[j], corners[k]});
                }
            }
        });
    }

    /// Mean of the points that swept vertices have below and above a layer.
    template<std::size_t N>
    Point<D + 1> mean_of_columns(std::size_t layer, const std::array<Index, N>& vertices) const {
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
        return at_time<D>(sum, 0.5 * (sweep_.times[layer] + sweep_.times[layer + 1]));
    }

    void place_side_cells() {
        choice_ = choose_templates<D>(options_, graph_, {sweep_, vertices_, hull_.points});
        for_each_index(hull_.layers * graph_.facets(), prisms_per_piece, [this](std::size_t prism) {
            place_prism(prism / graph_.facets(), prism % graph_.facets());
        });
    }

    void place_prism(std::size_t layer, std::size_t facet) {
        const Template& filling = template_at(layer, facet);
        const auto points = vertices_.of_prism(layer, facet);
        const auto reached = reached_from(layer, facet);
        const std::size_t first = first_cell(layer, facet);
        for (std::size_t c = 0; c < filling.cells.size(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                hull_.cells[first + c][i] = points[filling.cells[c][i]];
                hull_.neighbors[first + c][i] = reached[filling.across[c][i]];
            }
        }
    }

    const Template& template_at(std::size_t layer, std::size_t facet) const {
        return templates_[choice_(layer, facet)];
    }

    std::size_t first_cell(std::size_t layer, std::size_t facet) const {
        return hull_.initial_cells + (layer * graph_.facets() + facet) * hull_.cells_per_prism;
    }

    Index cell_in_slot(std::size_t layer, std::size_t facet, std::uint8_t slot) const {
        return static_cast<Index>(first_cell(layer, facet) + template_at(layer, facet).cell_at[slot]);
    }

    /// The hull's cells that the values of PrismTemplate::across stand for in one prism. Those in caps stay
    /// unset.
    std::array<Index, Template::outside + Template::slots> reached_from(std::size_t layer,
                                                                        std::size_t facet) const {
        std::array<Index, Template::outside + Template::slots> cell;
        const auto first = static_cast<Index>(first_cell(layer, facet));
        for (Index c = 0; c < Template::outside; ++c) {
            cell[c] = first + c;
        }
        Index* const outside = cell.data() + Template::outside;
        outside[Template::bottom] = layer == 0 ? no_index : cell_in_slot(layer - 1, facet, Template::top);
        outside[Template::top] =
            layer + 1 == hull_.layers ? no_index : cell_in_slot(layer + 1, facet, Template::bottom);
        for (std::size_t face = 0; face < D; ++face) {
            const auto [entry, turned] = graph_.twin[facet][face];
            const Index across = graph_.across(facet, face);
            const Template& beyond = template_at(layer, across);
            const auto first_beyond = static_cast<Index>(first_cell(layer, across));
            for (std::size_t piece = 0; piece < Template::pieces; ++piece) {
                const std::size_t there = turned && piece >= 2 ? 5 - piece : piece; // over the other corner
                outside[Template::lateral(face, piece)] =
                    first_beyond + beyond.cell_at[Template::lateral(entry, there)];
            }
        }
        return cell;
    }

    Array<CellFacet> boundary_of_cap(const SpatialMesh<D>& cap) const {
        Array<CellFacet> boundary = find_boundary_facets(cap);
        if (boundary.size() != graph_.facets()) {
            throw GeometryError(
                fmt::format("the caps and the side of the slab from t = {} to {} do not close: a cap has {} "
                            "boundary facets, the side {}",
                            hull_.time[0], hull_.time[1], boundary.size(), graph_.facets()));
        }
        return boundary;
    }

    /// Joins boundary facet f of a cap to the prism over facet f: the cap's boundary facets are the swept
    /// ones, in order.
    void join_cap(const Array<CellFacet>& boundary, std::size_t cap_begin, std::size_t layer,
                  std::uint8_t slot) {
        for (std::size_t f = 0; f < boundary.size(); ++f) {
            const auto [cap_cell, cap_place] = boundary[f];
            const Index side_cell = cell_in_slot(layer, f, slot);
            const auto& across = template_at(layer, f).across[template_at(layer, f).cell_at[slot]];
            const auto side_place =
                std::find(across.begin(), across.end(), Template::outside + slot) - across.begin();
            const std::size_t turned = cap_begin == 0 && cap_place < 2 ? 1u - cap_place : cap_place;
            hull_.neighbors[cap_begin + cap_cell][turned] = side_cell;
            hull_.neighbors[side_cell][static_cast<std::size_t>(side_place)] =
                static_cast<Index>(cap_begin + cap_cell);
        }
    }

    CapToStitch<D>& initial_;
    const Sweep<D>& sweep_;
    CapToStitch<D>& terminating_;
    const SideOptions& options_;
    IdCounter& ids_;
    const SplitRecipe& recipe_;
    std::span<const Template> templates_;
    PrismGraph<D> graph_;
    SideVertices<D> vertices_;
    PrismChoice choice_;
    Hull<D> hull_;
};

} // namespace

template<int D>
SpatialMesh<D> terminating_cap(const Boundary<D>& boundary, CapMesh<D>&& mesh, IdCounter& ids) {
    SpatialMesh<D> cap;
    cap.boundary_facets.assign(boundary.facets().begin(), boundary.facets().end());
    cap.boundary_patch.assign(boundary.patch().begin(), boundary.patch().end());
    cap.patches = boundary.patches();
    cap.vertex_ids.resize(mesh.points.size());
    PersistentId id = ids.take(mesh.points.size());
    for (PersistentId& given : cap.vertex_ids) {
        given = id++;
    }
    cap.track_ids.assign(mesh.points.size(), no_track);
    std::copy(boundary.tracks().begin(), boundary.tracks().end(), cap.track_ids.begin());
    cap.points = std::move(mesh.points);
    cap.cells = std::move(mesh.cells);
    cap.neighbors = std::move(mesh.neighbors);
    return cap;
}

template<int D>
SpatialMesh<D> terminating_cap_of(const Hull<D>& hull, Array<Facet<D>> boundary_facets) {
    const std::size_t first_point = hull.terminating_points_begin();
    const std::size_t first_cell = hull.terminating_begin();
    SpatialMesh<D> cap;
    cap.points.resize(hull.points.size() - first_point);
    for_each_index(cap.points.size(), items_per_step, [&](std::size_t v) {
        std::copy_n(hull.points[first_point + v].begin(), D, cap.points[v].begin());
    });
    cap.cells.resize(hull.cells.size() - first_cell);
    cap.neighbors.resize(cap.cells.size());
    for_each_index(cap.cells.size(), items_per_step, [&](std::size_t c) {
        for (std::size_t i = 0; i <= D; ++i) {
            const Index across = hull.neighbors[first_cell + c][i];
            cap.cells[c][i] = hull.cells[first_cell + c][i] - static_cast<Index>(first_point);
            cap.neighbors[c][i] = across < first_cell ? no_index : across - static_cast<Index>(first_cell);
        }
    });
    cap.boundary_facets = std::move(boundary_facets);
    cap.boundary_patch = hull.facet_patch;
    cap.patches = hull.patches;
    cap.vertex_ids.resize(cap.points.size());
    cap.track_ids.resize(cap.points.size());
    hull.vertex_ids.copy(first_point, hull.points.size(), cap.vertex_ids.data());
    hull.track_ids.copy(first_point, hull.points.size(), cap.track_ids.data());
    return cap;
}

double side_simplex_count(std::size_t facets, std::size_t layers, Split split) {
    return static_cast<double>(facets) * static_cast<double>(layers) * simplices_per_prism(split);
}

template<int D>
std::size_t side_vertex_count(const Sweep<D>& sweep, Split split) {
    const SplitRecipe& recipe = recipe_of(split);
    const std::size_t facets = sweep.boundary.facet_count();
    std::size_t centres = recipe.apex == SplitRecipe::Apex::prism_centre ? facets : 0;
    if constexpr (D ==
                  3) { // of a prism's three quadrilaterals one is shared with its partner; each is in two
        centres += recipe.shared == SplitRecipe::Carries::centre ? facets / 2 : 0;
        centres += recipe.others == SplitRecipe::Carries::centre ? facets : 0;
    }
    return sweep.layers() * centres + (sweep.layers() - 1) * sweep.boundary.vertex_count();
}

template<int D>
Hull<D> stitch(CapToStitch<D> initial, const Sweep<D>& sweep, CapToStitch<D> terminating,
               const SideOptions& options, IdCounter& ids) {
    return Stitcher<D>{initial, sweep, terminating, options, ids}.run();
}

template SpatialMesh<2> terminating_cap<2>(const Boundary<2>&, CapMesh<2>&&, IdCounter&);
template SpatialMesh<3> terminating_cap<3>(const Boundary<3>&, CapMesh<3>&&, IdCounter&);
template std::size_t side_vertex_count<2>(const Sweep<2>&, Split);
template std::size_t side_vertex_count<3>(const Sweep<3>&, Split);
template Hull<2> stitch<2>(CapToStitch<2>, const Sweep<2>&, CapToStitch<2>, const SideOptions&, IdCounter&);
template Hull<3> stitch<3>(CapToStitch<3>, const Sweep<3>&, CapToStitch<3>, const SideOptions&, IdCounter&);
template SpatialMesh<2> terminating_cap_of<2>(const Hull<2>&, Array<Facet<2>>);
template SpatialMesh<3> terminating_cap_of<3>(const Hull<3>&, Array<Facet<3>>);

} // namespace slabhull
