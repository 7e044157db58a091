// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/domain.h"

#include "core/listed.h"
#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/slab/sweep.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace slabhull {

namespace {

/// Boundary facets in the order of their patches, so that the side's cells of one patch stand together.
template<int D>
void sort_boundary_by_patch(SpatialMesh<D>& mesh) {
    std::vector<std::size_t> order(mesh.boundary_facets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&mesh](std::size_t a, std::size_t b) {
        return mesh.boundary_patch[a] < mesh.boundary_patch[b];
    });
    Array<Facet<D>> facets;
    std::vector<PatchNumber> patch;
    for (const std::size_t f : order) {
        facets.push_back(mesh.boundary_facets[f]);
        patch.push_back(mesh.boundary_patch[f]);
    }
    mesh.boundary_facets = std::move(facets);
    mesh.boundary_patch = std::move(patch);
}

template<int D>
void number_vertices(SpatialMesh<D>& mesh, IdCounter& ids) {
    mesh.vertex_ids.resize(mesh.points.size());
    std::iota(mesh.vertex_ids.begin(), mesh.vertex_ids.end(), ids.take(mesh.points.size()));
    mesh.track_ids.assign(mesh.points.size(), no_track);
    for (const auto& facet : mesh.boundary_facets) {
        for (const Index v : facet) {
            mesh.track_ids[v] = 0;
        }
    }
    TrackId track = 0;
    for (TrackId& given : mesh.track_ids) {
        if (given != no_track) {
            given = track++;
        }
    }
}

template<int D>
Facet<D> ascending_facet(Facet<D> facet) {
    std::sort(facet.begin(), facet.end());
    return facet;
}

/// Entities at fault, each once, by the user's numbers.
class Culprits {
public:
    Culprits(const char* kind, const std::vector<std::int64_t>& numbers) : kind_{kind}, numbers_{numbers} {}

    void add(std::size_t i) {
        if (added_.insert(i).second) {
            found_.push_back(numbers_.empty() ? static_cast<std::int64_t>(i) : numbers_[i]);
        }
    }

    /// Throws if there are any: "<where>: <count> <what>: <the first numbers><advice>".
    void refuse(const std::string& where, const std::string& what, const char* advice = "") const {
        if (found_.empty()) {
            return;
        }
        std::vector<Entity> entities;
        for (const std::int64_t number : found_) {
            entities.push_back({kind_, number, ""});
        }
        throw InputError(fmt::format("{}: {} {}: {}{}", where, found_.size(), what, listed(found_), advice),
                         std::move(entities));
    }

private:
    const char* kind_;
    const std::vector<std::int64_t>& numbers_;
    std::set<std::size_t> added_;
    std::vector<std::int64_t> found_;
};

template<int D>
class DomainBuilder {
public:
    explicit DomainBuilder(DomainInput<D> input) : input_{std::move(input)} {}

    Domain<D> run(const IdCounter& ids) {
        require_lengths();
        require_sound_numbers();
        mesh_.points = std::move(input_.points);
        mesh_.cells = std::move(input_.cells);
        orient_cells();
        connect();
        find_patches();
        Array<Index> vertices;
        require_domain_boundary(boundary_surface(mesh_, vertices), facet_naming(), true);
        sort_boundary_by_patch(mesh_);
        domain_.ids = ids;
        number_vertices(mesh_, domain_.ids);
        return std::move(domain_);
    }

private:
    void require_lengths() const {
        const auto require = [this](const char* name, std::size_t length, std::size_t wanted,
                                    bool may_be_empty) {
            if (length != wanted && !(may_be_empty && length == 0)) {
                throw UsageError(
                    fmt::format("{}: {} has {} entries instead of {}", input_.where, name, length, wanted));
            }
        };
        require("cell_group", input_.cell_group.size(), input_.cells.size(), true);
        require("facet_patch", input_.facet_patch.size(), input_.facets.size(), false);
        require("cell_numbers", input_.cell_numbers.size(), input_.cells.size(), true);
        require("facet_numbers", input_.facet_numbers.size(), input_.facets.size(), true);
        require("point_numbers", input_.point_numbers.size(), input_.points.size(), true);
        if (input_.cells.empty()) {
            throw InputError(fmt::format("{}: has no {}, which a domain of dimension {} is made of",
                                         input_.where, D == 3 ? "tetrahedra" : "triangles", D));
        }
    }

    template<class Simplices>
    void require_in_range(const Simplices& simplices, const char* kind,
                          const std::vector<std::int64_t>& numbers) const {
        Culprits out_of_range{kind, numbers};
        for (std::size_t i = 0; i < simplices.size(); ++i) {
            if (*std::max_element(simplices[i].begin(), simplices[i].end()) >= input_.points.size()) {
                out_of_range.add(i);
            }
        }
        out_of_range.refuse(input_.where, fmt::format("{}s refer to points that do not exist (there are {})",
                                                      kind, input_.points.size()));
    }

    void require_sound_numbers() const {
        require_in_range(input_.cells, "cell", input_.cell_numbers);
        require_in_range(input_.facets, "facet", input_.facet_numbers);
        Culprits negative{"facet", input_.facet_numbers};
        for (std::size_t f = 0; f < input_.facets.size(); ++f) {
            if (input_.facet_patch[f] < 0) {
                negative.add(f);
            }
        }
        negative.refuse(input_.where, "facets have a negative patch number");
        std::vector<bool> used(input_.points.size(), false);
        for (const Simplex<D>& cell : input_.cells) {
            for (const Index v : cell) {
                used[v] = true;
            }
        }
        Culprits unused{"vertex", input_.point_numbers};
        Culprits not_finite{"vertex", input_.point_numbers};
        for (std::size_t v = 0; v < used.size(); ++v) {
            if (!used[v]) {
                unused.add(v);
            }
            if (!all_finite(input_.points[v])) {
                not_finite.add(v);
            }
        }
        unused.refuse(input_.where, "points belong to no cell");
        not_finite.refuse(input_.where, "points have coordinates that are not finite");
    }

    /// Each group may be oriented either way, but all its cells the same way.
    void orient_cells() {
        std::map<std::int32_t, std::int64_t> balance; // positive minus negative cells of each group
        Culprits flat = cells_at_fault();
        std::vector<signed char> sign(mesh_.cells.size());
        for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
            const double measure = signed_measure<D>(corners_of<D, D>(mesh_.cells[c], mesh_.points));
            sign[c] = measure > 0 ? 1 : -1;
            balance[group(c)] += sign[c];
            if (!(measure != 0)) {
                flat.add(c);
            }
        }
        flat.refuse(input_.where, "degenerate cells (of measure zero)");
        Culprits inverted = cells_at_fault();
        for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
            if ((balance[group(c)] >= 0) != (sign[c] > 0)) {
                inverted.add(c);
            } else if (sign[c] < 0) {
                std::swap(mesh_.cells[c][0], mesh_.cells[c][1]);
            }
        }
        inverted.refuse(input_.where, "inverted cells (oriented against the others of their entity)",
                        "; turn them round: swap two of their corners");
    }

    std::int32_t group(std::size_t cell) const {
        return input_.cell_group.empty() ? 0 : input_.cell_group[cell];
    }
    Culprits cells_at_fault() const { return {"cell", input_.cell_numbers}; }

    void connect() {
        Adjacency<D> adjacency = build_adjacency<D>(mesh_.cells, mesh_.points.size());
        Culprits overfull = cells_at_fault();
        Culprits folded =
            cells_at_fault(); // all cells are positive, so both lie on the same side of their facet
        for (const FacetDefect<D>& defect : adjacency.defects) {
            for (const Index cell : defect.cells) {
                if (defect.kind == FacetDefect<D>::Kind::overfull) {
                    overfull.add(cell);
                } else if (defect.kind == FacetDefect<D>::Kind::disoriented) {
                    folded.add(cell);
                }
            }
        }
        overfull.refuse(input_.where, "cells meet in a facet of three or more");
        folded.refuse(input_.where, "cells overlap a neighbour (both lie on the same side of their facet)");
        mesh_.neighbors = std::move(adjacency.neighbors);
    }

    using FacetByVertices = std::pair<Facet<D>, std::size_t>; ///< sorted vertices, place in the input

    /// The input's facets sorted for look-up; equal ones in input order.
    std::vector<FacetByVertices> facets_by_vertices() const {
        std::vector<FacetByVertices> facets;
        facets.reserve(input_.facets.size());
        for (std::size_t f = 0; f < input_.facets.size(); ++f) {
            facets.emplace_back(ascending_facet<D>(input_.facets[f]), f);
        }
        std::sort(facets.begin(), facets.end());
        return facets;
    }

    void find_repeated(const std::vector<FacetByVertices>& facets) {
        std::size_t first = 0;
        for (std::size_t k = 1; k < facets.size(); ++k) {
            if (facets[k].first == facets[first].first) {
                domain_.repeated_facets.push_back({facets[first].second, facets[k].second});
            } else {
                first = k;
            }
        }
    }

    void find_patches() {
        std::vector<FacetByVertices> facets = facets_by_vertices();
        find_repeated(facets);
        std::vector<bool> bounds(input_.facets.size(), false);
        for (Index c = 0; c < mesh_.cells.size(); ++c) {
            for (int i = 0; i <= D; ++i) {
                if (mesh_.neighbors[c][static_cast<std::size_t>(i)] == no_index) {
                    add_boundary_facet(outward_facet<D>(mesh_.cells[c], i), facets, bounds);
                }
            }
        }
        std::erase_if(facets, [&bounds](const FacetByVertices& facet) { return bounds[facet.second]; });
        find_inner(facets);
        name_patches();
    }

    void add_boundary_facet(const Facet<D>& facet, const std::vector<FacetByVertices>& facets,
                            std::vector<bool>& bounds) {
        mesh_.boundary_facets.push_back(facet);
        const Facet<D> key = ascending_facet<D>(facet);
        auto found = std::lower_bound(facets.begin(), facets.end(), FacetByVertices{key, 0});
        if (found == facets.end() || found->first != key) {
            mesh_.boundary_patch.push_back(0);
            boundary_numbers_.push_back(-1);
            return;
        }
        const std::size_t first = found->second;
        mesh_.boundary_patch.push_back(input_.facet_patch[first]);
        boundary_numbers_.push_back(input_.facet_numbers.empty() ? static_cast<std::int64_t>(first)
                                                                 : input_.facet_numbers[first]);
        for (; found != facets.end() && found->first == key; ++found) {
            bounds[found->second] = true;
        }
    }

    /// Collects input facets inside the domain; refuses others that do not bound it.
    void find_inner(const std::vector<FacetByVertices>& facets) {
        if (facets.empty()) {
            return;
        }
        std::vector<bool> inside(facets.size(), false);
        for (const Simplex<D>& cell : mesh_.cells) {
            for (int i = 0; i <= D; ++i) {
                const Facet<D> key = ascending_facet<D>(outward_facet<D>(cell, i));
                auto found = std::lower_bound(facets.begin(), facets.end(), FacetByVertices{key, 0});
                for (; found != facets.end() && found->first == key; ++found) {
                    inside[static_cast<std::size_t>(found - facets.begin())] = true;
                }
            }
        }
        Culprits stray{"facet", input_.facet_numbers};
        for (std::size_t k = 0; k < facets.size(); ++k) {
            if (inside[k]) {
                domain_.inner_facets.push_back(facets[k].second);
            } else if (!input_.facets_of_more) {
                stray.add(facets[k].second);
            }
        }
        stray.refuse(input_.where, "facets are not facets of any cell");
        std::sort(domain_.inner_facets.begin(), domain_.inner_facets.end());
    }

    void name_patches() {
        std::map<PatchNumber, std::string> names;
        for (const PatchNumber number : mesh_.boundary_patch) {
            if (number > 0) {
                names.emplace(number, fmt::format("{}", number)); // a patch without a name goes by its number
            }
        }
        for (const Patch& patch : input_.patches) {
            const auto found = names.find(patch.number);
            if (found != names.end() && !patch.name.empty()) {
                found->second = patch.name;
            }
        }
        const auto without = std::count(mesh_.boundary_patch.begin(), mesh_.boundary_patch.end(), 0);
        if (without > 0) {
            const PatchNumber rest = number_of_rest(names);
            std::replace(mesh_.boundary_patch.begin(), mesh_.boundary_patch.end(), 0, rest);
            names.emplace(rest, rest_name);
            domain_.facets_without_patch = static_cast<std::size_t>(without);
        }
        for (const auto& [number, name] : names) {
            mesh_.patches.push_back({number, name});
        }
    }

    /// The number of an existing patch with the name of the rest, else the one after the last.
    static PatchNumber number_of_rest(const std::map<PatchNumber, std::string>& names) {
        const auto called = std::find_if(names.begin(), names.end(),
                                         [](const auto& each) { return each.second == rest_name; });
        if (called != names.end()) {
            return called->first;
        }
        PatchNumber number = names.empty() ? 1 : names.rbegin()->first;
        while (names.contains(number)) {
            number = number == std::numeric_limits<PatchNumber>::max() ? 1 : number + 1;
        }
        return number;
    }

    /// Facets by the user's numbers, if all of the boundary are in the input.
    FacetNaming facet_naming() const {
        const bool all_listed =
            std::find(boundary_numbers_.begin(), boundary_numbers_.end(), -1) == boundary_numbers_.end();
        return {input_.where, all_listed ? boundary_numbers_ : std::vector<std::int64_t>{}};
    }

    static constexpr const char* rest_name = "boundary";

    DomainInput<D> input_;
    Domain<D> domain_;
    SpatialMesh<D>& mesh_ = domain_.mesh;
    std::vector<std::int64_t> boundary_numbers_; ///< of each boundary facet; -1: not in the input
};

} // namespace

template<int D>
Domain<D> make_domain(DomainInput<D> input, IdCounter ids) {
    return DomainBuilder<D>{std::move(input)}.run(ids);
}

template<int D>
Domain<D> make_domain(CapMesh<D> cap, Surface<D> boundary, IdCounter ids) {
    Domain<D> domain;
    SpatialMesh<D>& mesh = domain.mesh;
    mesh.points = std::move(cap.points);
    mesh.cells = std::move(cap.cells);
    mesh.neighbors = std::move(cap.neighbors);
    mesh.boundary_facets = std::move(boundary.facets);
    mesh.boundary_patch = std::move(boundary.patch);
    mesh.patches = std::move(boundary.patches);
    sort_boundary_by_patch(mesh);
    domain.ids = ids;
    number_vertices(mesh, domain.ids);
    return domain;
}

template Domain<2> make_domain<2>(DomainInput<2>, IdCounter);
template Domain<3> make_domain<3>(DomainInput<3>, IdCounter);
template Domain<2> make_domain<2>(CapMesh<2>, Surface<2>, IdCounter);
template Domain<3> make_domain<3>(CapMesh<3>, Surface<3>, IdCounter);

} // namespace slabhull
