// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/patch.h"

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

} // namespace slabhull
