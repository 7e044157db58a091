// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <array>

namespace slabhull::detail {

/// Old numbers of what stays, in the new order.
using Order = Array<Index>;

/// From old numbers to new ones, no_index for what is gone.
Array<Index> inverse(const Order& order, std::size_t count);

/// The integers of the array of that name; nullptr when there is none.
Array<std::int64_t>* whole_numbers(std::vector<io::DataArray>& arrays, const std::string& name,
                                   int components = 1);
const Array<std::int64_t>* whole_numbers(const std::vector<io::DataArray>& arrays, const std::string& name,
                                         int components = 1);

/// Puts the rows of arrays in another order.
void pick_rows(std::vector<io::DataArray>& arrays, const Order& order);

/// Keeps these cells of each dimension; neighbors and the cells of points are renumbered.
void keep_cells(io::Soup& soup, const std::array<Order, 4>& orders);
/// Keeps these points. Needs: all points that cells use are among them.
void keep_points(io::Soup& soup, const Order& order);
/// Keeps the points that cells use.
void drop_unused_points(io::Soup& soup);
/// Gives each point whose "cell" does not use it another one, or -1.
void mend_cells_of_points(io::Soup& soup);

} // namespace slabhull::detail
