// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"

#include <cstddef>

namespace slabhull {

/// The next persistent id to give out; a march holds one.
struct IdCounter {
    PersistentId next = 0;
    PersistentId take(std::size_t count) {
        const PersistentId first = next;
        next += static_cast<PersistentId>(count);
        return first;
    }
};

} // namespace slabhull
