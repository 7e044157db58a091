// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace specimens {

using namespace slabhull;

/// A mesh of a unit interval (D = 1), square (D = 2, on a curved sheet) or cube, n intervals each way, with
/// awkward coordinates and data of every kind; owns what its columns refer to.
struct Grid {
    int dimension;
    std::vector<Point<3>> points;
    std::vector<std::int64_t> cells;
    std::vector<double> time;
    std::vector<std::int64_t> ids;
    std::vector<std::int64_t> pairs; ///< two components per cell

    Grid(int d, std::int64_t n) : dimension{d} {
        make_points(n);
        d == 1 ? make_lines(n) : d == 2 ? make_triangles(n) : make_tetrahedra(n);
        make_data();
    }

    std::size_t cell_count() const { return cells.size() / static_cast<std::size_t>(dimension + 1); }

    io::MeshColumns columns() const {
        io::MeshColumns mesh;
        mesh.dimension = dimension;
        mesh.points = Column<double>::over(std::span{points.front().data(), 3 * points.size()}, 3);
        mesh.cells = Column<std::int64_t>::over(std::span{cells}, dimension + 1);
        mesh.point_data = {{"t", io::Scalar::float64, Column<double>::over(std::span{time})},
                           {"vertex_id", io::Scalar::int64, Column<std::int64_t>::over(std::span{ids})}};
        mesh.cell_data = {{"pair", io::Scalar::int64, Column<std::int64_t>::over(std::span{pairs}, 2)},
                          {"region", io::Scalar::int32, Column<std::int64_t>::constant(cell_count(), 2)}};
        mesh.field_data = {{"time", 1, Array<double>{0.1, 1.0 / 3}},
                           {"slab", 1, Array<std::int64_t>{7}},
                           {"patch_name", 1, std::vector<std::string>{"walls & doors", "", "fan <1>"}}};
        const std::size_t third = cell_count() / 3;
        mesh.groups = {
            {0, third, 5, "initial"}, {third, 2 * third, 2, "side a"}, {2 * third, cell_count(), 9, "end"}};
        return mesh;
    }

private:
    void make_points(std::int64_t n) {
        const std::int64_t width = dimension == 1 ? 0 : n;
        const std::int64_t depth = dimension == 3 ? n : 0;
        for (std::int64_t k = 0; k <= depth; ++k) {
            for (std::int64_t j = 0; j <= width; ++j) {
                for (std::int64_t i = 0; i <= n; ++i) {
                    const double h = 1.0 / static_cast<double>(n);
                    const double x = static_cast<double>(i) * h;
                    const double y = static_cast<double>(j) * h - 1e-300;
                    points.push_back(
                        {x, y, dimension == 3 ? static_cast<double>(k) * h : std::sin(3 * x) * y});
                }
            }
        }
    }
    void make_lines(std::int64_t n) {
        for (std::int64_t i = 0; i < n; ++i) {
            cells.insert(cells.end(), {i, i + 1});
        }
    }
    void make_triangles(std::int64_t n) {
        for (std::int64_t j = 0; j < n; ++j) {
            for (std::int64_t i = 0; i < n; ++i) {
                const std::int64_t a = j * (n + 1) + i;
                const std::int64_t c = a + n + 1;
                cells.insert(cells.end(), {a, a + 1, c + 1, a, c + 1, c});
            }
        }
    }
    /// Six tetrahedra around the long diagonal of each cube.
    void make_tetrahedra(std::int64_t n) {
        const std::array<std::int64_t, 3> step{1, n + 1, (n + 1) * (n + 1)};
        for (std::int64_t k = 0; k < n; ++k) {
            for (std::int64_t j = 0; j < n; ++j) {
                for (std::int64_t i = 0; i < n; ++i) {
                    const std::int64_t a = i * step[0] + j * step[1] + k * step[2];
                    std::array<std::size_t, 3> order{0, 1, 2};
                    do {
                        const std::int64_t b = a + step[order[0]];
                        const std::int64_t c = b + step[order[1]];
                        cells.insert(cells.end(), {a, b, c, c + step[order[2]]});
                    } while (std::next_permutation(order.begin(), order.end()));
                }
            }
        }
    }
    void make_data() {
        for (std::size_t i = 0; i < points.size(); ++i) {
            time.push_back(std::cos(static_cast<double>(i)));
            ids.push_back(static_cast<std::int64_t>(i * i) - 3);
        }
        for (std::size_t i = 0; i < cell_count(); ++i) {
            pairs.push_back(static_cast<std::int64_t>(i));
            pairs.push_back(-static_cast<std::int64_t>(2 * i));
        }
    }
};

} // namespace specimens
