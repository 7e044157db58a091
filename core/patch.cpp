// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/patch.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

std::string patch_name(const PatchList& patches, PatchNumber number) {
    for (const Patch& patch : patches) {
        if (patch.number == number && !patch.name.empty()) {
            return patch.name;
        }
    }
    return fmt::format("patch {}", number);
}

PatchNumber patch_number(const PatchList& patches, std::string_view name) {
    for (const Patch& patch : patches) {
        if (patch.name == name) {
            return patch.number;
        }
    }
    return 0;
}

std::string group_name(const PatchList& groups, std::int64_t number) {
    const auto found = std::find_if(groups.begin(), groups.end(),
                                    [number](const Patch& group) { return group.number == number; });
    return found == groups.end() || found->name.empty() ? fmt::format("{}", number) : found->name;
}

std::vector<PatchNumber> patch_numbers(const PatchList& patches, std::string_view name) {
    std::vector<PatchNumber> numbers;
    for (const Patch& patch : patches) {
        if (group_name({patch}, patch.number) == name) {
            numbers.push_back(patch.number);
        }
    }
    return numbers;
}

} // namespace slabhull
