// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/soup_faults.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <set>

namespace fuzz {

using namespace slabhull;

namespace {

std::size_t size_of(const io::DataArray& array) {
    return std::visit([](const auto& values) { return values.size(); }, array.values);
}

std::string fault_of_points(const io::Soup& soup) {
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        for (const double x : soup.points[i]) {
            if (!std::isfinite(x)) {
                return fmt::format("point {} has the coordinate {}", i, x);
            }
        }
    }
    const bool tagged = soup.point_tags.empty() || soup.point_tags.size() == soup.points.size();
    return tagged ? "" : fmt::format("{} tags of {} points", soup.point_tags.size(), soup.points.size());
}

std::string fault_of_list(const PatchList& groups) {
    for (std::size_t i = 0; i < groups.size(); ++i) {
        if (groups[i].number <= 0 || (i > 0 && groups[i].number <= groups[i - 1].number)) {
            return fmt::format("group number {} is {}", i, groups[i].number);
        }
    }
    return {};
}

std::string fault_of_groups(const io::SimplexBlock& block, const PatchList& groups) {
    for (const PatchNumber number : std::set<PatchNumber>(block.physical.begin(), block.physical.end())) {
        const bool listed = number == 0 || std::any_of(groups.begin(), groups.end(), [=](const Patch& group) {
                                return group.number == number;
                            });
        if (!listed) {
            return fmt::format("group {} is not listed", number);
        }
    }
    return fault_of_list(groups);
}

std::string fault_of_block(const io::Soup& soup, int dimension) {
    const io::SimplexBlock& block = soup.simplices[static_cast<std::size_t>(dimension)];
    const std::size_t size = block.size(dimension);
    if (block.vertices.size() != size * static_cast<std::size_t>(dimension + 1)) {
        return fmt::format("{} vertices in dimension {}", block.vertices.size(), dimension);
    }
    const auto missing = std::find_if(block.vertices.begin(), block.vertices.end(),
                                      [&](Index vertex) { return vertex >= soup.points.size(); });
    if (missing != block.vertices.end()) {
        return fmt::format("a simplex of dimension {} has the vertex {} of {}", dimension, *missing,
                           soup.points.size());
    }
    for (const std::size_t length : {block.physical.size(), block.entity.size(), block.tags.size()}) {
        if (length != 0 && length != size) {
            return fmt::format("{} groups, entities or tags of {} simplices of dimension {}", length, size,
                               dimension);
        }
    }
    return fault_of_groups(block, soup.groups[static_cast<std::size_t>(dimension)]);
}

/// Arrays of as many rows, or of any whole number of them.
std::string fault_of_arrays(const std::vector<io::DataArray>& arrays, std::size_t rows, bool any_rows) {
    for (const io::DataArray& array : arrays) {
        const std::size_t size = size_of(array);
        const auto width = static_cast<std::size_t>(std::max(array.components, 1));
        if (array.components < 1 || size % width != 0 || (!any_rows && size / width != rows)) {
            return fmt::format("array \"{}\" has {} values of {} components for {} rows", array.name, size,
                               array.components, rows);
        }
    }
    return {};
}

template<class T>
bool same_bits(const Array<T>& a, const Array<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Rows of several texts become rows of one.
bool same(const io::DataArray& a, const io::DataArray& b) {
    const bool is_text = std::holds_alternative<std::vector<std::string>>(a.values);
    if (a.name != b.name || a.values.index() != b.values.index() ||
        (a.components != b.components && !is_text)) {
        return false;
    }
    return std::visit(
        [&b](const auto& values) {
            using Values = std::decay_t<decltype(values)>;
            if constexpr (std::is_same_v<Values, Array<double>>) {
                return same_bits(values, std::get<Values>(b.values));
            } else {
                return values == std::get<Values>(b.values);
            }
        },
        a.values);
}

/// Texts with zero bytes in them, which end texts in the files.
bool has_zero_bytes(const io::DataArray& array) {
    const auto* texts = std::get_if<std::vector<std::string>>(&array.values);
    return texts != nullptr && std::any_of(texts->begin(), texts->end(), [](const std::string& text) {
               return text.find('\0') != text.npos;
           });
}

/// Texts over points and cells are written by no format.
std::string difference_of(const std::vector<io::DataArray>& before, const std::vector<io::DataArray>& after,
                          bool texts) {
    auto place = after.begin();
    for (const io::DataArray& array : before) {
        const bool is_text = std::holds_alternative<std::vector<std::string>>(array.values);
        const bool left_out = (is_text && !texts) || has_zero_bytes(array);
        if (left_out || array.name == "padding") { // the VTU writer's own
            continue;
        }
        place = std::find_if(place, after.end(), [&](const auto& other) { return same(array, other); });
        if (place == after.end()) {
            return fmt::format("array \"{}\" does not come back", array.name);
        }
    }
    return {};
}

} // namespace

std::string fault_of(const io::Soup& soup) {
    std::string fault = fault_of_points(soup);
    for (int dimension = 0; dimension < 4 && fault.empty(); ++dimension) {
        fault = fault_of_block(soup, dimension);
    }
    const int top = soup.top_dimension();
    if (fault.empty()) {
        fault = fault_of_arrays(soup.point_data, soup.points.size(), false);
    }
    if (fault.empty()) {
        fault =
            fault_of_arrays(soup.cell_data, soup.simplices[static_cast<std::size_t>(top)].size(top), false);
    }
    return fault.empty() ? fault_of_arrays(soup.field_data, 0, true) : fault;
}

std::string fault_of(const io::CsvTable& table) {
    if (table.values.size() != table.rows() * table.columns.size()) {
        return fmt::format("{} values in {} rows", table.values.size(), table.rows());
    }
    if (std::set<std::string>(table.columns.begin(), table.columns.end()).size() != table.columns.size()) {
        return "two columns have one name";
    }
    const bool finite =
        std::all_of(table.values.begin(), table.values.end(), [](double x) { return std::isfinite(x); });
    const bool ascending = std::is_sorted(table.lines.begin(), table.lines.end());
    return !finite ? "a value is no finite number" : ascending ? "" : "lines do not ascend";
}

std::string fault_of(const io::SpaceTimeSoup& soup) {
    if (soup.dimension != 3 && soup.dimension != 4) {
        return fmt::format("dimension {}", soup.dimension);
    }
    const auto width = static_cast<std::size_t>(soup.dimension);
    const std::size_t points = soup.points.size() / width;
    const auto exists = [points](Index vertex) { return vertex < points; };
    if (soup.points.size() % width != 0 || soup.cells.size() % (width + 1) != 0 ||
        soup.facets.size() % width != 0 || soup.facet_attribute.size() != soup.facets.size() / width) {
        return "rows that are not whole";
    }
    if (!std::all_of(soup.cells.begin(), soup.cells.end(), exists) ||
        !std::all_of(soup.facets.begin(), soup.facets.end(), exists)) {
        return "a vertex that does not exist";
    }
    const bool finite =
        std::all_of(soup.points.begin(), soup.points.end(), [](double x) { return std::isfinite(x); });
    return finite ? "" : "a coordinate is no finite number";
}

std::string difference(const io::Soup& before, const io::Soup& after, Compared what) {
    const int top = before.top_dimension();
    const auto d = static_cast<std::size_t>(top);
    if (!same_bits(before.points, after.points)) {
        return "points do not come back bit for bit";
    }
    if (before.simplices[d].vertices != after.simplices[d].vertices) {
        return "cells do not come back";
    }
    if (what.groups && before.simplices[d].physical != after.simplices[d].physical) {
        return "groups do not come back";
    }
    std::string text = what.point_data ? difference_of(before.point_data, after.point_data, false) : "";
    if (text.empty() && what.cell_data) {
        text = difference_of(before.cell_data, after.cell_data, false);
    }
    return text.empty() && what.field_data ? difference_of(before.field_data, after.field_data, true) : text;
}

} // namespace fuzz
