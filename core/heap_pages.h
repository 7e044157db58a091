// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace slabhull::detail {

/// Grows the heap of this process by so many bytes of addresses, for which it gets huge pages: where a
/// library allocates many small blocks, touching fresh memory then costs much less. For a process that ends
/// soon, since the heap does not shrink any more. What is not touched costs nothing, and later growth has
/// small pages. Does nothing with another C library, or where memory is refused.
void grow_heap_in_huge_pages(std::size_t bytes) noexcept;

} // namespace slabhull::detail
