// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <vector>

/// Small closed complexes with known topology, by connectivity alone.
namespace slabhull::specimens {

template<int D>
struct Complex {
    Array<Simplex<D>> cells;
    std::size_t vertices = 0;
};

template<std::size_t N>
bool odd_permutation(const std::array<Index, N>& order) {
    bool odd = false;
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = i + 1; j < N; ++j) {
            odd ^= order[i] > order[j];
        }
    }
    return odd;
}

template<std::size_t N>
void flip(std::array<Index, N>& cell) {
    std::swap(cell[N - 2], cell[N - 1]);
}

/// The D-sphere as the boundary of a (D + 1)-simplex.
template<int D>
Complex<D> sphere() {
    Complex<D> result{{}, D + 2};
    for (Index left_out = 0; left_out < D + 2; ++left_out) {
        Simplex<D> cell{};
        for (Index v = 0, k = 0; v < D + 2; ++v) {
            if (v != left_out) {
                cell[k++] = v;
            }
        }
        if (left_out % 2 == 1) {
            flip(cell);
        }
        result.cells.push_back(cell);
    }
    return result;
}

/// Every cell cut into D + 1 at a new vertex inside it: the same manifold.
template<int D>
Complex<D> refined(const Complex<D>& complex) {
    Complex<D> result{{}, complex.vertices};
    for (const Simplex<D>& cell : complex.cells) {
        for (std::size_t i = 0; i <= D; ++i) {
            result.cells.push_back(cell);
            result.cells.back()[i] = static_cast<Index>(result.vertices);
        }
        ++result.vertices;
    }
    return result;
}

/// The D-torus: n^D cubes with opposite sides joined (n >= 3), each cut into D! simplices along its diagonal.
template<int D>
Complex<D> torus(Index n) {
    Complex<D> result;
    result.vertices = 1;
    for (int k = 0; k < D; ++k) {
        result.vertices *= n;
    }
    for (Index cube = 0; cube < result.vertices; ++cube) {
        std::array<Index, D> order{};
        std::iota(order.begin(), order.end(), Index{0});
        do {
            std::array<Index, D> at{};
            for (Index k = 0, rest = cube; k < D; ++k, rest /= n) {
                at[k] = rest % n;
            }
            const auto number = [&] {
                Index sum = 0;
                for (int k = D; k-- > 0;) {
                    sum = sum * n + at[static_cast<std::size_t>(k)];
                }
                return sum;
            };
            Simplex<D> cell{number()};
            for (std::size_t k = 0; k < D; ++k) {
                at[order[k]] = (at[order[k]] + 1) % n;
                cell[k + 1] = number();
            }
            if (odd_permutation(order)) {
                flip(cell);
            }
            result.cells.push_back(cell);
        } while (std::next_permutation(order.begin(), order.end()));
    }
    return result;
}

/// A closed surface times a circle of `levels` >= 3 steps; prisms are cut along the diagonals of smallest
/// vertex.
inline Complex<3> times_circle(const Complex<2>& surface, Index levels) {
    Complex<3> result{{}, surface.vertices * levels};
    const auto count = static_cast<Index>(surface.vertices);
    for (Index level = 0; level < levels; ++level) {
        for (const Simplex<2>& base : surface.cells) {
            Simplex<2> sorted = base;
            std::sort(sorted.begin(), sorted.end());
            for (std::size_t k = 0; k < 3; ++k) { // bottom vertices up to k, top vertices from k
                Simplex<3> cell{};
                for (std::size_t i = 0; i < 4; ++i) {
                    const Index at = i <= k ? level : (level + 1) % levels;
                    cell[i] = at * count + sorted[i <= k ? i : i - 1];
                }
                if (odd_permutation(base) != (k % 2 == 1)) {
                    flip(cell);
                }
                result.cells.push_back(cell);
            }
        }
    }
    return result;
}

/// Two cones over a closed surface, joined at their bases: its two apices have the surface for a link.
inline Complex<3> suspension(const Complex<2>& surface) {
    Complex<3> result{{}, surface.vertices + 2};
    const auto apex = static_cast<Index>(surface.vertices);
    for (const Simplex<2>& base : surface.cells) {
        result.cells.push_back({base[0], base[1], base[2], apex});
        result.cells.push_back({base[1], base[0], base[2], apex + 1});
    }
    return result;
}

template<int D>
Complex<D> disjoint_union(const Complex<D>& a, const Complex<D>& b) {
    Complex<D> result = a;
    for (Simplex<D> cell : b.cells) {
        for (Index& v : cell) {
            v += static_cast<Index>(a.vertices);
        }
        result.cells.push_back(cell);
    }
    result.vertices += b.vertices;
    return result;
}

/// Vertex `gone` becomes `kept`; the last vertex takes its number.
template<int D>
void merge_vertices(Complex<D>& complex, Index kept, Index gone) {
    const auto last = static_cast<Index>(--complex.vertices);
    for (Simplex<D>& cell : complex.cells) {
        for (Index& v : cell) {
            v = v == gone ? kept : v;
            v = v == last && gone != last ? gone : v;
        }
    }
}

/// Real projective 3-space: antipodal points of the 3-sphere are one. From the 16-cell, whose faces are the
/// sign vectors in {-1, 0, 1}^4: its flags are the cells of its barycentric subdivision.
inline Complex<3> projective_space() {
    using Signs = std::array<int, 4>;
    std::map<Signs, Index> number;
    const auto vertex = [&](Signs face) {
        Signs opposite = face;
        for (int& sign : opposite) {
            sign = -sign;
        }
        face = std::max(face, opposite); // the same for both
        return number.try_emplace(face, static_cast<Index>(number.size())).first->second;
    };
    Complex<3> result;
    for (unsigned signs = 0; signs < 8;
         ++signs) { // of each antipodal pair, the facet with a positive last sign
        std::array<Index, 4> order{0, 1, 2, 3};
        do {
            Signs face{};
            Simplex<3> cell{};
            bool odd = odd_permutation(order);
            for (std::size_t k = 0; k < 4; ++k) {
                const bool negative = order[k] < 3 && (signs >> order[k] & 1u) != 0;
                odd ^= negative;
                face[order[k]] = negative ? -1 : 1;
                cell[k] = vertex(face);
            }
            if (odd) {
                flip(cell);
            }
            result.cells.push_back(cell);
        } while (std::next_permutation(order.begin(), order.end()));
    }
    result.vertices = number.size();
    return result;
}

/// The same complex with vertices renumbered, cells reordered and their vertices rotated without changing
/// orientation.
template<int D>
Complex<D> shuffled(const Complex<D>& complex, unsigned seed) {
    std::mt19937 random{seed};
    std::vector<Index> number(complex.vertices);
    std::iota(number.begin(), number.end(), Index{0});
    std::shuffle(number.begin(), number.end(), random);
    Complex<D> result = complex;
    std::shuffle(result.cells.begin(), result.cells.end(), random);
    for (Simplex<D>& cell : result.cells) {
        for (Index& v : cell) {
            v = number[v];
        }
        if constexpr (D >= 2) { // a cycle of three is an even permutation
            std::rotate(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(random() % 3),
                        cell.begin() + 3);
        }
    }
    return result;
}

} // namespace slabhull::specimens
