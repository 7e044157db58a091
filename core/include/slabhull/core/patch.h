// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull {

/// Number of a boundary part: positive; 0 means "no patch" (cap cells).
using PatchNumber = std::int32_t;

struct Patch {
    PatchNumber number = 0;
    std::string name;
    friend bool operator==(const Patch&, const Patch&) = default;
};

/// The patches of a boundary, by ascending number.
using PatchList = std::vector<Patch>;

/// Name of a patch, or its number in words when it has none.
std::string patch_name(const PatchList& patches, PatchNumber number);
/// Number of the first patch called `name`, or 0.
PatchNumber patch_number(const PatchList& patches, std::string_view name);
/// What a patch or group is called: its name or, where it has none, its number.
std::string group_name(const PatchList& groups, std::int64_t number);
/// The numbers of all patches in the list that are called `name`: files may name several groups alike.
std::vector<PatchNumber> patch_numbers(const PatchList& patches, std::string_view name);

} // namespace slabhull
