// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace slabhull {

/// How the prism over a moving boundary facet is split into simplices.
enum class Split {
    diagonal, ///< D = 2: two triangles
    centre,   ///< D = 2: four triangles around the centre of the quadrilateral
    C,        ///< D = 3: ten tetrahedra, a cone from one face centre; all face centres
    E,        ///< D = 3: fourteen tetrahedra, a cone from the prism's centre; all face centres
};

/// The split called `name` in dimension D. Throws UsageError naming those that there are.
Split split_from_name(std::string_view name, int dimension);
std::string_view split_name(Split split);

/// Points of a prism over a facet with D vertices, in local numbers.
///
///        D+2 ------- D+1        bottom corners 0 .. D-1: the facet at the earlier time
///         | \       / |         top corners    D .. 2D-1: corner D + i above corner i
///         |    D     |          face centres  2D .. 3D-1: 2D + i of the lateral face opposite to corner i
///         |    |     |                                    (D = 3 only: for D = 2 lateral faces are edges)
///         2 ---|---- 1          centre        3D
///           \  |  /
///              0
template<int D>
struct PrismPoint {
    static constexpr int bottom(int i) { return i; }
    static constexpr int top(int i) { return D + i; }
    static constexpr int face_centre(int i) { return 2 * D + i; }
    static constexpr int centre = 3 * D;
    static constexpr int count = 3 * D + 1;
};

/// What a lateral face (opposite to corner i) carries, so that two prisms that share it agree. For the corners
/// j < k of the facet's edge: a centre, the diagonal bottom j - top k ("rising") or bottom k - top j ("falling").
enum class LateralFace : std::uint8_t { centred, rising, falling };

/// A way to fill a prism with simplices, in local numbers.
template<int D>
struct PrismTemplate {
    using Cell = std::array<std::uint8_t, D + 1>;
    /// Ordered so that, for an outward oriented facet, each simplex's normal points out of the slab.
    std::vector<Cell> cells;
};

/// The template that is the cone from `apex` over the triangulated boundary of the prism: every split of the method is
/// one (A and the diagonal from a corner, B and C from a face centre, D and E from the prism's centre).
/// Needs: an apex such that the prism's faces at it are triangulated from it: a corner at which the diagonals of both
/// its lateral faces end, the centre of a centred face, or the prism's centre.
template<int D>
PrismTemplate<D> cone_template(int apex, const std::array<LateralFace, D>& lateral);

/// Number of simplices that `split` makes of a prism.
int simplices_per_prism(Split split);

/// Which extra points a split needs: a centre for each lateral face of a layer, a centre for each prism.
struct SplitPoints {
    bool face_centres;
    bool prism_centres;
};
SplitPoints points_of(Split split);

/// The template of `split` for a prism whose facet's vertices have the given ranks: 0 for the smallest id (the diagonal
/// starts at its vertex of smallest id; the other splits do not look).
template<int D>
const PrismTemplate<D>& template_of(Split split, const std::array<PersistentId, D>& ids);

extern template PrismTemplate<2> cone_template<2>(int, const std::array<LateralFace, 2>&);
extern template PrismTemplate<3> cone_template<3>(int, const std::array<LateralFace, 3>&);
extern template const PrismTemplate<2>& template_of<2>(Split, const std::array<PersistentId, 2>&);
extern template const PrismTemplate<3>& template_of<3>(Split, const std::array<PersistentId, 3>&);

} // namespace slabhull
