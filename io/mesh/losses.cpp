// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/formats.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace slabhull::io {

namespace {

bool is_text(const DataArray& array) {
    return std::holds_alternative<std::vector<std::string>>(array.values);
}

template<class Is>
std::string names_of(const std::vector<DataArray>& arrays, const Is& is) {
    std::string names;
    for (const DataArray& array : arrays) {
        if (array.name != "padding" && is(array)) { // added by the VTU writer
            names += (names.empty() ? "" : ", ") + array.name;
        }
    }
    return names;
}

std::string joined(const std::string& a, const std::string& b) {
    return a.empty() || b.empty() ? a + b : a + ", " + b;
}

bool is_wide(const DataArray& array) {
    constexpr std::int64_t widest = std::int64_t{1} << 53;
    const auto* values = std::get_if<IntegerList>(&array.values);
    return values != nullptr && std::any_of(values->begin(), values->end(), [](std::int64_t value) {
               return value > widest || value < -widest;
           });
}

/// Whether components are stored as separate arrays; readers rejoin "neighbors".
bool is_taken_apart(const DataArray& array) {
    const bool reals = std::holds_alternative<Array<double>>(array.values);
    return array.components > 1 && !(reals && (array.components == 3 || array.components == 9)) &&
           array.name != "neighbors" && array.name != "neighbor";
}

bool stores_lower(const FormatFeatures& features, int top, int dimension) {
    return features.min_lower_dimension && dimension >= *features.min_lower_dimension &&
           (!features.only_facets || dimension == top - 1);
}

std::string lower_simplices(const FormatFeatures& features, const Soup& soup) {
    constexpr std::array<const char*, 4> kinds{"points", "lines", "triangles", "tetrahedra"};
    std::string text;
    for (int dimension = soup.top_dimension() - 1; dimension >= 0; --dimension) {
        const auto d = static_cast<std::size_t>(dimension);
        const std::size_t count = soup.simplices[d].size(dimension);
        if (count > 0 && !stores_lower(features, soup.top_dimension(), dimension)) {
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kinds[d]);
        }
    }
    return text;
}

std::string group_names(const Soup& soup) {
    std::set<std::string> names;
    for (const PatchList& groups : soup.groups) {
        for (const Patch& group : groups) {
            names.insert(group.name);
        }
    }
    names.erase("");
    return fmt::format("{}", fmt::join(names, ", "));
}

/// Whether some cells of the top dimension are in groups, and some are not.
bool has_cells_apart(const Soup& soup) {
    const auto& physical = soup.simplices[static_cast<std::size_t>(soup.top_dimension())].physical;
    const auto apart = std::count(physical.begin(), physical.end(), 0);
    return apart > 0 && static_cast<std::size_t>(apart) < physical.size();
}

std::string single_precision(const Soup& soup) {
    const bool fits = std::all_of(soup.points.begin(), soup.points.end(), [](const Point<3>& point) {
        return std::all_of(point.begin(), point.end(),
                           [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
    });
    return fits ? "" : "coordinates beyond single precision";
}

/// Whether the cells use all points, and first use them in the order of their numbers.
bool points_by_cells(const Soup& soup) {
    Index next = 0;
    for (const Index vertex : soup.simplices[static_cast<std::size_t>(soup.top_dimension())].vertices) {
        if (vertex > next) {
            return false;
        }
        next += vertex == next ? 1 : 0;
    }
    return next == soup.points.size();
}

/// Whether the numbers are neither absent nor first, first + 1, ... with `first` 0 or 1.
bool is_irregular(const Array<std::int64_t>& tags) {
    if (tags.empty() || tags[0] < 0 || tags[0] > 1) {
        return !tags.empty();
    }
    for (std::size_t i = 0; i < tags.size(); ++i) {
        if (tags[i] != tags[0] + static_cast<std::int64_t>(i)) {
            return true;
        }
    }
    return false;
}

/// Whether some group has cells of several geometric entities.
bool has_entities(const Soup& soup) {
    for (const SimplexBlock& block : soup.simplices) {
        std::set<std::int32_t> groups(block.physical.begin(), block.physical.end());
        std::set<std::int32_t> entities(block.entity.begin(), block.entity.end());
        if (entities.size() > std::max<std::size_t>(1, groups.size())) {
            return true;
        }
    }
    return false;
}

bool has_groups(const Soup& soup) {
    return std::any_of(soup.groups.begin(), soup.groups.end(),
                       [](const PatchList& groups) { return !groups.empty(); });
}

} // namespace

bool stores(const Format& format, const Soup& soup, ArrayAssociation association, const DataArray& array,
            const WriteOptions& options) {
    const FormatFeatures& features = format.features;
    if (association != ArrayAssociation::field && is_text(array)) {
        return false;
    }
    if (features.stores_array != nullptr) {
        return features.stores_array(soup, association, array, options);
    }
    return association == ArrayAssociation::points  ? features.point_data
           : association == ArrayAssociation::cells ? features.cell_data
                                                    : features.field_data;
}

std::vector<std::string> losses(const Format& format, const Soup& soup, const WriteOptions& options) {
    const FormatFeatures& features = format.features;
    std::vector<std::string> lost;
    const auto lose = [&lost](const std::string& what, const std::string& names) {
        if (!names.empty()) {
            lost.push_back(what + names);
        }
    };
    const auto not_stored = [&](ArrayAssociation association) {
        return [&, association](const DataArray& array) {
            return !stores(format, soup, association, array, options);
        };
    };
    const auto of_points_and_cells = [&](const auto& is) {
        const auto stored = [&](ArrayAssociation association) {
            return [&, association](const DataArray& array) {
                return is(array) && stores(format, soup, association, array, options);
            };
        };
        return joined(names_of(soup.point_data, stored(ArrayAssociation::points)),
                      names_of(soup.cell_data, stored(ArrayAssociation::cells)));
    };
    lose("", lower_simplices(features, soup));
    if (!features.groups) {
        lose("", has_groups(soup) ? "groups of cells" : "");
    } else if (!features.group_names) {
        lose("names of groups: ", group_names(soup));
    }
    lose("", features.groups && !features.ungrouped_cells && has_cells_apart(soup)
                 ? "that cells are in no group"
                 : "");
    lose("point data ", names_of(soup.point_data, not_stored(ArrayAssociation::points)));
    lose("cell data ", names_of(soup.cell_data, not_stored(ArrayAssociation::cells)));
    lose("field data ", names_of(soup.field_data, not_stored(ArrayAssociation::field)));
    lose("digits above 2^53 in ", features.wide_integers ? "" : of_points_and_cells(is_wide));
    lose("components in one array, as of ",
         features.any_components ? "" : of_points_and_cells(is_taken_apart));
    lose("", features.double_precision ? "" : single_precision(soup));
    lose("", features.shared_points || points_by_cells(soup) ? "" : "the order of points");
    return lost;
}

std::vector<std::string> lost_numbers(const Soup& soup) {
    std::vector<std::string> lost;
    if (has_entities(soup)) {
        lost.emplace_back("geometric entities");
    }
    if (is_irregular(soup.point_tags)) {
        lost.emplace_back("the file's own point numbers");
    }
    if (is_irregular(soup.simplices[static_cast<std::size_t>(soup.top_dimension())].tags)) {
        lost.emplace_back("the file's own cell numbers");
    }
    return lost;
}

} // namespace slabhull::io
