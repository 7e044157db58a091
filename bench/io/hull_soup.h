// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// In C++17: VTK 9.1's headers are not C++20.

namespace slabhull::bench {

using Quad = std::array<std::uint32_t, 4>; ///< Simplex<3>, Neighbors<3>

/// Tetrahedra with the arrays of a hull (docs/formats.md): a mesh in memory, as often as asked for, one copy
/// beside the other. Only the mesh takes memory, whatever the number of copies; all else is computed.
struct HullSoup {
    const std::array<double, 3>* points = nullptr;
    const Quad* cells = nullptr;
    const Quad* neighbors = nullptr;
    const std::uint32_t* cell_of = nullptr; ///< a cell of each point
    std::size_t points_of_one = 0;
    std::size_t cells_of_one = 0;
    std::size_t copies = 1;

    std::size_t point_count() const { return copies * points_of_one; }
    std::size_t cell_count() const { return copies * cells_of_one; }

    std::array<double, 3> point(std::size_t v) const {
        std::array<double, 3> x = points[v % points_of_one];
        x[0] += 10 * static_cast<double>(v / points_of_one);
        return x;
    }
    std::array<std::int64_t, 4> vertices(std::size_t c) const { return moved(cells, c, points_of_one); }
    /// -1 for none.
    std::array<std::int64_t, 4> across(std::size_t c) const { return moved(neighbors, c, cells_of_one); }
    std::int64_t cell(std::size_t v) const {
        return cell_of[v % points_of_one] + static_cast<std::int64_t>(v / points_of_one * cells_of_one);
    }

    double time(std::size_t v) const { return 0.1 * points[v % points_of_one][2]; }
    std::int64_t id(std::size_t v) const { return static_cast<std::int64_t>(v) + 1'000'000; }
    std::int64_t track(std::size_t v) const { return v % 16 == 0 ? static_cast<std::int64_t>(v / 16) : -1; }
    /// Cells [begins[r], begins[r + 1]) are region r.
    std::array<std::size_t, 4> begins() const {
        return {0, cell_count() / 5 * 2, cell_count() / 5 * 3, cell_count()};
    }
    int region(std::size_t c) const { return c < begins()[1] ? 0 : c < begins()[2] ? 1 : 2; }
    int patch(std::size_t c) const { return region(c) == 1 ? 1 : 0; }
    int layer(std::size_t c) const { return region(c) == 1 ? static_cast<int>(c / 1000 % 4) : -1; }

private:
    std::array<std::int64_t, 4> moved(const Quad* rows, std::size_t c, std::size_t shift) const {
        std::array<std::int64_t, 4> row{};
        for (std::size_t i = 0; i < 4; ++i) {
            const std::uint32_t value = rows[c % cells_of_one][i];
            row[i] = value == UINT32_MAX ? -1 : value + static_cast<std::int64_t>(c / cells_of_one * shift);
        }
        return row;
    }
};

} // namespace slabhull::bench
