// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mixed_cells.h"

#include "io/files/utf8.h"
#include "slabhull/core/error.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <set>

namespace slabhull::io {

namespace {

using Integers = IntegerList;
using Texts = std::vector<std::string>;

const Integers* integers(const DataArray* array) {
    return array == nullptr || array->components != 1 ? nullptr : std::get_if<Integers>(&array->values);
}

const Integers* find_groups(const Soup& soup, const std::string& wanted) {
    if (!wanted.empty()) {
        const Integers* found = integers(soup.find_cell_data(wanted));
        if (found == nullptr) {
            std::string known;
            for (const DataArray& array : soup.cell_data) {
                known += (known.empty() ? "" : ", ") + readable(array.name);
            }
            throw InputError(
                fmt::format("{}: there is no array \"{}\" of one integer for each cell; arrays over "
                            "cells are: {}",
                            soup.path, wanted, known.empty() ? "none" : known));
        }
        return found;
    }
    for (const char* name : {"gmsh:physical", "medit:ref", "patch"}) {
        if (const Integers* found = integers(soup.find_cell_data(name))) {
            return found;
        }
    }
    return nullptr;
}

std::map<std::int64_t, std::string> names_of_patches(const Soup& soup) {
    std::map<std::int64_t, std::string> names;
    const Integers* numbers = integers(soup.find_field_data("patch_number"));
    const DataArray* array = soup.find_field_data("patch_name");
    const Texts* texts = array == nullptr ? nullptr : std::get_if<Texts>(&array->values);
    for (std::size_t i = 0;
         numbers != nullptr && texts != nullptr && i < std::min(numbers->size(), texts->size()); ++i) {
        names[(*numbers)[i]] = as_utf8((*texts)[i]);
    }
    return names;
}

PatchNumber as_group(std::int64_t value) {
    return value > 0 && value <= std::numeric_limits<PatchNumber>::max() ? static_cast<PatchNumber>(value)
                                                                         : 0;
}

/// Remarks on numbers that are no group's.
void remark_on_numbers(Soup& soup, const Integers& groups) {
    const auto is_none = [](std::int64_t value) { return value != 0 && as_group(value) == 0; };
    const auto count = std::count_if(groups.begin(), groups.end(), is_none);
    if (count > 0) {
        soup.remarks.push_back(fmt::format("{}: {} cells have group numbers that are negative or above {}, "
                                           "the first {}; they count as in no "
                                           "group",
                                           soup.path, count, std::numeric_limits<PatchNumber>::max(),
                                           *std::find_if(groups.begin(), groups.end(), is_none)));
    }
}

void give_groups(Soup& soup, const Integers& groups) {
    remark_on_numbers(soup, groups);
    const auto names = names_of_patches(soup);
    for (std::size_t d = 0; d < soup.simplices.size(); ++d) {
        SimplexBlock& block = soup.simplices[d];
        std::set<PatchNumber> used;
        for (std::size_t i = 0; i < block.size(static_cast<int>(d)); ++i) {
            block.physical.push_back(as_group(groups[static_cast<std::size_t>(block.tag(i))]));
            used.insert(block.physical.back());
        }
        used.erase(0);
        for (const PatchNumber number : used) {
            const auto name = names.find(number);
            soup.groups[d].push_back({number, name == names.end() ? "" : name->second});
        }
    }
}

} // namespace

void settle_equal_cells(Soup& soup, const std::string& patch_array) {
    if (!patch_array.empty()) {
        give_groups(soup, *find_groups(soup, patch_array));
    }
}

void settle_mixed_cells(Soup& soup, const std::string& patch_array) {
    if (const Integers* groups = find_groups(soup, patch_array)) {
        give_groups(soup, *groups);
    }
    const auto& tags = soup.simplices[static_cast<std::size_t>(soup.top_dimension())].tags;
    const Array<Index> rows(tags.begin(), tags.end());
    for (DataArray& array : soup.cell_data) {
        array.keep_rows(rows);
    }
}

} // namespace slabhull::io
