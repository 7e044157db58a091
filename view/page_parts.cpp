// SPDX-License-Identifier: BSD-3-Clause
#include "view/page_parts.h"

namespace slabhull {

namespace embedded {
extern const std::string_view frame;
extern const std::string_view style;
extern const std::string_view script;
} // namespace embedded

const PageParts& page_parts() {
    static const PageParts parts{embedded::frame, embedded::style, embedded::script};
    return parts;
}

} // namespace slabhull
