// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/stitch.h"

#include "core/pieces.h"
#include "slab/stitch/cap_boundary.h"
#include "slab/stitch/prism_choice.h"
#include "slab/stitch/prism_graph.h"
#include "slab/stitch/side_points.h"
#include "slab/sweep/share_levels.h"
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
class Stitcher {
public:
    Stitcher(CapToStitch<D>& initial, const Sweep<D>& sweep, CapToStitch<D>& terminating,
             const SideOptions& options, IdCounter& ids)
        : initial_{initial}, sweep_{sweep},
          terminating_{terminating}, options_{options}, ids_{ids}, recipe_{recipe_of(options.split)},
          templates_{templates_of<D>(options.split)}, graph_{connect_prisms<D>(sweep.boundary, recipe_)},
          vertices_{initial.mesh().points.size(), sweep, graph_, recipe_}, points_{sweep, graph_, vertices_} {
    }

    /// Places the caps first: the hull takes memory only as it is written, and that of the caps may be
    /// released.
    Hull<D> whole() {
        describe(initial_.mesh().cells.size(), terminating_.mesh().cells.size());
        begin(0, 1);
        const std::array boundary{find_boundary_facets(initial_.mesh()),
                                  find_boundary_facets(terminating_.mesh())};
        require_closed(boundary);
        Hull<D> hull;
        hull.vertex_ids = std::move(vertex_ids_);
        hull.track_ids = std::move(track_ids_);
        hull.points.resize(hull_points_);
        place_points(initial_, hull.points.data(), sweep_.times.front());
        place_cells_of(initial_, 0, 0);
        place_points(terminating_, hull.points.data() + vertices_.end(), sweep_.times.back());
        place_cells_of(terminating_, order_.terminating_begin(), static_cast<Index>(vertices_.end()));
        for_each_index(vertices_.end() - vertices_.begin(), items_per_step, [&](std::size_t k) {
            hull.points[vertices_.begin() + k] = points_.of_vertex(vertices_.begin() + k);
        });
        place_side_cells();
        join_caps(boundary);
        static_cast<HullOrder<D>&>(hull) = std::move(order_);
        hull.cells = std::move(cells_);
        hull.neighbors = std::move(neighbors_);
        return hull;
    }

    /// Finds this rank's part. Returns the levels that it needs.
    HullRange begin_part(const Communicator& ranks) {
        describe(initial_.cells().all, terminating_.cells().all);
        begin(static_cast<std::size_t>(ranks.rank()), static_cast<std::size_t>(ranks.size()));
        const LayerRange layers = layers_to_choose(prisms_here());
        return levels_of({layers.first, layers.end - layers.first});
    }

    /// The part, after begin_part(), when the sweep has its levels.
    HullPart<D> part(Communicator& ranks, HullOrder<D>& order) {
        const std::array boundary{place_cells_from_ranks(initial_, 0, 0, ranks),
                                  place_cells_from_ranks(terminating_, order_.terminating_begin(),
                                                         static_cast<Index>(vertices_.end()), ranks)};
        require_closed(boundary);
        place_side_cells();
        join_caps(boundary);
        HullPart<D> part;
        part.hull_cells = hull_cells_;
        part.range = range_;
        part.cells = std::move(cells_);
        part.neighbors = std::move(neighbors_);
        number_points(part);
        number_neighbors(part);
        order = std::move(order_);
        return part;
    }

private:
    using Template = PrismTemplate<D>;

    /// What is known before anything is placed, and room for the cells of one of several parts.
    void begin(std::size_t part, std::size_t parts) {
        give_back_freed_memory(); // memory used for meshing and sweep
        if (parts > hull_cells_) {
            throw UsageError{fmt::format("{} parts cannot be made of {} cells", parts, hull_cells_)};
        }
        range_ = range_of_part(hull_cells_, part, parts);
        cells_.resize(range_.count);
        neighbors_.resize(range_.count);
        name_vertices();
    }

    void describe(std::size_t initial_cells, std::size_t terminating_cells) {
        order_.initial_points = initial_.mesh().points.size();
        order_.side_points = vertices_.end() - vertices_.begin();
        order_.initial_cells = initial_cells;
        order_.layers = sweep_.layers();
        order_.cells_per_prism = static_cast<std::size_t>(simplices_per_prism(options_.split));
        order_.side_cells = order_.layers * graph_.facets() * order_.cells_per_prism;
        order_.facet_patch.assign(sweep_.boundary.patch().begin(), sweep_.boundary.patch().end());
        order_.patches = sweep_.boundary.patches();
        order_.time = {sweep_.times.front(), sweep_.times.back()};
        hull_points_ = vertices_.end() + terminating_.mesh().points.size();
        hull_cells_ = order_.terminating_begin() + terminating_cells;
        checked_index(hull_points_, "hull vertices");
        checked_index(hull_cells_, "hull cells");
    }

    /// Ids of the side are new; of its vertices those on levels have tracks.
    void name_vertices() {
        const SpatialMesh<D>& initial = initial_.mesh();
        vertex_ids_.append(initial.vertex_ids);
        track_ids_.append(initial_.tracks());
        vertex_ids_.append_run(ids_.take(order_.side_points), order_.side_points, 1);
        const std::size_t centres =
            (order_.side_points - (sweep_.layers() - 1) * sweep_.boundary.tracks().size()) / sweep_.layers();
        for (std::size_t layer = 0; layer < sweep_.layers(); ++layer) {
            if (layer > 0) {
                track_ids_.append(sweep_.boundary.tracks());
            }
            track_ids_.append_run(no_track, centres, 0);
        }
        vertex_ids_.append(terminating_.mesh().vertex_ids);
        track_ids_.append(terminating_.mesh().track_ids);
    }

    // --- cells, in the numbers of the whole hull

    /// The cells of a range that are here, too.
    HullRange held(std::size_t first, std::size_t count) const {
        const std::size_t begin = std::clamp(first, range_.first, range_.end());
        const std::size_t end = std::clamp(first + count, range_.first, range_.end());
        return {begin, end - begin};
    }

    static void place_points(CapToStitch<D>& cap, Point<D + 1>* to, double t) {
        cap.release(&SpatialMesh<D>::vertex_ids);
        cap.release(&SpatialMesh<D>::track_ids);
        for_each_index(cap.mesh().points.size(), items_per_step,
                       [&](std::size_t v) { to[v] = at_time<D>(cap.mesh().points[v], t); });
        cap.release(&SpatialMesh<D>::points);
    }

    void place_cells_of(CapToStitch<D>& cap, std::size_t first_cell, Index first_vertex) {
        place_rows(cap.mesh().cells, cells_, first_cell, first_vertex, first_cell == 0);
        cap.release(&SpatialMesh<D>::cells);
        // Across boundary facets the neighbours stay unset: see join_cap().
        place_rows(cap.mesh().neighbors, neighbors_, first_cell, static_cast<Index>(first_cell),
                   first_cell == 0);
        cap.release(&SpatialMesh<D>::neighbors);
    }

    /// The same of the cap's cells that are in this part, which may be on other ranks. Returns the boundary
    /// facets of all.
    Array<CellFacet> place_cells_from_ranks(CapToStitch<D>& cap, std::size_t first_cell, Index first_vertex,
                                            Communicator& ranks) {
        const HullRange here = held(first_cell, cap.cells().all);
        CapCells<D> cells = redistributed(std::move(cap.cells()),
                                          {here.count > 0 ? here.first - first_cell : 0, here.count}, ranks);
        Array<CellFacet> boundary = find_boundary_facets(cap.mesh(), cells, ranks);
        const std::size_t first = first_cell + cells.range.first;
        place_rows(cells.cells, cells_, first, first_vertex, first_cell == 0);
        place_rows(cells.neighbors, neighbors_, first, static_cast<Index>(first_cell), first_cell == 0);
        return boundary;
    }

    /// Copies rows of indices to those of the hull's cells from `first` on. Those of the initial cap, which
    /// looks back in time, are turned.
    template<class Row>
    void place_rows(const Array<Row>& rows, Array<Row>& hull, std::size_t first, Index shift, bool turned) {
        const HullRange here = held(first, rows.size());
        for_each_index(here.count, items_per_step, [&](std::size_t k) {
            Row row = rows[here.first - first + k];
            for (Index& entry : row) {
                entry += shift;
            }
            if (turned) {
                std::swap(row[0], row[1]);
            }
            hull[here.first - range_.first + k] = row;
        });
    }

    void place_side_cells() {
        const HullRange prisms = prisms_here();
        choice_ = choose_templates<D>(options_, graph_, sweep_, points_, layers_to_choose(prisms));
        for_each_index(prisms.count, prisms_per_piece, [&](std::size_t k) {
            place_prism((prisms.first + k) / graph_.facets(), (prisms.first + k) % graph_.facets());
        });
    }

    /// The prisms with cells here.
    HullRange prisms_here() const {
        const HullRange here = held(order_.initial_cells, order_.side_cells);
        if (here.count == 0) {
            return {};
        }
        const std::size_t first = (here.first - order_.initial_cells) / order_.cells_per_prism;
        const std::size_t end = (here.end() - order_.initial_cells - 1) / order_.cells_per_prism + 1;
        return {first, end - first};
    }

    /// The layers whose diagonals matter here: those of `prisms` and of the prisms that join the caps' cells,
    /// and the layers beside them.
    LayerRange layers_to_choose(const HullRange& prisms) const {
        LayerRange layers{order_.layers, 0};
        if (prisms.count > 0) {
            layers = {prisms.first / graph_.facets(), (prisms.end() - 1) / graph_.facets() + 1};
        }
        if (held(0, order_.initial_cells).count > 0) {
            layers = {0, std::max<std::size_t>(layers.end, 1)};
        }
        if (held(order_.terminating_begin(), hull_cells_ - order_.terminating_begin()).count > 0) {
            layers = {std::min(layers.first, order_.layers - 1), order_.layers};
        }
        return {layers.first - std::min<std::size_t>(layers.first, 1),
                std::min(layers.end + 1, order_.layers)};
    }

    void place_prism(std::size_t layer, std::size_t facet) {
        const Template& filling = template_at(layer, facet);
        const auto points = vertices_.of_prism(layer, facet);
        const auto reached = reached_from(layer, facet);
        const std::size_t first = first_cell(layer, facet);
        for (std::size_t c = 0; c < filling.cells.size(); ++c) {
            if (!range_.contains(first + c)) {
                continue; // a range may begin or end within a prism
            }
            const std::size_t row = first + c - range_.first;
            for (std::size_t i = 0; i <= D; ++i) {
                cells_[row][i] = points[filling.cells[c][i]];
                neighbors_[row][i] = reached[filling.across[c][i]];
            }
        }
    }

    const Template& template_at(std::size_t layer, std::size_t facet) const {
        return templates_[choice_(layer, facet)];
    }

    std::size_t first_cell(std::size_t layer, std::size_t facet) const {
        return order_.initial_cells + (layer * graph_.facets() + facet) * order_.cells_per_prism;
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
            layer + 1 == order_.layers ? no_index : cell_in_slot(layer + 1, facet, Template::bottom);
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

    void require_closed(const std::array<Array<CellFacet>, 2>& boundary) const {
        for (const Array<CellFacet>& of_cap : boundary) {
            if (of_cap.size() != graph_.facets()) {
                throw GeometryError(
                    fmt::format("the caps and the side of the slab from t = {} to {} do not close: a cap has "
                                "{} boundary facets, the side {}",
                                order_.time[0], order_.time[1], of_cap.size(), graph_.facets()));
            }
        }
    }

    void join_caps(const std::array<Array<CellFacet>, 2>& boundary) {
        join_cap(boundary[0], 0, 0, Template::bottom);
        join_cap(boundary[1], order_.terminating_begin(), order_.layers - 1, Template::top);
    }

    /// Joins boundary facet f of a cap to the prism over facet f: the cap's boundary facets are the swept
    /// ones, in order.
    void join_cap(const Array<CellFacet>& boundary, std::size_t cap_begin, std::size_t layer,
                  std::uint8_t slot) {
        if (held(cap_begin, cap_begin == 0 ? order_.initial_cells : hull_cells_ - cap_begin).count == 0 &&
            held(first_cell(layer, 0), graph_.facets() * order_.cells_per_prism).count == 0) {
            return; // no diagonals are known there, nor are they needed
        }
        for (std::size_t f = 0; f < boundary.size(); ++f) {
            const auto [cap_cell, cap_place] = boundary[f];
            const Index side_cell = cell_in_slot(layer, f, slot);
            const auto& across = template_at(layer, f).across[template_at(layer, f).cell_at[slot]];
            const auto side_place =
                std::find(across.begin(), across.end(), Template::outside + slot) - across.begin();
            const std::size_t turned = cap_begin == 0 && cap_place < 2 ? 1u - cap_place : cap_place;
            set_neighbor(cap_begin + cap_cell, turned, side_cell);
            set_neighbor(side_cell, static_cast<std::size_t>(side_place),
                         static_cast<Index>(cap_begin + cap_cell));
        }
    }

    void set_neighbor(std::size_t cell, std::size_t place, Index neighbor) {
        if (range_.contains(cell)) {
            neighbors_[cell - range_.first][place] = neighbor;
        }
    }

    // --- a part's own numbers

    Point<D + 1> point_of(std::size_t vertex) const {
        if (vertex < vertices_.begin()) {
            return at_time<D>(initial_.mesh().points[vertex], sweep_.times.front());
        }
        return vertex < vertices_.end()
                   ? points_.of_vertex(vertex)
                   : at_time<D>(terminating_.mesh().points[vertex - vertices_.end()], sweep_.times.back());
    }

    /// Finds the points that the part's cells use, and numbers them within the part.
    void number_points(HullPart<D>& part) const {
        auto used = std::make_shared<PointSet>(hull_points_);
        for (const Simplex<D>& cell : part.cells) {
            for (const Index v : cell) {
                used->insert(v);
            }
        }
        used->count();
        for_each_index(part.cells.size(), items_per_step, [&](std::size_t c) {
            for (Index& v : part.cells[c]) {
                v = static_cast<Index>(used->rank(v));
            }
        });
        part.points.resize(used->size());
        Array<std::int64_t> ids(used->size());
        Array<std::int64_t> tracks(used->size());
        parallel_for(used->size(), items_per_step, [&](std::size_t begin, std::size_t end) {
            std::size_t vertex = used->member(begin);
            for (std::size_t k = begin; k < end; ++k) {
                part.points[k] = point_of(vertex);
                ids[k] = vertex_ids_[vertex];
                tracks[k] = track_ids_[vertex];
                vertex = k + 1 < end ? used->next(vertex) : vertex;
            }
        });
        part.vertex_ids.append(ids);
        part.track_ids.append(tracks);
        part.points_used = std::move(used);
    }

    /// Lists the cells beside the part and numbers neighbours within it.
    void number_neighbors(HullPart<D>& part) const {
        for (const Neighbors<D>& row : part.neighbors) {
            for (const Index neighbor : row) {
                if (!range_.contains(neighbor)) {
                    part.outside.push_back(neighbor);
                }
            }
        }
        sort_out(part.outside);
        checked_index(part.cells.size() + part.outside.size(), "cells of a part");
        for_each_index(part.neighbors.size(), items_per_step, [&](std::size_t c) {
            for (Index& neighbor : part.neighbors[c]) {
                if (range_.contains(neighbor)) {
                    neighbor -= static_cast<Index>(range_.first);
                } else {
                    const auto place =
                        std::lower_bound(part.outside.begin(), part.outside.end(), std::uint64_t{neighbor});
                    neighbor = static_cast<Index>(part.cells.size()) +
                               static_cast<Index>(place - part.outside.begin());
                }
            }
        });
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
    SidePoints<D> points_;
    PrismChoice choice_;
    HullOrder<D> order_;
    std::size_t hull_points_ = 0;
    std::size_t hull_cells_ = 0;
    IntegerList vertex_ids_; ///< of the whole hull, in runs
    IntegerList track_ids_;
    HullRange range_; ///< of the cells that are made
    Array<Simplex<D>> cells_;
    Array<Neighbors<D>> neighbors_;
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
    return Stitcher<D>{initial, sweep, terminating, options, ids}.whole();
}

HullRange range_of_part(std::size_t cells, std::size_t part, std::size_t parts) {
    const std::size_t begin = begin_of_part(cells, part, parts);
    return {begin, begin_of_part(cells, part + 1, parts) - begin};
}

HullRange range_of_rank(std::size_t cells, const Communicator& ranks) {
    return range_of_part(cells, static_cast<std::size_t>(ranks.rank()),
                         static_cast<std::size_t>(ranks.size()));
}

template<int D>
HullPart<D> stitch_part(CapToStitch<D> initial, Sweep<D>& sweep, CapToStitch<D> terminating,
                        const SideOptions& options, IdCounter& ids, Communicator& ranks,
                        HullOrder<D>& order) {
    return together(ranks, [&] {
        Stitcher<D> stitcher{initial, sweep, terminating, options, ids};
        share_levels(sweep, stitcher.begin_part(ranks), ranks);
        return stitcher.part(ranks, order);
    });
}

template SpatialMesh<2> terminating_cap<2>(const Boundary<2>&, CapMesh<2>&&, IdCounter&);
template SpatialMesh<3> terminating_cap<3>(const Boundary<3>&, CapMesh<3>&&, IdCounter&);
template std::size_t side_vertex_count<2>(const Sweep<2>&, Split);
template std::size_t side_vertex_count<3>(const Sweep<3>&, Split);
template Hull<2> stitch<2>(CapToStitch<2>, const Sweep<2>&, CapToStitch<2>, const SideOptions&, IdCounter&);
template Hull<3> stitch<3>(CapToStitch<3>, const Sweep<3>&, CapToStitch<3>, const SideOptions&, IdCounter&);
template HullPart<2> stitch_part<2>(CapToStitch<2>, Sweep<2>&, CapToStitch<2>, const SideOptions&, IdCounter&,
                                    Communicator&, HullOrder<2>&);
template HullPart<3> stitch_part<3>(CapToStitch<3>, Sweep<3>&, CapToStitch<3>, const SideOptions&, IdCounter&,
                                    Communicator&, HullOrder<3>&);
template SpatialMesh<2> terminating_cap_of<2>(const Hull<2>&, Array<Facet<2>>);
template SpatialMesh<3> terminating_cap_of<3>(const Hull<3>&, Array<Facet<3>>);

} // namespace slabhull
