// SPDX-License-Identifier: BSD-3-Clause
#include "view/page_parts.h"

#include "slabhull/core/error.h"

namespace slabhull {

std::string_view page_library() {
    throw UsageError{"this build has no three.js, which draws the page: install Debian's libjs-three and "
                     "configure with -DSLABHULL_THREE=ON"};
}

} // namespace slabhull
