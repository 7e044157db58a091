// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/patch.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

namespace {

std::string name_or_number(const Patch& patch) {
    return patch.name.empty() ? fmt::format("{}", patch.number) : patch.name;
}

} // namespace

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
    return found == groups.end() ? fmt::format("{}", number) : name_or_number(*found);
}

std::vector<PatchNumber> patch_numbers(const PatchList& patches, std::string_view name) {
    std::vector<PatchNumber> numbers;
    for (const Patch& patch : patches) {
        if (name_or_number(patch) == name) {
            numbers.push_back(patch.number);
        }
    }
    return numbers;
}

} // namespace slabhull
