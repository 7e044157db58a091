// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/check.h"

#include <cstddef>
#include <optional>

namespace slabhull {

/// How a hull was examined for crossings. The crossings themselves are findings.
struct EmbeddingSummary {
    std::size_t crossings = 0; ///< pairs of cells; at least so many unless `all_listed`
    bool all_listed = true;
    bool caps_proven = false;     ///< embedded as a whole, so that only the side's cells were tested
    std::size_t tested_cells = 0; ///< that were tested
    std::size_t stars = 0;        ///< of cells around vertices
    std::size_t proven_stars = 0; ///< as a whole
    std::size_t group_pairs = 0;  ///< of groups of cells that do not touch
    std::size_t tested_pairs = 0; ///< of cells: of stars and groups that were not proven as a whole
    std::size_t exact_pairs = 0;  ///< of those: left to rational arithmetic
};

/// Checks that a hull crosses itself nowhere, see examine_embedding(), and adds what it finds to `report`,
/// that of check_hull() for the same columns and options (which says whether the neighbor_table can be relied
/// on): a self_crossing for each pair of cells, by number,
/// region or patch, and with the place and time where they meet. Cells without extent are degenerate_cell
/// there already. Nothing, and a line among the skipped checks, when cells or coordinates are not fit for
/// geometry. The same when facets are not in two cells that agree, unless `torn` hulls are to be examined,
/// too: that takes all pairs of cells whose boxes meet, minutes where a sound hull takes seconds.
template<int D>
std::optional<EmbeddingSummary> check_embedding(const HullColumns<D>& hull, const CheckOptions& options,
                                                HullReport& report, bool torn = true);

} // namespace slabhull
