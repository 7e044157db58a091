// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/size_field.h"

#include "slabhull/core/vector.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace slabhull {

namespace {

/// Largest depth of the tree: beyond it the digits of a double are used up, whatever the ratio of sizes.
constexpr int max_depth = 48;

} // namespace

/// Builds the boxes depth first. Each box inherits from its parent only the sources that may give the minimum
/// in some part of it. So the lists shrink with the boxes: distant, coarse sources are discarded for a whole
/// subtree at once.
template<int D>
class SizeField<D>::Builder {
public:
    explicit Builder(SizeField& field) : field_{field}, growth_{field.grading_.growth} {}

    void build() {
        candidates_.resize(field_.sources_.size());
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            for (std::size_t k = 0; k < D; ++k) {
                candidates_.at[k][i] = field_.sources_[i].at[k];
            }
            candidates_.spacing[i] = field_.sources_[i].spacing;
            candidates_.index[i] = static_cast<Index>(i);
        }
        field_.boxes_.assign(1, Box{});
        fill(0, field_.centre(), field_.edge_ / 2, 0, candidates_.size(), 0);
    }

private:
    /// A stack: the lists of all boxes on the current path. Each coordinate is a list of its own, so that
    /// several candidates are measured at once.
    struct Candidates {
        std::array<Array<double>, D> at;
        Array<double> spacing;
        Array<Index> index;

        std::size_t size() const { return index.size(); }
        /// Does not clear what is added.
        void resize(std::size_t size) {
            for (Array<double>& along : at) {
                along.resize(size);
            }
            spacing.resize(size);
            index.resize(size);
        }
        void copy(std::size_t from, std::size_t to) {
            for (Array<double>& along : at) {
                along[to] = along[from];
            }
            spacing[to] = spacing[from];
            index[to] = index[from];
        }
    };

    /// Fills the box with this centre and half edge, given the candidates [begin, end) of its parent.
    void fill(Index box, const Point<D>& centre, double half, std::size_t begin, std::size_t end, int depth) {
        const double radius = half * std::sqrt(static_cast<double>(D));
        const double sway = growth_ * radius;
        const std::size_t best = find_best(centre, begin, end);
        if (best == end || values_[best - begin] > field_.grading_.largest + sway) {
            return; // `largest` is the minimum in the whole box
        }
        const double least = values_[best - begin];
        const Index ruler = candidates_.index[best];
        if (depth == max_depth || 2 * sway <= leaf_excess * std::min(least, field_.grading_.largest)) {
            field_.boxes_[box].source = ruler; // most boxes: their rivals need no list
            return;
        }
        const std::size_t kept = candidates_.size();
        keep_rivals(begin, end, least, sway);
        if (candidates_.size() == kept + 1) {
            field_.boxes_[box].source = ruler;
        } else {
            split(box, centre, half, kept, depth);
        }
        candidates_.resize(kept);
    }

    void split(Index box, const Point<D>& centre, double half, std::size_t kept, int depth) {
        const std::size_t end = candidates_.size();
        const Index first = checked_index(field_.boxes_.size(), "boxes of a size field");
        checked_index(first + fan, "boxes of a size field");
        field_.boxes_[box].children = first;
        field_.boxes_.resize(first + fan, Box{});
        for (std::size_t child = 0; child < fan; ++child) {
            fill(first + static_cast<Index>(child), child_centre(centre, half, child), half / 2, kept, end,
                 depth + 1);
        }
    }

    /// The candidate with the least spacing at `centre`, or `end`; leaves the spacings in values_.
    std::size_t find_best(const Point<D>& centre, std::size_t begin, std::size_t end) {
        find_values(centre, begin, end);
        const auto values = std::span{values_}.first(end - begin);
        const double least = least_of(values);
        if (!(least < std::numeric_limits<double>::infinity())) {
            return end;
        }
        return begin +
               static_cast<std::size_t>(std::find(values.begin(), values.end(), least) - values.begin());
    }

    /// Of several lists in turn, so that no comparison waits for the one before.
    static double least_of(std::span<const double> values) {
        constexpr std::size_t lists = 8;
        std::array<double, lists> least;
        least.fill(std::numeric_limits<double>::infinity());
        const std::size_t whole = values.size() / lists * lists;
        for (std::size_t i = 0; i < whole; i += lists) {
            for (std::size_t k = 0; k < lists; ++k) {
                least[k] = values[i + k] < least[k] ? values[i + k] : least[k];
            }
        }
        for (std::size_t i = whole; i < values.size(); ++i) {
            least[i - whole] = values[i] < least[i - whole] ? values[i] : least[i - whole];
        }
        return *std::min_element(least.begin(), least.end());
    }

    /// A loop of its own, without a branch and with the centre as a copy, so that compilers use vector
    /// instructions.
    void find_values(Point<D> centre, std::size_t begin, std::size_t end) {
        values_.resize(std::max(values_.size(), end - begin));
        std::array<const double*, D> at;
        for (std::size_t k = 0; k < D; ++k) {
            at[k] = candidates_.at[k].data() + begin;
        }
        const double* const spacing = candidates_.spacing.data() + begin;
        double* const values = values_.data();
        const double growth = growth_;
        for (std::size_t i = 0; i < end - begin; ++i) {
            double square = 0;
            for (std::size_t k = 0; k < D; ++k) {
                square += (at[k][i] - centre[k]) * (at[k][i] - centre[k]);
            }
            values[i] = spacing[i] + growth * std::sqrt(square);
        }
    }

    /// Appends the candidates that may give the minimum in some part of a box across which a spacing varies
    /// by `sway` either way.
    void keep_rivals(std::size_t begin, std::size_t end, double best, double sway) {
        const double bound = std::min(best + 2 * sway, field_.grading_.largest + sway);
        std::size_t next = candidates_.size();
        candidates_.resize(next + (end - begin));
        for (std::size_t i = begin; i < end; ++i) {
            if (values_[i - begin] <= bound) {
                candidates_.copy(i, next++);
            }
        }
        candidates_.resize(next);
    }

    /// An excess e over the spacing at a leaf's centre is an excess e / (1 - e / 2) over h(x): here
    /// `tolerance`.
    static constexpr double leaf_excess = tolerance / (1 + tolerance / 2);

    SizeField& field_;
    double growth_;
    Candidates candidates_;
    std::vector<double> values_;
};

/// Copies the boxes of a tree that meet some given ones, and the sources of their leaves.
template<int D>
class SizeField<D>::PartMaker {
public:
    PartMaker(const SizeField& whole, std::span<const std::array<Point<D>, 2>> wanted)
        : whole_{whole}, wanted_{wanted}, slack_{1e-9 * whole.edge_} {
        number_.assign(whole.sources_.size(), no_index);
        for (const double x : whole.corner_) {
            slack_ = std::max(slack_, 1e-14 * std::abs(x)); // centroids are rounded
        }
    }

    SizeField run() {
        part_.grading_ = whole_.grading_;
        part_.corner_ = whole_.corner_;
        part_.edge_ = whole_.edge_;
        part_.boxes_.assign(1, Box{});
        copy(0, 0, whole_.centre(), whole_.edge_ / 2);
        return std::move(part_);
    }

private:
    void copy(Index from, Index to, const Point<D>& centre, double half) {
        if (!is_wanted(centre, half)) {
            return;
        }
        const Box& box = whole_.boxes_[from];
        if (box.children == no_index) {
            part_.boxes_[to].source = number_of(box.source);
            return;
        }
        const Index first = checked_index(part_.boxes_.size(), "boxes of a size field");
        part_.boxes_[to].children = first;
        part_.boxes_.resize(first + fan, Box{});
        for (std::size_t child = 0; child < fan; ++child) {
            const auto place = static_cast<Index>(child);
            copy(box.children + place, first + place, child_centre(centre, half, child), half / 2);
        }
    }

    bool is_wanted(const Point<D>& centre, double half) const {
        return std::any_of(wanted_.begin(), wanted_.end(), [&](const std::array<Point<D>, 2>& box) {
            for (std::size_t k = 0; k < D; ++k) {
                if (centre[k] - half > box[1][k] + slack_ || centre[k] + half < box[0][k] - slack_) {
                    return false;
                }
            }
            return true;
        });
    }

    Index number_of(Index source) {
        if (source == no_index) {
            return no_index;
        }
        if (number_[source] == no_index) {
            number_[source] = static_cast<Index>(part_.sources_.size());
            part_.sources_.push_back(whole_.sources_[source]);
        }
        return number_[source];
    }

    const SizeField& whole_;
    std::span<const std::array<Point<D>, 2>> wanted_;
    Array<Index> number_; ///< of sources, in the part
    double slack_;
    SizeField part_;
};

template<int D>
SizeField<D> SizeField<D>::part_within(std::span<const std::array<Point<D>, 2>> boxes) const {
    return PartMaker{*this, boxes}.run();
}

template<int D>
SizeField<D>::SizeField(std::span<const Point<D>> points, std::span<const double> spacing,
                        const Grading& grading)
    : grading_{grading} {
    if (points.empty()) {
        boxes_.assign(1, Box{});
        return;
    }
    Point<D> low = points[0];
    Point<D> high = points[0];
    sources_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t k = 0; k < D; ++k) {
            low[k] = std::min(low[k], points[i][k]);
            high[k] = std::max(high[k], points[i][k]);
        }
        sources_.push_back({points[i], spacing[i]});
    }
    corner_ = low;
    for (std::size_t k = 0; k < D; ++k) {
        edge_ = std::max(edge_, high[k] - low[k]);
    }
    Builder{*this}.build();
}

template<int D>
SizeField<D>::SizeField(const Packed& packed, std::span<const std::byte> lists)
    : grading_{packed.grading}, corner_{packed.corner}, edge_{packed.edge} {
    sources_.resize(packed.source_bytes / sizeof(Source));
    boxes_.resize(packed.box_bytes / sizeof(Box));
    // A part far from all sources has none: its empty list has no memory that bytes could go to.
    std::ranges::copy(lists.first(packed.source_bytes), std::as_writable_bytes(std::span{sources_}).begin());
    std::ranges::copy(lists.subspan(packed.source_bytes, packed.box_bytes),
                      std::as_writable_bytes(std::span{boxes_}).begin());
}

template<int D>
Index SizeField<D>::leaf_at(const Point<D>& x) const {
    // The binary digits of x, in units of the finest box, are the path down the tree.
    constexpr auto finest = static_cast<double>(std::uint64_t{1} << max_depth);
    std::array<std::uint64_t, D> place;
    for (std::size_t k = 0; k < D; ++k) {
        const double along = edge_ > 0 ? (x[k] - corner_[k]) / edge_ * finest : 0.0;
        place[k] = static_cast<std::uint64_t>(std::min(std::max(0.0, along), finest - 1));
    }
    Index box = 0;
    for (int level = max_depth - 1; boxes_[box].children != no_index; --level) {
        Index child = 0;
        for (std::size_t k = 0; k < D; ++k) {
            child |= static_cast<Index>((place[k] >> level) & 1) << k;
        }
        box = boxes_[box].children + child;
    }
    return box;
}

template<int D>
double SizeField<D>::operator()(const Point<D>& x) const {
    return in_leaf(leaf_at(x), x);
}

template<int D>
double SizeField<D>::in_leaf(Index box, const Point<D>& x) const {
    const Index ruler = boxes_[box].source;
    if (ruler == no_index) {
        return grading_.largest;
    }
    const Source& source = sources_[ruler];
    return std::min(grading_.largest, source.spacing + grading_.growth * distance<D>(source.at, x));
}

template<int D>
Point<D> SizeField<D>::centre() const {
    Point<D> middle = corner_;
    for (double& x : middle) {
        x += edge_ / 2;
    }
    return middle;
}

template<int D>
Point<D> SizeField<D>::child_centre(const Point<D>& centre, double half, std::size_t child) {
    Point<D> middle = centre;
    for (std::size_t k = 0; k < D; ++k) {
        middle[k] += ((child >> k) & 1) != 0 ? half / 2 : -half / 2;
    }
    return middle;
}

template<int D>
double SizeField<D>::cube_count() const {
    return cube_count(0, centre(), edge_ / 2);
}

template<int D>
double SizeField<D>::cube_count(Index box, const Point<D>& centre, double half) const {
    double sum = 0;
    if (boxes_[box].children == no_index) {
        const double cubes = 2 * half / in_leaf(box, centre);
        sum = cubes * cubes;
        for (int k = 2; k < D; ++k) {
            sum *= cubes;
        }
        return sum;
    }
    for (std::size_t child = 0; child < fan; ++child) {
        sum += cube_count(boxes_[box].children + static_cast<Index>(child), child_centre(centre, half, child),
                          half / 2);
    }
    return sum;
}

template<int D>
std::vector<double> boundary_spacing(std::span<const Point<D>> points, std::span<const Facet<D>> facets) {
    std::vector<double> sum(points.size(), 0.0);
    std::vector<Index> count(points.size(), 0);
    for (const Facet<D>& facet : facets) {
        for (std::size_t i = 0; i < D; ++i) {
            for (std::size_t j = 0; j < D; ++j) {
                if (i != j) {
                    sum[facet[i]] += distance<D>(points[facet[i]], points[facet[j]]);
                    ++count[facet[i]];
                }
            }
        }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
        sum[v] = count[v] > 0 ? sum[v] / count[v] : std::numeric_limits<double>::infinity();
    }
    return sum;
}

template class SizeField<2>;
template class SizeField<3>;
template std::vector<double> boundary_spacing<2>(std::span<const Point<2>>, std::span<const Facet<2>>);
template std::vector<double> boundary_spacing<3>(std::span<const Point<3>>, std::span<const Facet<3>>);

} // namespace slabhull
