// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace slabhull {

/// How the prism over a moving boundary facet is split into simplices.
enum class Split {
    diagonal, ///< D = 2: two triangles
    centre,   ///< D = 2: four triangles around the centre of the quadrilateral
    A,        ///< D = 3: three tetrahedra; a diagonal in each quadrilateral
    B,        ///< D = 3: six, around the centre of the one quadrilateral shared with the prism's partner
    C,        ///< D = 3: ten, around the centre of a quadrilateral; all have centres
    D, ///< D = 3: twelve, around the prism's centre; a diagonal in the quadrilateral shared with the partner
    E, ///< D = 3: fourteen, around the prism's centre; all quadrilaterals have centres
};

/// Which diagonals are taken where a split leaves them free (B and D).
enum class Diagonals {
    shape, ///< the larger smallest dihedral angle of the simplices beside it; the smallest id where they are
           ///< equal
    smallest_id, ///< starting at the vertex of smallest id, as in split A
};

/// The split called `name` in dimension D. Throws UsageError that lists the known splits.
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

/// What the quadrilateral over an edge of the facet carries, for the edge's corners j < k: a centre, the
/// diagonal from bottom j to top k ("rising") or from bottom k to top j ("falling").
enum class Quad : std::uint8_t { centred, rising, falling };

/// The quadrilaterals of a prism, one over each edge of its facet. D = 3: number i is the lateral face
/// opposite to corner i. D = 2: number 0 is the prism itself.
template<int D>
using Quads = std::array<Quad, D*(D - 1) / 2>;

/// The corners j < k of the facet below quadrilateral q.
template<int D>
constexpr std::array<std::size_t, 2> quad_corners(std::size_t q) {
    return {D == 3 && q == 0 ? 1u : 0u, D == 2 || q == 2 ? 1u : 2u};
}

/// What defines a split: a cone from an apex over the boundary of the prism. The rest follows.
struct SplitRecipe {
    enum class Apex : std::uint8_t {
        corner,       ///< the bottom corner at which all diagonals of its quadrilaterals start
        face_centre,  ///< the centre of the first centred quadrilateral
        prism_centre, ///< the mean of all corners
    };
    enum class Carries : std::uint8_t { centre, diagonal };

    Split split;
    std::string_view name;
    int dimension;
    Apex apex;
    Carries shared; ///< what the quadrilateral between a prism and its partner carries
    Carries others; ///< and the others

    /// Whether each prism needs a partner: see perfect_matching(). Then the diagonals are free.
    bool pairs() const { return shared != others; }
};
const SplitRecipe& recipe_of(Split split);

/// A way to fill a prism with simplices, in local numbers.
template<int D>
struct PrismTemplate {
    using Cell = std::array<std::uint8_t, D + 1>;
    using Slots = std::array<std::uint8_t, D + 1>;

    /// Ordered so that, for an outward oriented facet, each simplex's normal points out of the slab.
    std::vector<Cell> cells;

    /// The facets on the outside of a prism have slots, so that two prisms find each other's: bottom, top,
    /// and up to four pieces of each lateral face. With two corners j < k below it (D = 3), piece 0 has the
    /// bottom edge, 1 the top edge, 2 (of four) the edge over j, 3 that over k.
    static constexpr std::uint8_t bottom = 0;
    static constexpr std::uint8_t top = 1;
    static constexpr std::uint8_t pieces = 4;
    static constexpr std::uint8_t lateral(std::size_t face, std::size_t piece) {
        return static_cast<std::uint8_t>(2 + pieces * face + piece);
    }
    static constexpr std::uint8_t slots = 2 + pieces * D;

    /// across[c][i] says what is across facet i of cell c: below `outside` that cell of the same prism, else
    /// the slot across[c][i] - outside.
    static constexpr std::uint8_t outside = 16;
    std::vector<Slots> across;
    /// The cell with the facet of each slot; `no_cell` for pieces that do not exist.
    static constexpr std::uint8_t no_cell = 0xFF;
    std::array<std::uint8_t, slots> cell_at;
};

/// The template that is the cone from `apex` over the triangulated boundary of the prism: every split of the
/// method is one. Adjacency is derived from the cells. Needs: an apex such that the prism's faces at it are
/// triangulated from it: a corner at which the diagonals of both its quadrilaterals end, the centre of a
/// centred one, or the prism's centre.
template<int D>
PrismTemplate<D> cone_template(int apex, const Quads<D>& quads);

/// Number of simplices that `split` makes of a prism.
int simplices_per_prism(Split split);

/// Place of a combination among the templates of a split.
template<int D>
constexpr std::uint8_t template_number(const Quads<D>& quads) {
    int number = 0;
    for (const Quad quad : quads) {
        number = 3 * number + static_cast<int>(quad);
    }
    return static_cast<std::uint8_t>(number);
}
/// The templates of `split` by template_number(). Impossible ones (A's diagonals in a cycle, say) have
/// no cells.
template<int D>
std::span<const PrismTemplate<D>> templates_of(Split split);

} // namespace slabhull
