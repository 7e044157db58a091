// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace slabhull {

/// The files of which a page is made, as they are in view/page; the build puts them into the program.
struct PageParts {
    std::string_view frame; ///< page.html: what is around the others
    std::string_view style;
    std::string_view script;
};
const PageParts& page_parts();

/// three.js with its controls, from Debian's package. Throws UsageError in a build without it.
std::string_view page_library();

} // namespace slabhull
