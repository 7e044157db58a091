// SPDX-License-Identifier: BSD-3-Clause
// The prism splits of Anderson, Williams and Corrigan, section on hypersurface meshing, as cones. The paper's printed
// list for E covers each quadrilateral with both diagonals; this one does not (docs/architecture.md).
#include "slabhull/topology/prism_split.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace slabhull {

namespace {

struct SplitFacts {
    Split split;
    std::string_view name;
    int dimension;
    int simplices;
    SplitPoints points;
};

constexpr std::array<SplitFacts, 4> all_splits{{
    {Split::diagonal, "diagonal", 2, 2, {false, false}},
    {Split::centre, "centre", 2, 4, {false, true}},
    {Split::C, "C", 3, 10, {true, false}},
    {Split::E, "E", 3, 14, {true, true}},
}};

const SplitFacts& facts(Split split) {
    return *std::find_if(all_splits.begin(), all_splits.end(),
                         [split](const SplitFacts& known) { return known.split == split; });
}

template<int D>
using LocalFacet = std::array<std::uint8_t, D>;

template<int D>
using P = PrismPoint<D>;

/// The boundary of the prism as facets, unoriented.
template<int D>
std::vector<LocalFacet<D>> boundary_facets(const std::array<LateralFace, D>& lateral) {
    const auto local = [](int point) { return static_cast<std::uint8_t>(point); };
    LocalFacet<D> bottom;
    LocalFacet<D> top;
    for (int i = 0; i < D; ++i) {
        bottom[static_cast<std::size_t>(i)] = local(P<D>::bottom(i));
        top[static_cast<std::size_t>(i)] = local(P<D>::top(i));
    }
    std::vector<LocalFacet<D>> facets{bottom, top};
    for (int i = 0; i < D; ++i) {
        if constexpr (D == 2) {
            const int other = 1 - i;
            facets.push_back({local(P<D>::bottom(other)), local(P<D>::top(other))});
        } else {
            const int j = i == 0 ? 1 : 0;
            const int k = i == 2 ? 1 : 2;
            const std::array<std::uint8_t, 4> ring{local(P<D>::bottom(j)), local(P<D>::bottom(k)),
                                                   local(P<D>::top(k)), local(P<D>::top(j))};
            switch (lateral[static_cast<std::size_t>(i)]) {
            case LateralFace::centred:
                for (std::size_t side = 0; side < 4; ++side) {
                    facets.push_back({ring[side], ring[(side + 1) % 4], local(P<D>::face_centre(i))});
                }
                break;
            case LateralFace::rising:
                facets.push_back({ring[0], ring[1], ring[2]});
                facets.push_back({ring[0], ring[2], ring[3]});
                break;
            case LateralFace::falling:
                facets.push_back({ring[0], ring[1], ring[3]});
                facets.push_back({ring[1], ring[2], ring[3]});
                break;
            }
        }
    }
    return facets;
}

/// Reference position of a prism point times 12, so that all centres are integers: the facet is the unit simplex with
/// corner 0 at the origin, time the last coordinate.
template<int D>
std::array<long, D> reference_position(int point) {
    std::array<long, D> sum{};
    const auto add = [&sum](int corner, long weight) {
        const int foot = corner % D;
        if (foot > 0) {
            sum[static_cast<std::size_t>(foot - 1)] += weight;
        }
        sum[D - 1] += corner >= D ? weight : 0;
    };
    if (point < 2 * D) {
        add(point, 12);
        return sum;
    }
    const int left_out = point == P<D>::centre ? -1 : point - 2 * D;
    const int corners = 2 * (left_out < 0 ? D : D - 1);
    for (int corner = 0; corner < 2 * D; ++corner) {
        if (corner % D != left_out) {
            add(corner, 12 / corners);
        }
    }
    return sum;
}

template<int D>
long determinant(const typename PrismTemplate<D>::Cell& cell) {
    std::array<std::array<long, D>, D> e;
    const auto origin = reference_position<D>(cell[0]);
    for (std::size_t i = 0; i < D; ++i) {
        const auto corner = reference_position<D>(cell[i + 1]);
        for (std::size_t k = 0; k < D; ++k) {
            e[i][k] = corner[k] - origin[k];
        }
    }
    if constexpr (D == 2) {
        return e[0][0] * e[1][1] - e[0][1] * e[1][0];
    } else {
        return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
               e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
               e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    }
}

template<int D>
PrismTemplate<D> make_template(Split split, bool reversed) {
    std::array<LateralFace, D> centred{};
    switch (split) {
    case Split::diagonal:
        return cone_template<D>(reversed ? P<D>::bottom(1) : P<D>::bottom(0), centred);
    case Split::C:
        return cone_template<D>(P<D>::face_centre(0), centred);
    case Split::centre:
    case Split::E:
        break;
    }
    return cone_template<D>(P<D>::centre, centred);
}

} // namespace

Split split_from_name(std::string_view name, int dimension) {
    std::string known;
    for (const SplitFacts& fact : all_splits) {
        if (fact.dimension != dimension) {
            continue;
        }
        if (fact.name == name) {
            return fact.split;
        }
        known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", fact.name);
    }
    throw UsageError(fmt::format("no split \"{}\" for dimension {}; there are {}", name, dimension, known));
}

std::string_view split_name(Split split) { return facts(split).name; }

int simplices_per_prism(Split split) { return facts(split).simplices; }

SplitPoints points_of(Split split) { return facts(split).points; }

template<int D>
PrismTemplate<D> cone_template(int apex, const std::array<LateralFace, D>& lateral) {
    // With the facet outward and time up, e_1 .. e_(D-1), e_t, N has determinant -det[e_1 .. e_(D-1), n]: a simplex
    // that is positive in the reference prism has its normal pointing inward.
    constexpr long outward = -1;
    PrismTemplate<D> result;
    for (const LocalFacet<D>& facet : boundary_facets<D>(lateral)) {
        typename PrismTemplate<D>::Cell cell;
        std::copy(facet.begin(), facet.end(), cell.begin());
        cell[D] = static_cast<std::uint8_t>(apex);
        const long det = determinant<D>(cell);
        if (det == 0) {
            continue; // the facet holds the apex, or lies in its face
        }
        if (det * outward < 0) {
            std::swap(cell[0], cell[1]);
        }
        result.cells.push_back(cell);
    }
    return result;
}

template<int D>
const PrismTemplate<D>& template_of(Split split, const std::array<PersistentId, D>& ids) {
    static const auto templates = [] {
        std::array<std::array<PrismTemplate<D>, 2>, all_splits.size()> table;
        for (std::size_t i = 0; i < all_splits.size(); ++i) {
            if (all_splits[i].dimension == D) {
                table[i] = {make_template<D>(all_splits[i].split, false), make_template<D>(all_splits[i].split, true)};
            }
        }
        return table;
    }();
    const auto row = static_cast<std::size_t>(&facts(split) - all_splits.data());
    const bool reversed = split == Split::diagonal && ids[1] < ids[0];
    return templates[row][reversed ? 1 : 0];
}

template PrismTemplate<2> cone_template<2>(int, const std::array<LateralFace, 2>&);
template PrismTemplate<3> cone_template<3>(int, const std::array<LateralFace, 3>&);
template const PrismTemplate<2>& template_of<2>(Split, const std::array<PersistentId, 2>&);
template const PrismTemplate<3>& template_of<3>(Split, const std::array<PersistentId, 3>&);

} // namespace slabhull
