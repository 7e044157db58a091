// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <variant>

namespace soups {

using namespace slabhull;

inline Point<3> edge(const io::Soup& soup, const Index* simplex, int k) {
    Point<3> e{};
    for (std::size_t i = 0; i < 3; ++i) {
        e[i] = soup.points[simplex[k]][i] - soup.points[simplex[0]][i];
    }
    return e;
}

inline Point<3> cross(const Point<3>& a, const Point<3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Sum over the tetrahedra, each counted positive.
inline double volume(const io::Soup& soup) {
    double sum = 0;
    const auto& vertices = soup.simplices[3].vertices;
    for (std::size_t i = 0; i < vertices.size(); i += 4) {
        const Point<3> n = cross(edge(soup, &vertices[i], 1), edge(soup, &vertices[i], 2));
        const Point<3> e = edge(soup, &vertices[i], 3);
        sum += std::abs(n[0] * e[0] + n[1] * e[1] + n[2] * e[2]) / 6;
    }
    return sum;
}

/// Area of the triangles of one group.
inline double area(const io::Soup& soup, PatchNumber group) {
    double sum = 0;
    const auto& block = soup.simplices[2];
    for (std::size_t i = 0; i < block.size(2); ++i) {
        if (block.physical[i] == group) {
            const Index* triangle = &block.vertices[3 * i];
            const Point<3> n = cross(edge(soup, triangle, 1), edge(soup, triangle, 2));
            sum += std::hypot(n[0], n[1], n[2]) / 2;
        }
    }
    return sum;
}

/// Points (but for the last digit, which Gmsh leaves off in text), triangles, tetrahedra and their groups.
inline bool same_mesh(const io::Soup& a, const io::Soup& b) {
    const auto near = [](const Point<3>& p, const Point<3>& q) {
        return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) < 1e-15;
    };
    bool same = std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), near);
    for (std::size_t d = 2; d <= 3; ++d) {
        same = same && a.simplices[d].vertices == b.simplices[d].vertices &&
               a.simplices[d].physical == b.simplices[d].physical && a.groups[d] == b.groups[d];
    }
    return same;
}

/// The data of our fixtures: "x" is the first coordinate, "v" twice the point.
inline void check_point_data(const io::Soup& soup) {
    REQUIRE(soup.find_point_data("x") != nullptr);
    REQUIRE(soup.find_point_data("v") != nullptr);
    const auto& x = std::get<Array<double>>(soup.find_point_data("x")->values);
    const auto& v = std::get<Array<double>>(soup.find_point_data("v")->values);
    REQUIRE(soup.find_point_data("v")->components == 3);
    REQUIRE(x.size() == soup.points.size());
    REQUIRE(v.size() == 3 * soup.points.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        CHECK(x[i] == soup.points[i][0]);
        CHECK(v[3 * i + 2] == 2 * soup.points[i][2]);
    }
}

template<class T>
const T& values(const io::DataArray* array) {
    REQUIRE(array != nullptr);
    REQUIRE(std::holds_alternative<T>(array->values));
    return std::get<T>(array->values);
}

inline void says(const std::string& message, const std::string& text) {
    CHECK_THAT(message, Catch::Contains(text));
}

inline std::size_t size_of(const io::DataArray& array) {
    return std::visit([](const auto& values) { return values.size(); }, array.values);
}

/// What any soup must be.
inline bool is_consistent(const io::Soup& soup) {
    bool good = true;
    for (std::size_t d = 0; d < 4; ++d) {
        const auto& block = soup.simplices[d];
        good = good && block.vertices.size() % (d + 1) == 0 &&
               (block.tags.empty() || block.tags.size() == block.size(static_cast<int>(d))) &&
               (block.physical.empty() || block.physical.size() == block.size(static_cast<int>(d))) &&
               std::all_of(block.vertices.begin(), block.vertices.end(),
                           [&](Index vertex) { return vertex < soup.points.size(); });
    }
    const auto has_rows = [](std::size_t rows) {
        return [rows](const io::DataArray& array) {
            return size_of(array) == rows * static_cast<std::size_t>(array.components);
        };
    };
    const int top = soup.top_dimension();
    const std::size_t cells = soup.simplices[static_cast<std::size_t>(top)].size(top);
    return good &&
           std::all_of(soup.point_data.begin(), soup.point_data.end(), has_rows(soup.points.size())) &&
           std::all_of(soup.cell_data.begin(), soup.cell_data.end(), has_rows(cells)) &&
           std::all_of(soup.points.begin(), soup.points.end(), [](const Point<3>& x) {
               return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
           });
}

} // namespace soups
