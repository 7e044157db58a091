// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/communicator.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/hull_part.h"

#include <optional>

namespace slabhull {

/// Checks a hull whose parts are on ranks: what check_hull() checks, with the same report on every rank, to
/// the last bit of its sums, but without Betti numbers. Each rank checks its own cells, and the stars of the
/// vertices that it owns with one layer of ghosts; no rank has the whole. If anything is wrong, the hull is
/// gathered on the first rank, whose check_hull() says what: its findings name cells and vertices of the
/// whole hull, and only the first rank has them; the others know how many there are of each kind. Collective.
/// For hulls without changes of the boundary's connectivity. Cost: near-linear in the part; memory some 60
/// bytes per cell of it for a while.
template<int D>
HullReport check_parts(const HullPart<D>& part, const HullOrder<D>& order, Communicator& ranks,
                       const CheckOptions& options = {});

/// The report of check_parts() when nothing is wrong, whatever claims there are; else nothing. `claims` are
/// those of the part's cells (region, patch, layer), the patches and the slab's time. Collective; the same on
/// all ranks.
template<int D>
std::optional<HullReport> confirm_parts(const HullPart<D>& part, const HullColumns<D>& claims,
                                        Communicator& ranks);

/// The whole hull on the first rank, from the parts of all; elsewhere one without cells. Collective. Throws
/// LimitError when it is too large for 32-bit indices.
template<int D>
Hull<D> gather_hull(const HullPart<D>& part, const HullOrder<D>& order, Communicator& ranks);

} // namespace slabhull
