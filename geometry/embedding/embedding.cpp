// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/embedding.h"

#include "geometry/basics/predicates.h"
#include "geometry/basics/vector_algebra.h"
#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/components.h"
#include "geometry/embedding/facet_names.h"
#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/error.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace slabhull {

namespace {

/// Checks the conditions of require_domain_boundary(), each relying on those before it.
template<int D>
class BoundaryInspection {
public:
    BoundaryInspection(const Surface<D>& surface, const FacetNaming& naming, bool is_input)
        : surface_{surface}, names_{surface, naming}, is_input_{is_input} {}

    void run() {
        require_facets();
        require_finite_points();
        require_used_points();
        require_extent();
        const Adjacency<D - 1> adjacency = build_adjacency<D - 1>(surface_.facets, surface_.points.size());
        require_closed(adjacency);
        if constexpr (D == 3) { // for D = 2 a closed ridge is a vertex in two edges: always one fan
            require_fans(adjacency);
        }
        require_no_crossings();
        require_nesting(FacetComponents<D>{adjacency.neighbors});
    }

    /// Checks the conditions that depend on positions only.
    void run_places(const Boundary<D>& boundary) {
        require_finite_points();
        require_extent();
        require_no_crossings();
        require_nesting(boundary.facet_components());
    }

private:
    /// Name of a ridge, where facets meet: a vertex (D = 2) or edge (D = 3).
    static constexpr const char* ridge_name = D == 2 ? "vertex" : "edge";

    [[noreturn]] void refuse(const std::string& message, std::vector<Entity> at_fault) const {
        const std::string placed = names_.placed(message);
        if (is_input_) {
            throw InputError{placed, std::move(at_fault)};
        }
        throw GeometryError{placed, std::move(at_fault)};
    }

    void require_facets() const;
    void require_finite_points() const;
    void require_used_points() const;
    void require_extent() const;
    void require_closed(const Adjacency<D - 1>& adjacency) const;
    void require_fans(const Adjacency<D - 1>& adjacency) const;
    void require_no_crossings() const;
    void require_nesting(const FacetComponents<D>& components) const;

    std::string ridge_in_words(const FacetDefect<D - 1>& defect) const;
    void judge_component(const FacetComponents<D>& components, Index facet,
                         const std::vector<double>& enclosed, int winding) const;
    std::string whereabouts(const FacetComponents<D>& components, Index part,
                            const std::vector<double>& enclosed) const;
    template<class Takes>
    std::string extent_in_words(const Takes& takes) const;

    const Surface<D>& surface_;
    FacetNames<D> names_;
    bool is_input_;
};

template<int D>
void BoundaryInspection<D>::require_facets() const {
    if (surface_.facets.empty()) {
        refuse("the boundary has no facets", {});
    }
    for (Index f = 0; f < surface_.facets.size(); ++f) {
        for (const Index v : surface_.facets[f]) {
            if (v >= surface_.points.size()) {
                refuse(fmt::format("{} refers to vertex {}, but there are only {} vertices", names_.facet(f),
                                   v, surface_.points.size()),
                       {names_.entity(f)});
            }
        }
    }
}

template<int D>
void BoundaryInspection<D>::require_finite_points() const {
    for (std::size_t v = 0; v < surface_.points.size(); ++v) {
        if (!all_finite(surface_.points[v])) {
            refuse(fmt::format("vertex {} of the boundary is at {}: every coordinate must be a finite number",
                               v, place_in_words(surface_.points[v])),
                   {{"vertex", static_cast<std::int64_t>(v), ""}});
        }
    }
}

template<int D>
void BoundaryInspection<D>::require_used_points() const {
    std::vector<bool> used(surface_.points.size(), false);
    for (const Facet<D>& facet : surface_.facets) {
        for (const Index v : facet) {
            used[v] = true;
        }
    }
    const auto first = std::find(used.begin(), used.end(), false);
    if (first != used.end()) {
        const auto v = static_cast<std::size_t>(first - used.begin());
        refuse(
            fmt::format(
                "{} of the boundary's vertices are in no facet, the first is vertex {} at {}; leave them out",
                std::count(first, used.end(), false), v, place_in_words(surface_.points[v])),
            {{"vertex", static_cast<std::int64_t>(v), ""}});
    }
}

template<int D>
void BoundaryInspection<D>::require_extent() const {
    std::vector<Index> flat;
    for (Index f = 0; f < surface_.facets.size(); ++f) {
        if (exact::degenerate(corners_of_facet(surface_, f))) {
            flat.push_back(f);
        }
    }
    if (!flat.empty()) {
        refuse(fmt::format("{} facets have no {}: {}; remove them or merge their vertices", flat.size(),
                           D == 2 ? "length" : "area", names_.list(flat)),
               names_.entities(flat));
    }
}

template<int D>
std::string BoundaryInspection<D>::ridge_in_words(const FacetDefect<D - 1>& defect) const {
    using Kind = typename FacetDefect<D - 1>::Kind;
    std::string where =
        fmt::format("the {} at {}", ridge_name, place_in_words(surface_.points[defect.facet[0]]));
    if constexpr (D == 3) {
        where = fmt::format("the edge from {} to {}", place_in_words(surface_.points[defect.facet[0]]),
                            place_in_words(surface_.points[defect.facet[1]]));
    }
    const std::string facets = names_.list(defect.cells);
    switch (defect.kind) {
    case Kind::open:
        return fmt::format("{} is open: it is in {} only", where, facets);
    case Kind::overfull:
        return fmt::format("{} is in {} facets instead of two: {}", where, defect.cells.size(), facets);
    default:
        return fmt::format("{} is between facets of opposite orientation: {}", where, facets);
    }
}

template<int D>
void BoundaryInspection<D>::require_closed(const Adjacency<D - 1>& adjacency) const {
    const auto& defects = adjacency.defects;
    if (defects.empty()) {
        return;
    }
    std::string message = fmt::format("the boundary is not a closed, oriented surface; {} {} faulty",
                                      defects.size(), defects.size() == 1 ? "place is" : "places are");
    std::vector<Entity> at_fault;
    for (std::size_t k = 0; k < std::min(defects.size(), names_listed); ++k) {
        message += "\n  " + ridge_in_words(defects[k]);
        const std::vector<Entity> facets = names_.entities(defects[k].cells);
        at_fault.insert(at_fault.end(), facets.begin(), facets.end());
    }
    message += is_input_ ? "\nClose it there, or turn facets round; slabhull convert --weld TOLERANCE joins "
                           "vertices that are "
                           "only nearly in one place"
                         : "";
    refuse(message, std::move(at_fault));
}

/// Number of facets of a closed surface in the fan around `vertex`, from one of them. Cannot exceed the
/// number of facets.
Index fan_size(const Surface<3>& surface, const Adjacency<2>& adjacency, Index start, Index vertex) {
    Index facet = start;
    Index size = 0;
    do {
        const auto& corners = surface.facets[facet];
        const auto place = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
        facet = adjacency.neighbors[facet][static_cast<std::size_t>((place + 1) % 3)];
        ++size;
    } while (facet != start && size < surface.facets.size());
    return size;
}

template<int D>
void BoundaryInspection<D>::require_fans(const Adjacency<D - 1>& adjacency) const {
    std::vector<Index> facets_at(surface_.points.size(), 0);
    std::vector<Index> one_at(surface_.points.size(), 0);
    for (Index f = 0; f < surface_.facets.size(); ++f) {
        for (const Index v : surface_.facets[f]) {
            ++facets_at[v];
            one_at[v] = f;
        }
    }
    for (Index v = 0; v < surface_.points.size(); ++v) {
        if (fan_size(surface_, adjacency, one_at[v], v) != facets_at[v]) {
            refuse(fmt::format("parts of the boundary touch in one point, the vertex at {}, {} being at it; "
                               "move them apart or give each a vertex of its own",
                               place_in_words(surface_.points[v]), names_.facet(one_at[v])),
                   {{"vertex", v, ""}, names_.entity(one_at[v])});
        }
    }
}

template<int D>
void BoundaryInspection<D>::require_no_crossings() const {
    constexpr std::size_t counted = 1000;
    const std::vector<Crossing<D>> crossings = find_crossings(surface_, counted);
    if (crossings.empty()) {
        return;
    }
    std::string message = fmt::format("the boundary crosses or touches itself in {}{} pairs of facets",
                                      crossings.size() == counted ? "at least " : "", crossings.size());
    std::vector<Entity> at_fault;
    for (std::size_t k = 0; k < std::min(crossings.size(), names_listed); ++k) {
        const Crossing<D>& pair = crossings[k];
        message += fmt::format("\n  {} and {} cross near {}", names_.facet(pair.first),
                               names_.facet(pair.second), place_in_words(pair.near));
        at_fault.push_back(names_.entity(pair.first));
        at_fault.push_back(names_.entity(pair.second));
    }
    message += is_input_ ? "\nPart them, or make them one surface; slabhull convert --weld TOLERANCE joins "
                           "vertices that are in "
                           "one place, or nearly"
                         : "";
    refuse(message, std::move(at_fault));
}

/// The domain must lie on the inner side of each component. Seen from a component, the winding number of the
/// others must be 1 if it bounds a body, and 0 if it is an outer boundary.
template<int D>
void BoundaryInspection<D>::require_nesting(const FacetComponents<D>& components) const {
    const std::vector<double> enclosed = enclosed_by_components(components, surface_);
    std::optional<BoxTree<D>> tree; // not needed for one component
    for (Index part = 0; part < enclosed.size(); ++part) {
        const Index facet = components.first_facet(part);
        int winding = 0;
        if (enclosed.size() > 1) {
            if (!tree) {
                tree.emplace(facet_boxes(surface_));
            }
            const Point<D>& place = surface_.points[surface_.facets[facet][0]];
            winding = winding_number<D>(surface_, *tree, place,
                                        [&](Index other) { return components.component(other) != part; });
        }
        judge_component(components, facet, enclosed, winding);
    }
}

/// The box of the facets that `takes` takes: "(0, 0, 1) to (2, 3, 4)".
template<int D>
template<class Takes>
std::string BoundaryInspection<D>::extent_in_words(const Takes& takes) const {
    Box<D> box;
    for (Index f = 0; f < surface_.facets.size(); ++f) {
        if (takes(f)) {
            for (const Index v : surface_.facets[f]) {
                box.include(surface_.points[v]);
            }
        }
    }
    return fmt::format("{} to {}", place_in_words(box.low), place_in_words(box.high));
}

/// Where a body that is outside the domain is, and what to do about it.
template<int D>
std::string BoundaryInspection<D>::whereabouts(const FacetComponents<D>& components, Index part,
                                               const std::vector<double>& enclosed) const {
    const std::string own = extent_in_words([&](Index f) { return components.component(f) == part; });
    const std::string outer = extent_in_words([&](Index f) { return enclosed[components.component(f)] > 0; });
    return fmt::format(
        "; it extends from {}, the outer boundary from {}. Move it or change the outer boundary; if they "
        "are in different units, slabhull convert --scale changes those of a surface",
        own, outer);
}

/// `facet`: the first of the component; `winding`: winding number of the other components around it.
template<int D>
void BoundaryInspection<D>::judge_component(const FacetComponents<D>& components, Index facet,
                                            const std::vector<double>& enclosed, int winding) const {
    const Index part = components.component(facet);
    const bool outer = enclosed[part] > 0;
    const bool any_outer = std::any_of(enclosed.begin(), enclosed.end(), [](double e) { return e > 0; });
    if (winding == (outer ? 0 : 1)) {
        return;
    }
    const std::string which =
        fmt::format("the closed part of the boundary with {} at {}", names_.facet(facet),
                    place_in_words(surface_.points[surface_.facets[facet][0]]));
    std::string fault;
    if (outer) {
        fault =
            winding > 0
                ? "lies inside the domain but is oriented like an outer boundary; if it bounds a body, turn "
                  "its facets round, else two outer boundaries overlap"
                : "is an outer boundary inside a body that is itself outside the domain";
    } else if (!any_outer) {
        fault =
            "is oriented inwards and no outer boundary surrounds it; turn its facets round or add the box";
    } else if (winding <= 0) {
        fault =
            "bounds a body that lies outside the domain: outside the outer boundary, or inside another body" +
            (is_input_ ? whereabouts(components, part, enclosed) : std::string{});
    } else {
        fault = "bounds a body that lies inside several outer boundaries at once";
    }
    refuse(which + " " + fault, {names_.entity(facet)});
}

} // namespace

template<int D>
void require_domain_boundary(const Surface<D>& surface, const FacetNaming& naming, bool is_input) {
    BoundaryInspection<D>{surface, naming, is_input}.run();
}

template<int D>
void require_domain_boundary(const Boundary<D>& boundary, const Surface<D>& surface,
                             const FacetNaming& naming) {
    BoundaryInspection<D>{surface, naming, false}.run_places(boundary);
}

template void require_domain_boundary<2>(const Boundary<2>&, const Surface<2>&, const FacetNaming&);
template void require_domain_boundary<3>(const Boundary<3>&, const Surface<3>&, const FacetNaming&);
template void require_domain_boundary<2>(const Surface<2>&, const FacetNaming&, bool);
template void require_domain_boundary<3>(const Surface<3>&, const FacetNaming&, bool);

} // namespace slabhull
