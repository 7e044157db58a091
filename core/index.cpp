// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/index.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>

namespace slabhull {

Index checked_index(std::size_t count, const char* what) {
    if (count >= no_index) {
        throw LimitError(
            fmt::format("{} {} are more than the {} that one mesh can hold", count, what, no_index - 1));
    }
    return static_cast<Index>(count);
}

} // namespace slabhull
