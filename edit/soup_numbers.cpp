// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/edit/soup_numbers.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <unordered_map>

namespace slabhull {

namespace {

using io::DataArray;
using Numbers = IntegerList;

constexpr std::int64_t largest_patch = std::numeric_limits<PatchNumber>::max();

DataArray* find_array(std::vector<DataArray>& arrays, const std::string& name) {
    const auto found = std::find_if(arrays.begin(), arrays.end(),
                                    [&](const DataArray& array) { return array.name == name; });
    return found == arrays.end() ? nullptr : &*found;
}

/// The integers of an array with one component; nullptr when there is no such array.
Numbers* numbers(std::vector<DataArray>& arrays, const std::string& name) {
    DataArray* array = find_array(arrays, name);
    return array == nullptr || array->components != 1 ? nullptr : std::get_if<Numbers>(&array->values);
}

void erase_array(std::vector<DataArray>& arrays, const std::string& name) {
    std::erase_if(arrays, [&](const DataArray& array) { return array.name == name; });
}

io::SimplexBlock& top_block(io::Soup& soup) {
    return soup.simplices[static_cast<std::size_t>(soup.top_dimension())];
}

PatchList& top_groups(io::Soup& soup) {
    return soup.groups[static_cast<std::size_t>(soup.top_dimension())];
}

// --- numbers

/// Makes an array of reals one of integers when all of them are whole numbers.
void make_whole(DataArray* array) {
    const auto* reals = array == nullptr ? nullptr : std::get_if<Array<double>>(&array->values);
    constexpr double widest = 9007199254740992.0; // 2^53
    if (reals == nullptr || !std::all_of(reals->begin(), reals->end(), [=](double x) {
            return std::abs(x) <= widest && x == std::trunc(x);
        })) {
        return;
    }
    array->values = Numbers::generated(reals->size(),
                                       [&](std::size_t k) { return static_cast<std::int64_t>((*reals)[k]); });
}

/// From element tags to numbers from 0.
class CellOfTag {
public:
    CellOfTag(const io::Soup& soup, const io::SimplexBlock& block) : soup_{soup} {
        for (std::size_t c = 0; c < block.tags.size(); ++c) {
            cell_[block.tags[c]] = static_cast<std::int64_t>(c);
        }
    }
    /// 0 stands for none.
    std::int64_t operator()(std::int64_t tag, const std::string& array) const {
        if (tag == 0) {
            return -1;
        }
        const auto found = cell_.find(tag);
        if (found == cell_.end()) {
            throw InputError{
                fmt::format("{}: array \"{}\" names cell {}, which does not exist", soup_.path, array, tag)};
        }
        return found->second;
    }

private:
    const io::Soup& soup_;
    std::unordered_map<std::int64_t, std::int64_t> cell_;
};

std::string neighbor_name(std::size_t i) {
    return fmt::format("neighbor_{}", i);
}

bool names_cells_by_tags(io::Soup& soup) {
    bool all = !top_block(soup).tags.empty();
    for (std::size_t i = 0; i <= static_cast<std::size_t>(soup.top_dimension()); ++i) {
        all = all && numbers(soup.cell_data, neighbor_name(i)) != nullptr;
    }
    return all;
}

void join_neighbors(io::Soup& soup, const CellOfTag& cell_of) {
    const auto width = static_cast<std::size_t>(soup.top_dimension()) + 1;
    const std::size_t cells = top_block(soup).tags.size();
    std::vector<std::string> names;
    std::vector<const Numbers*> tags;
    for (std::size_t i = 0; i < width; ++i) {
        names.push_back(neighbor_name(i));
        tags.push_back(numbers(soup.cell_data, names[i]));
    }
    Numbers joined = Numbers::generated(cells * width, [&](std::size_t k) {
        return cell_of((*tags[k % width])[k / width], names[k % width]);
    });
    DataArray& first = *find_array(soup.cell_data, neighbor_name(0));
    first = {"neighbors", static_cast<int>(width), std::move(joined)};
    for (std::size_t i = 1; i < width; ++i) {
        erase_array(soup.cell_data, names[i]);
    }
}

// --- groups

void list_patches(io::Soup& soup, const PatchList& patches) {
    Numbers given;
    std::vector<std::string> names;
    for (const Patch& patch : patches) {
        given.push_back(patch.number);
        names.push_back(patch.name);
    }
    soup.field_data.push_back({"patch_number", 1, std::move(given)});
    soup.field_data.push_back({"patch_name", 1, std::move(names)});
}

bool has_groups(const io::SimplexBlock& block) {
    return std::any_of(block.physical.begin(), block.physical.end(),
                       [](PatchNumber number) { return number != 0; });
}

/// The points of a hull in 2D+t say its time as their last coordinate.
void add_time(io::Soup& soup) {
    if (soup.top_dimension() != 2 || soup.find_point_data("t") != nullptr) {
        return;
    }
    Array<double> times;
    for (const Point<3>& point : soup.points) {
        times.push_back(point[2]);
    }
    soup.point_data.insert(soup.point_data.begin(), {"t", 1, std::move(times)});
}

/// Whether groups can say the same: with regions, two numbers are for the caps.
bool expressible(const Numbers& patch, const Numbers* region, std::int64_t largest) {
    if (largest > largest_patch - (region == nullptr ? 0 : 2)) {
        return false;
    }
    for (std::size_t c = 0; c < patch.size(); ++c) {
        const std::int64_t where = region == nullptr ? 1 : (*region)[c];
        if (patch[c] < 0 || where < 0 || where > 2 || (where != 1 && patch[c] != 0)) {
            return false;
        }
    }
    return true;
}

} // namespace

PatchList listed_patches(const io::Soup& soup) {
    const io::DataArray* numbers = soup.find_field_data("patch_number");
    const io::DataArray* names = soup.find_field_data("patch_name");
    const auto* given = numbers == nullptr ? nullptr : std::get_if<Numbers>(&numbers->values);
    const auto* texts = names == nullptr ? nullptr : std::get_if<std::vector<std::string>>(&names->values);
    PatchList patches;
    for (std::size_t i = 0; given != nullptr && texts != nullptr && i < given->size(); ++i) {
        if ((*given)[i] > 0 && (*given)[i] <= largest_patch) {
            patches.push_back({static_cast<PatchNumber>((*given)[i]), i < texts->size() ? (*texts)[i] : ""});
        }
    }
    return patches;
}

void settle_numbers(io::Soup& soup) {
    for (const char* name : {"vertex_id", "track_id", "cell"}) {
        make_whole(find_array(soup.point_data, name));
    }
    for (const char* name : {"region", "patch", "layer", "neighbors", "hull_cell"}) {
        make_whole(find_array(soup.cell_data, name));
    }
    for (std::size_t i = 0; i < 4; ++i) {
        make_whole(find_array(soup.cell_data, neighbor_name(i)));
    }
    if (!names_cells_by_tags(soup)) {
        return;
    }
    const CellOfTag cell_of{soup, top_block(soup)};
    join_neighbors(soup, cell_of);
    if (Numbers* cell = numbers(soup.point_data, "cell")) {
        *cell = Numbers::generated(cell->size(), [&](std::size_t v) { return cell_of((*cell)[v], "cell"); });
    }
}

void number_by_tags(io::Soup& soup) {
    const auto raise = [](Numbers& values) {
        values = Numbers::generated(values.size(), [&](std::size_t k) { return values[k] + 1; });
    };
    DataArray* neighbors = find_array(soup.cell_data, "neighbors");
    if (neighbors == nullptr || !std::holds_alternative<Numbers>(neighbors->values)) {
        return;
    }
    neighbors->name = "neighbor";
    raise(std::get<Numbers>(neighbors->values));
    if (Numbers* cell = numbers(soup.point_data, "cell")) {
        raise(*cell);
    }
}

void groups_to_arrays(io::Soup& soup) {
    io::SimplexBlock& block = top_block(soup);
    PatchList& groups = top_groups(soup);
    if (!has_groups(block) || find_array(soup.cell_data, "patch") != nullptr ||
        find_array(soup.cell_data, "region") != nullptr) {
        return;
    }
    Array<std::int64_t> patch(block.physical.begin(), block.physical.end());
    const PatchNumber initial = patch_number(groups, "initial");
    const PatchNumber terminating = patch_number(groups, "terminating");
    if (terminating != 0) {
        Numbers region;
        for (std::int64_t& group : patch) {
            const bool cap = group == initial || group == terminating;
            region.push_back(!cap ? 1 : group == initial ? 0 : 2);
            group = cap ? 0 : group;
        }
        std::erase_if(groups, [=](const Patch& group) {
            return group.number == initial || group.number == terminating;
        });
        soup.cell_data.insert(soup.cell_data.begin(), {"region", 1, std::move(region)});
        add_time(soup);
    }
    soup.cell_data.push_back({"patch", 1, Numbers{std::move(patch)}});
    list_patches(soup, groups);
    groups.clear();
    block.physical.clear();
}

void arrays_to_groups(io::Soup& soup) {
    io::SimplexBlock& block = top_block(soup);
    const Numbers* patch = numbers(soup.cell_data, "patch");
    const Numbers* region = numbers(soup.cell_data, "region");
    if (has_groups(block) || patch == nullptr || patch->empty()) {
        return;
    }
    PatchList patches = listed_patches(soup);
    std::int64_t largest = *std::max_element(patch->begin(), patch->end());
    for (const Patch& each : patches) {
        largest = std::max<std::int64_t>(largest, each.number);
    }
    if (!expressible(*patch, region, largest)) {
        return;
    }
    const auto initial = region == nullptr ? 0 : static_cast<PatchNumber>(largest + 1);
    const auto terminating = region == nullptr ? 0 : static_cast<PatchNumber>(largest + 2);
    block.physical.resize(patch->size());
    for (std::size_t c = 0; c < patch->size(); ++c) {
        const std::int64_t where = region == nullptr ? 1 : (*region)[c];
        block.physical[c] = where == 1   ? static_cast<PatchNumber>((*patch)[c])
                            : where == 0 ? initial
                                         : terminating;
    }
    if (region != nullptr) {
        patches.push_back({initial, "initial"});
        patches.push_back({terminating, "terminating"});
    }
    top_groups(soup) = std::move(patches);
    for (const char* name : {"patch", "region"}) {
        erase_array(soup.cell_data, name);
    }
    for (const char* name : {"patch_number", "patch_name"}) {
        erase_array(soup.field_data, name);
    }
}

} // namespace slabhull
