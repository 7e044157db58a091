// SPDX-License-Identifier: BSD-3-Clause
#include "view/page_parts.h"

namespace slabhull {

namespace embedded {
extern const std::string_view three;
} // namespace embedded

std::string_view page_library() {
    return embedded::three;
}

} // namespace slabhull
