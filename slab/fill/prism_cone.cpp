// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/prism_cone.h"

namespace slabhull {

namespace {

// All places are whole numbers in units of 1/12, so determinants are exact.
constexpr int unit = 12;

template<int D>
using Place = std::array<int, D + 1>;

template<int D>
Place<D> mean_of_corners(const std::array<bool, D + 1>& corner, int time) {
    int count = 0;
    for (const bool taken : corner) {
        count += taken ? 1 : 0;
    }
    Place<D> place{};
    for (std::size_t k = 1; k <= D; ++k) { // corner 0 is the origin, corner k the k-th unit vector
        place[k - 1] = corner[k] ? unit / count : 0;
    }
    place[D] = time;
    return place;
}

/// The place of each local point, over the unit simplex.
template<int D>
std::array<Place<D>, CellPrismPoint<D>::count> reference_places() {
    using Local = CellPrismPoint<D>;
    std::array<Place<D>, Local::count> places{};
    std::array<bool, D + 1> all;
    all.fill(true);
    for (std::size_t k = 0; k <= D; ++k) {
        std::array<bool, D + 1> one{};
        one[k] = true;
        places[Local::below(k)] = mean_of_corners<D>(one, 0);
        places[Local::above(k)] = mean_of_corners<D>(one, unit);
        std::array<bool, D + 1> others = all;
        others[k] = false;
        places[Local::wall_centre(k)] = mean_of_corners<D>(others, unit / 2);
        for (std::size_t j = 0; Local::quads > 0 && j < k; ++j) {
            std::array<bool, D + 1> two = one;
            two[j] = true;
            places[Local::quad_centre(j, k)] = mean_of_corners<D>(two, unit / 2);
        }
    }
    places[Local::centre] = mean_of_corners<D>(all, unit / 2);
    return places;
}

template<std::size_t N>
int determinant(const std::array<std::array<int, N>, N>& rows) {
    if constexpr (N == 1) {
        return rows[0][0];
    } else {
        int sum = 0;
        for (std::size_t k = 0; k < N; ++k) {
            std::array<std::array<int, N - 1>, N - 1> minor{};
            for (std::size_t i = 1; i < N; ++i) {
                for (std::size_t j = 0; j + 1 < N; ++j) {
                    minor[i - 1][j] = rows[i][j < k ? j : j + 1];
                }
            }
            sum += (k % 2 == 0 ? 1 : -1) * rows[0][k] * determinant<N - 1>(minor);
        }
        return sum;
    }
}

template<int D>
bool is_odd(const PrismPiece<D>& piece) {
    static const auto places = reference_places<D>();
    std::array<Place<D>, D + 1> rows;
    for (std::size_t i = 0; i <= D; ++i) {
        const std::size_t corner = i < D ? piece[i + 1] : CellPrismPoint<D>::centre;
        for (std::size_t k = 0; k <= D; ++k) {
            rows[i][k] = places[corner][k] - places[piece[0]][k];
        }
    }
    return determinant<D + 1>(rows) < 0;
}

/// The corners of a piece except corner i, as a set of bits.
template<int D>
std::uint32_t ridge(const PrismPiece<D>& piece, std::size_t i) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k <= D; ++k) {
        bits |= k == i ? 0 : std::uint32_t{1} << piece[k];
    }
    return bits;
}

struct Side {
    std::uint32_t ridge;
    std::uint8_t piece;
    std::uint8_t corner;
    friend auto operator<=>(const Side&, const Side&) = default;
};

} // namespace

template<int D>
bool connect_cone(PrismCone<D>& cone) {
    std::array<Side, PrismCone<D>::most_pieces*(D + 1)> sides;
    if (cone.pieces.size() > PrismCone<D>::most_pieces) {
        return false;
    }
    cone.odd.resize(cone.pieces.size());
    cone.across.resize(cone.pieces.size());
    std::size_t count = 0;
    for (std::size_t p = 0; p < cone.pieces.size(); ++p) {
        cone.odd[p] = is_odd<D>(cone.pieces[p]) ? 1 : 0;
        for (std::size_t i = 0; i <= D; ++i) {
            sides[count++] = {ridge<D>(cone.pieces[p], i), static_cast<std::uint8_t>(p),
                              static_cast<std::uint8_t>(i)};
        }
    }
    std::sort(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t s = 0; s < count; s += 2) {
        if (s + 1 == count || sides[s].ridge != sides[s + 1].ridge ||
            (s + 2 < count && sides[s].ridge == sides[s + 2].ridge)) {
            return false;
        }
        cone.across[sides[s].piece][sides[s].corner] = sides[s + 1].piece;
        cone.across[sides[s + 1].piece][sides[s + 1].corner] = sides[s].piece;
    }
    return true;
}

template bool connect_cone<2>(PrismCone<2>&);
template bool connect_cone<3>(PrismCone<3>&);

} // namespace slabhull
