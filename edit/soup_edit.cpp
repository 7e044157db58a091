// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/edit/soup_edit.h"

#include "edit/soup_cells.h"
#include "edit/soup_rows.h"
#include "slabhull/core/error.h"
#include "slabhull/edit/soup_numbers.h"
#include "slabhull/geometry/mesh_order.h"
#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/spatial_mesh.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>

namespace slabhull {

namespace {

using detail::Order;
using detail::whole_numbers;
using Numbers = IntegerList;

template<class Keep>
Order chosen(std::size_t count, const Keep& keep) {
    Order order;
    for (std::size_t i = 0; i < count; ++i) {
        if (keep(i)) {
            order.push_back(static_cast<Index>(i));
        }
    }
    return order;
}

Order in_group(const io::Soup& soup, std::size_t dimension, PatchNumber number) {
    const auto& physical = soup.simplices[dimension].physical;
    return chosen(physical.size(), [&](std::size_t i) { return number != 0 && physical[i] == number; });
}

Order with_number(const Numbers& values, std::int64_t number) {
    return chosen(values.size(), [&](std::size_t i) { return values[i] == number; });
}

/// The cells whose patches or groups, of whatever numbers, are called `name`. Adds what all are called to
/// `known`.
template<class Values>
Order called(const Values& numbers, const PatchList& patches, const std::string& name,
             std::set<std::string>& known) {
    std::map<std::int64_t, bool> wanted{{0, false}}; // by number; 0 is none
    const auto look_up = [&](std::int64_t number) {
        const auto [found, added] = wanted.try_emplace(number, false);
        if (added) {
            const std::string text = group_name(patches, number);
            found->second = text == name;
            known.insert(text);
        }
        return found->second;
    };
    for (const Patch& patch : patches) {
        look_up(patch.number);
    }
    return chosen(numbers.size(), [&](std::size_t i) { return look_up(numbers[i]); });
}

void keep_only(io::Soup& soup, const std::array<Order, 4>& orders, const std::string& what) {
    if (std::all_of(orders.begin(), orders.end(), [](const Order& order) { return order.empty(); })) {
        throw InputError{fmt::format("{}: has no cells {}", soup.path, what)};
    }
    detail::keep_cells(soup, orders);
    detail::drop_unused_points(soup);
    detail::mend_cells_of_points(soup);
}

// --- regions

Order side_by_groups(const io::Soup& soup, std::size_t top, PatchNumber initial, PatchNumber terminating) {
    const auto& physical = soup.simplices[top].physical;
    return chosen(physical.size(),
                  [&](std::size_t i) { return physical[i] != initial && physical[i] != terminating; });
}

Order cells_of_region(io::Soup& soup, std::size_t top, int region) {
    if (const Numbers* regions = whole_numbers(soup.cell_data, "region")) {
        return with_number(*regions, region);
    }
    const PatchNumber initial = patch_number(soup.groups[top], "initial");
    const PatchNumber terminating = patch_number(soup.groups[top], "terminating");
    if (initial == 0 || terminating == 0) {
        throw UsageError{fmt::format("--region: {} is not a hull with regions", soup.path)};
    }
    return region == 1 ? side_by_groups(soup, top, initial, terminating)
                       : in_group(soup, top, region == 0 ? initial : terminating);
}

// --- parts

constexpr std::int64_t initial_key = -1;
constexpr std::int64_t terminating_key = -2;

/// By cell: the number of its patch or group, 0 for none, or that of a cap.
std::vector<std::int64_t> part_keys(const io::Soup& soup, std::size_t dimension) {
    const io::SimplexBlock& block = soup.simplices[dimension];
    std::vector<std::int64_t> keys(block.physical.begin(), block.physical.end());
    keys.resize(block.size(static_cast<int>(dimension)));
    if (static_cast<int>(dimension) != soup.top_dimension()) {
        return keys;
    }
    if (const Numbers* patches = whole_numbers(soup.cell_data, "patch")) {
        keys.assign(patches->begin(), patches->end());
    }
    if (const Numbers* regions = whole_numbers(soup.cell_data, "region")) {
        for (std::size_t c = 0; c < keys.size(); ++c) {
            const std::int64_t region = (*regions)[c];
            keys[c] = region == 0 ? initial_key : region == 2 ? terminating_key : keys[c];
        }
    }
    return keys;
}

std::string part_name(const io::Soup& soup, std::size_t dimension, std::int64_t key) {
    if (key == initial_key || key == terminating_key) {
        return key == initial_key ? "initial" : "terminating";
    }
    PatchList patches = listed_patches(soup);
    patches.insert(patches.end(), soup.groups[dimension].begin(), soup.groups[dimension].end());
    const auto found = std::find_if(patches.begin(), patches.end(), [key](const Patch& patch) {
        return patch.number == key && !patch.name.empty();
    });
    return key == 0 ? "rest" : found == patches.end() ? fmt::format("patch_{}", key) : found->name;
}

// --- boundary

template<std::size_t N>
std::array<Index, N> sorted(std::array<Index, N> vertices) {
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

template<int D>
void require_distinct_vertices(const io::Soup& soup, std::span<const Simplex<D>> cells) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const auto vertices = sorted(cells[c]);
        if (std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end()) {
            throw InputError{fmt::format("{}: cell {} repeats a vertex; --weld 0 leaves such cells out",
                                         soup.path, soup.simplices[D].tag(c)),
                             {{"cell", soup.simplices[D].tag(c), ""}}};
        }
    }
}

template<int D>
struct Boundary {
    Array<Facet<D>> facets;
    Order cells; ///< the cell of each facet
};

template<int D>
Boundary<D> boundary_of(const io::Soup& soup) {
    const std::span<const Simplex<D>> cells = simplices_of<D>(soup);
    require_distinct_vertices<D>(soup, cells);
    const Adjacency<D> adjacency = build_adjacency<D>(cells, soup.points.size());
    std::set<Facet<D>> overfull;
    for (const FacetDefect<D>& defect : adjacency.defects) {
        if (defect.kind == FacetDefect<D>::Kind::overfull) {
            overfull.insert(defect.facet);
        }
    }
    Boundary<D> boundary;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            const Facet<D> facet = outward_facet<D>(cells[c], static_cast<int>(i));
            if (adjacency.neighbors[c][i] == no_index && !overfull.contains(sorted(facet))) {
                boundary.facets.push_back(facet);
                boundary.cells.push_back(static_cast<Index>(c));
            }
        }
    }
    return boundary;
}

/// The group of each facet: that of the same facet in the soup, else that of its cell.
template<int D>
std::vector<PatchNumber> groups_of_facets(const io::Soup& soup, const Boundary<D>& boundary) {
    const io::SimplexBlock& given = soup.simplices[D - 1];
    std::vector<PatchNumber> groups;
    if (given.vertices.empty()) {
        const auto& physical = soup.simplices[D].physical;
        for (std::size_t f = 0; f < boundary.cells.size() && !physical.empty(); ++f) {
            groups.push_back(physical[boundary.cells[f]]);
        }
        return groups;
    }
    std::map<Facet<D>, PatchNumber> group_of;
    for (std::size_t f = 0; f < given.physical.size(); ++f) {
        Facet<D> facet;
        std::copy_n(given.vertices.begin() + static_cast<std::ptrdiff_t>(f * D), D, facet.begin());
        group_of.try_emplace(sorted(facet), given.physical[f]);
    }
    for (const Facet<D>& facet : boundary.facets) {
        const auto found = group_of.find(sorted(facet));
        groups.push_back(found == group_of.end() ? 0 : found->second);
    }
    return groups;
}

template<int D>
void replace_by_boundary(io::Soup& soup) {
    const Boundary<D> boundary = boundary_of<D>(soup);
    if (boundary.facets.empty()) {
        throw InputError{fmt::format("{}: has no boundary: every facet is in two cells", soup.path)};
    }
    io::SimplexBlock facets;
    for (const Facet<D>& facet : boundary.facets) {
        facets.vertices.insert(facets.vertices.end(), facet.begin(), facet.end());
    }
    facets.physical = groups_of_facets<D>(soup, boundary);
    if (soup.simplices[D - 1].vertices.empty()) {
        soup.groups[D - 1] = soup.groups[D];
    }
    detail::pick_rows(soup.cell_data, boundary.cells);
    std::erase_if(soup.cell_data, [](const io::DataArray& array) { return array.name == "neighbors"; });
    soup.simplices = {};
    soup.simplices[D - 1] = std::move(facets);
    soup.groups[D].clear();
}

template<std::size_t D>
Order curve_order_of_cells(const io::Soup& soup) {
    const Array<Index>& vertices = soup.simplices[D].vertices;
    Array<Point<3>> centres;
    centres.assign(vertices.size() / (D + 1), {});
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            centres[i / (D + 1)][k] += soup.points[vertices[i]][k] / static_cast<double>(D + 1);
        }
    }
    return curve_order<3>(centres);
}

} // namespace

void select_region(io::Soup& soup, int region) {
    const auto top = static_cast<std::size_t>(soup.top_dimension());
    std::array<Order, 4> orders;
    orders[top] = cells_of_region(soup, top, region);
    constexpr std::array<const char*, 3> names{"initial", "side", "terminating"};
    keep_only(soup, orders, fmt::format("in the region \"{}\"", names.at(static_cast<std::size_t>(region))));
}

void select_patch(io::Soup& soup, const std::string& name) {
    const auto top = static_cast<std::size_t>(soup.top_dimension());
    std::set<std::string> known;
    std::array<Order, 4> orders;
    if (const Numbers* patches = whole_numbers(soup.cell_data, "patch")) {
        orders[top] = called(*patches, listed_patches(soup), name, known);
    }
    for (std::size_t d = 0; d < orders.size(); ++d) {
        Order in_groups = called(soup.simplices[d].physical, soup.groups[d], name, known);
        if (orders[d].empty()) {
            orders[d] = std::move(in_groups);
        }
    }
    if (!known.contains(name)) {
        throw UsageError{fmt::format("--patch: {} has no patch \"{}\"; it has {}", soup.path, name,
                                     known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")))};
    }
    keep_only(soup, orders, fmt::format("on the patch \"{}\"", name));
}

std::vector<SoupPart> parts_of(const io::Soup& soup) {
    std::vector<SoupPart> parts;
    std::map<std::string, std::size_t> place_of;
    const auto part_called = [&](const std::string& name) -> SoupPart& {
        const auto [found, added] = place_of.try_emplace(name, parts.size());
        if (added) {
            parts.push_back({name, {}});
        }
        return parts[found->second];
    };
    for (int dimension = soup.top_dimension(); dimension >= 0; --dimension) {
        const auto d = static_cast<std::size_t>(dimension);
        const std::vector<std::int64_t> keys = part_keys(soup, d);
        std::map<std::int64_t, std::string> names;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const auto [name, added] = names.try_emplace(keys[i]);
            if (added) {
                name->second = part_name(soup, d, keys[i]);
            }
            part_called(name->second).cells[d].push_back(static_cast<Index>(i));
        }
    }
    return parts;
}

void keep_part(io::Soup& soup, const SoupPart& part) {
    keep_only(soup, part.cells, fmt::format("in the part \"{}\"", part.name));
}

void extract_boundary(io::Soup& soup) {
    switch (soup.top_dimension()) {
    case 2:
        replace_by_boundary<2>(soup);
        break;
    case 3:
        replace_by_boundary<3>(soup);
        break;
    default:
        throw UsageError{
            fmt::format("--extract-boundary: {} has neither triangles nor tetrahedra", soup.path)};
    }
    if (Numbers* cell = whole_numbers(soup.point_data, "cell")) {
        *cell = IntegerList::generated(cell->size(), [](std::size_t) { return -1; });
    }
    detail::drop_unused_points(soup);
    detail::mend_cells_of_points(soup);
}

void renumber_along_curve(io::Soup& soup) {
    detail::keep_points(soup, curve_order<3>(soup.points));
    detail::keep_cells(soup, {curve_order_of_cells<0>(soup), curve_order_of_cells<1>(soup),
                              curve_order_of_cells<2>(soup), curve_order_of_cells<3>(soup)});
}

bool has_time_as_coordinate(const io::Soup& soup) {
    if (soup.top_dimension() != 2) {
        return false;
    }
    const Array<double>* times = soup_times(soup);
    if (times == nullptr) {
        return patch_number(soup.groups[2], "terminating") != 0;
    }
    return std::equal(times->begin(), times->end(), soup.points.begin(),
                      [](double t, const Point<3>& point) { return t == point[2]; });
}

void scale(io::Soup& soup, double factor) {
    const std::size_t axes = has_time_as_coordinate(soup) ? 2 : 3;
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        Point<3>& point = soup.points[i];
        for (std::size_t k = 0; k < axes; ++k) {
            point[k] *= factor;
            if (!std::isfinite(point[k])) {
                throw GeometryError{fmt::format("scaled by {}, point {} is beyond the largest number; give a "
                                                "smaller factor",
                                                factor, soup.point_tag(i)),
                                    {{"point", soup.point_tag(i), {}}}};
            }
        }
    }
}

bool drop_adaptation(io::Soup& soup) {
    return std::erase_if(soup.field_data, [](const io::DataArray& array) {
               return array.name == "adapt_settings" || array.name == "adapt_spacing";
           }) > 0;
}

void reverse(io::Soup& soup) {
    const auto swap_first_two = [](auto& values, std::size_t width) {
        for (std::size_t i = 0; i + width <= values.size(); i += width) {
            std::swap(values[i], values[i + 1]);
        }
    };
    for (std::size_t d = 1; d < soup.simplices.size(); ++d) {
        swap_first_two(soup.simplices[d].vertices, d + 1);
    }
    const int corners = soup.top_dimension() + 1;
    if (Numbers* neighbors = whole_numbers(soup.cell_data, "neighbors", corners)) {
        Array<std::int64_t> rows(neighbors->begin(), neighbors->end());
        swap_first_two(rows, static_cast<std::size_t>(corners));
        *neighbors = std::move(rows);
    }
}

} // namespace slabhull
