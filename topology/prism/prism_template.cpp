// SPDX-License-Identifier: BSD-3-Clause
// Prism templates as cones; orientation and adjacency are derived.
#include "slabhull/topology/prism_split.h"

#include <algorithm>
#include <optional>

namespace slabhull {

namespace {

template<int D>
using LocalFacet = std::array<std::uint8_t, D>;

template<int D>
using P = PrismPoint<D>;

std::uint8_t local(int point) {
    return static_cast<std::uint8_t>(point);
}

/// The triangles of lateral face i of a prism over a triangle.
void add_quad(std::size_t i, Quad quad, std::vector<LocalFacet<3>>& facets) {
    const auto [j, k] = quad_corners<3>(i);
    const std::array<std::uint8_t, 4> ring{
        local(P<3>::bottom(static_cast<int>(j))), local(P<3>::bottom(static_cast<int>(k))),
        local(P<3>::top(static_cast<int>(k))), local(P<3>::top(static_cast<int>(j)))};
    switch (quad) {
    case Quad::centred:
        for (std::size_t side = 0; side < 4; ++side) {
            facets.push_back(
                {ring[side], ring[(side + 1) % 4], local(P<3>::face_centre(static_cast<int>(i)))});
        }
        break;
    case Quad::rising:
        facets.push_back({ring[0], ring[1], ring[2]});
        facets.push_back({ring[0], ring[2], ring[3]});
        break;
    case Quad::falling:
        facets.push_back({ring[0], ring[1], ring[3]});
        facets.push_back({ring[1], ring[2], ring[3]});
        break;
    }
}

/// The boundary of the prism as facets, unoriented.
template<int D>
std::vector<LocalFacet<D>> boundary_facets(const Quads<D>& quads) {
    LocalFacet<D> bottom;
    LocalFacet<D> top;
    for (int i = 0; i < D; ++i) {
        bottom[static_cast<std::size_t>(i)] = local(P<D>::bottom(i));
        top[static_cast<std::size_t>(i)] = local(P<D>::top(i));
    }
    std::vector<LocalFacet<D>> facets{bottom, top};
    if constexpr (D == 2) {
        facets.push_back({local(P<2>::bottom(1)), local(P<2>::top(1))});
        facets.push_back({local(P<2>::bottom(0)), local(P<2>::top(0))});
    } else {
        for (std::size_t i = 0; i < D; ++i) {
            add_quad(i, quads[i], facets);
        }
    }
    return facets;
}

/// Reference position of a prism point times 12, so that all centres are integers: the facet is the unit
/// simplex with corner 0 at the origin, time the last coordinate.
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
LocalFacet<D> sorted_facet(const typename PrismTemplate<D>::Cell& cell, std::size_t left_out) {
    LocalFacet<D> facet{};
    for (std::size_t k = 0, place = 0; k <= D; ++k) {
        if (k != left_out) {
            facet[place++] = cell[k];
        }
    }
    std::sort(facet.begin(), facet.end());
    return facet;
}

template<int D>
bool in_lateral_face(const LocalFacet<D>& facet, int face) {
    return std::all_of(facet.begin(), facet.end(), [face](int point) {
        return point < 2 * D ? point % D != face : D == 3 && point == P<D>::face_centre(face);
    });
}

/// Which piece of a lateral face a facet in it is: see PrismTemplate::slots.
template<int D>
std::size_t piece_of(const LocalFacet<D>& facet, std::size_t face) {
    if constexpr (D == 2) {
        return 0; // an edge is one piece
    } else {
        const auto below = std::count_if(facet.begin(), facet.end(), [](int point) { return point < D; });
        const auto above =
            std::count_if(facet.begin(), facet.end(), [](int point) { return point >= D && point < 2 * D; });
        if (below == 2 || above == 2) {
            return below == 2 ? 0 : 1;
        }
        return facet[0] == quad_corners<3>(face)[0] ? 2 : 3;
    }
}

template<int D>
std::optional<std::uint8_t> slot_of(const LocalFacet<D>& facet) {
    if (facet.back() < D) {
        return PrismTemplate<D>::bottom;
    }
    if (facet.front() >= D && facet.back() < 2 * D) {
        return PrismTemplate<D>::top;
    }
    for (std::size_t face = 0; face < D; ++face) {
        if (in_lateral_face<D>(facet, static_cast<int>(face))) {
            return PrismTemplate<D>::lateral(face, piece_of<D>(facet, face));
        }
    }
    return {};
}

/// The cell other than `but` with the given facet, or no_cell.
template<int D>
std::uint8_t cell_with(const PrismTemplate<D>& filling, const LocalFacet<D>& facet, std::size_t but) {
    for (std::size_t c = 0; c < filling.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D && c != but; ++i) {
            if (sorted_facet<D>(filling.cells[c], i) == facet) {
                return static_cast<std::uint8_t>(c);
            }
        }
    }
    return PrismTemplate<D>::no_cell;
}

template<int D>
void connect(PrismTemplate<D>& filling) {
    filling.cell_at.fill(PrismTemplate<D>::no_cell);
    filling.across.resize(filling.cells.size());
    for (std::size_t c = 0; c < filling.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            const LocalFacet<D> facet = sorted_facet<D>(filling.cells[c], i);
            if (const auto slot = slot_of<D>(facet)) {
                filling.across[c][i] = static_cast<std::uint8_t>(PrismTemplate<D>::outside + *slot);
                filling.cell_at[*slot] = static_cast<std::uint8_t>(c);
            } else {
                filling.across[c][i] = cell_with<D>(filling, facet, c);
            }
        }
    }
}

} // namespace

template<int D>
PrismTemplate<D> cone_template(int apex, const Quads<D>& quads) {
    // With the facet outward and time up, e_1 .. e_(D-1), e_t, N has determinant -det[e_1 .. e_(D-1), n]: a
    // simplex that is positive in the reference prism has its normal pointing inward.
    constexpr long outward = -1;
    PrismTemplate<D> result;
    for (const LocalFacet<D>& facet : boundary_facets<D>(quads)) {
        typename PrismTemplate<D>::Cell cell;
        std::copy(facet.begin(), facet.end(), cell.begin());
        cell[D] = local(apex);
        const long det = determinant<D>(cell);
        if (det == 0) {
            continue; // the facet holds the apex, or lies in its face
        }
        if (det * outward < 0) {
            std::swap(cell[0], cell[1]);
        }
        result.cells.push_back(cell);
    }
    connect(result);
    return result;
}

template PrismTemplate<2> cone_template<2>(int, const Quads<2>&);
template PrismTemplate<3> cone_template<3>(int, const Quads<3>&);

} // namespace slabhull
