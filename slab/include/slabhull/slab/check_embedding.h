// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/communicator.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/hull_part.h"

#include <cstddef>
#include <optional>

namespace slabhull {

/// How a hull was examined for crossings. The crossings themselves are findings.
struct EmbeddingSummary {
    std::size_t crossings = 0; ///< pairs of cells; a lower bound unless `all_listed`
    bool all_listed = true;
    bool caps_proven = false;     ///< each cap is embedded, so only the side's cells were tested
    std::size_t tested_cells = 0; ///< cells tested for crossings
    std::size_t stars = 0;        ///< stars of vertices that were examined
    std::size_t proven_stars = 0; ///< stars proven without testing pairs
    std::size_t group_pairs = 0;  ///< pairs of groups of cells that do not touch
    std::size_t tested_pairs = 0; ///< pairs of cells, in stars and groups that were not proven as a whole
    std::size_t exact_pairs = 0;  ///< pairs of these that needed rational arithmetic
};

/// Checks that a hull crosses itself nowhere, see examine_embedding(), and adds what it finds to `report`: a
/// self_crossing for each pair of cells, by number, region or patch, with the place and time where they meet.
/// `report` is that of check_hull() for the same columns and options, which says whether the neighbor_table
/// can be relied on. Cells without extent are degenerate_cell there already. If cells or coordinates are
/// unfit for geometry, the check is listed as skipped. The same holds if facets are not in two cells that
/// agree, unless `torn`: then all pairs of cells whose boxes meet are tested, in minutes where a sound hull
/// takes seconds.
template<int D>
std::optional<EmbeddingSummary> check_embedding(const HullColumns<D>& hull, const CheckOptions& options,
                                                HullReport& report, bool torn = true);

/// The same of a hull whose parts are on ranks, in which check_parts() has found nothing: `report` is its
/// report. Each rank examines its own cells and those of later ranks that may meet them; all get the same
/// findings, in numbers of the whole hull, and the same summary. Collective.
template<int D>
EmbeddingSummary check_embedding_of_parts(const HullPart<D>& part, const HullOrder<D>& order,
                                          Communicator& ranks, const CheckOptions& options,
                                          HullReport& report);

} // namespace slabhull
