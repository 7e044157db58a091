// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace slabhull {

/// How fast the spacing grows away from the boundary, and its maximum.
struct Grading {
    double growth = 0.3; ///< increase of the spacing per unit of distance
    double largest = std::numeric_limits<double>::infinity();
};

/// Wanted spacing h(x) inside a domain, from the spacing of its boundary:
/// h(x) = min(largest, min over boundary points y of h_y + growth |x - y|).
///
/// A tree of boxes (quadtree, octree), each about as large as the spacing in it, stores in each leaf the
/// boundary point that gives the minimum at its centre. So a value is never below h(x), at most `tolerance`
/// times h(x) above it (in practice a few per cent), and equal to it where one boundary point gives the
/// minimum on a whole leaf. Outside the box of the boundary points, the leaf nearest to x is used. Cost:
/// building is near-linear in the number of boxes; a query is a descent of the tree.
template<int D>
class SizeField {
public:
    /// Largest relative excess over h(x) in the box of the boundary points.
    static constexpr double tolerance = 0.5;

    /// `spacing`: one per point, positive. Without points h is `largest` everywhere.
    SizeField(std::span<const Point<D>> points, std::span<const double> spacing, const Grading& grading);

    double operator()(const Point<D>& x) const;

    /// The field as bytes, for another process of this program: a heading, and two lists.
    struct Packed {
        Grading grading;
        Point<D> corner{};
        double edge = 0;
        std::uint64_t source_bytes = 0;
        std::uint64_t box_bytes = 0;
    };
    Packed packed() const { return {grading_, corner_, edge_, source_bytes().size(), box_bytes().size()}; }
    std::span<const std::byte> source_bytes() const { return std::as_bytes(std::span{sources_}); }
    std::span<const std::byte> box_bytes() const { return std::as_bytes(std::span{boxes_}); }
    /// The field that was packed so; `lists` are its sources and boxes, one after the other.
    SizeField(const Packed& packed, std::span<const std::byte> lists);

    /// The field for places in some boxes, given by their lowest and highest corners: there it says what the
    /// whole does. Elsewhere it may say `largest`. Cost: a descent of the tree for each box.
    SizeField part_within(std::span<const std::array<Point<D>, 2>> boxes) const;

    std::size_t box_count() const { return boxes_.size(); }

    /// The integral of h^-D over the box of the points: the number of cubes of the wanted size that fill it.
    double cube_count() const;

private:
    static constexpr std::size_t fan = std::size_t{1} << D;
    struct Source {
        Point<D> at;
        double spacing;
    };
    struct Box {
        Index children = no_index; ///< the first of 2^D in a row, or no_index for a leaf
        Index source = no_index;   ///< source of a leaf's spacing; no_index: `largest`
    };
    class Builder;
    class PartMaker;

    SizeField() = default;

    Index leaf_at(const Point<D>& x) const;
    double in_leaf(Index box, const Point<D>& x) const;
    Point<D> centre() const;
    double cube_count(Index box, const Point<D>& centre, double half) const;
    static Point<D> child_centre(const Point<D>& centre, double half, std::size_t child);

    Grading grading_;
    Point<D> corner_{};
    double edge_ = 0;
    Array<Source> sources_;
    Array<Box> boxes_;
};

/// Spacing of each vertex of a boundary: the mean length of the facet edges at it; infinite for a vertex in
/// no facet.
template<int D>
std::vector<double> boundary_spacing(std::span<const Point<D>> points, std::span<const Facet<D>> facets);

extern template class SizeField<2>;
extern template class SizeField<3>;

} // namespace slabhull
