// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"

#include <fmt/format.h>
#include <string>
#include <string_view>

namespace slabhull {

/// Names of a hull's caps, so not of patches: a file tells patches and caps apart by their names.
inline bool is_patch_name(std::string_view name) {
    return !name.empty() && name != "initial" && name != "terminating";
}

constexpr const char* patch_name_rule =
    "a patch's name, which is neither empty nor \"initial\" or \"terminating\", as hulls call their caps";

/// For names that come from a file.
inline void require_patch_name(const std::string& name, const std::string& path) {
    if (!is_patch_name(name)) {
        throw InputError(fmt::format("{}: a part is called \"{}\"; rename it: expected was {}", path, name,
                                     patch_name_rule));
    }
}

} // namespace slabhull
