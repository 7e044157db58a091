// SPDX-License-Identifier: BSD-3-Clause
#include "soups.h"

#include "slabhull/geometry/mesh_order.h"
#include "slabhull/geometry/shapes.h"

#include <array>
#include <fstream>
#include <map>
#include <string>
#include <utility>

namespace slabhull::bench {

namespace {

std::filesystem::path kept_in;

Soup make(int divisions) {
    const auto sphere = ellipsoid_body<3>({0, 0, 0}, {1, 1, 1}, divisions, {1, "sphere"});
    const double spacing = 1.2 / divisions;
    const auto box = box_surface<3>({-5, -5, -5}, {5, 5, 5}, spacing, {2, "box"});
    const auto surface = join<3>(std::array{sphere, box});
    CapOptions options;
    options.grading = {0.3, spacing};
    options.curve_order = false;
    return {mesh_cap<3>(surface, options), surface.points.size()};
}

template<class T>
void write(std::ofstream& out, const Array<T>& values) {
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(T)));
}

template<class T>
void read(std::ifstream& in, Array<T>& values) {
    in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

using Counts = std::array<std::size_t, 3>; ///< points, fixed points, cells

void save(const Soup& soup, const std::filesystem::path& file) {
    std::ofstream out{file, std::ios::binary};
    const Counts counts{soup.mesh.points.size(), soup.fixed, soup.mesh.cells.size()};
    out.write(reinterpret_cast<const char*>(counts.data()), sizeof counts);
    write(out, soup.mesh.points);
    write(out, soup.mesh.cells);
    write(out, soup.mesh.neighbors);
}

/// Whether the file was there, and whole.
bool load(Soup& soup, const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    Counts counts{};
    if (!in.read(reinterpret_cast<char*>(counts.data()), sizeof counts)) {
        return false;
    }
    soup.fixed = counts[1];
    soup.mesh.points.resize(counts[0]);
    soup.mesh.cells.resize(counts[2]);
    soup.mesh.neighbors.resize(counts[2]);
    read(in, soup.mesh.points);
    read(in, soup.mesh.cells);
    read(in, soup.mesh.neighbors);
    return in.good();
}

Soup load_or_make(int divisions) {
    if (kept_in.empty()) {
        return make(divisions);
    }
    const auto file = kept_in / ("sphere-in-cube-" + std::to_string(divisions) + ".soup");
    Soup result;
    if (!load(result, file)) {
        result = make(divisions);
        save(result, file);
    }
    return result;
}

} // namespace

const Soup& soup(int divisions, CellOrder order) {
    static std::map<std::pair<int, CellOrder>, Soup> made;
    const auto [at, fresh] = made.try_emplace({divisions, order});
    if (fresh && order == CellOrder::mesher) {
        at->second = load_or_make(divisions);
    } else if (fresh) {
        at->second = soup(divisions, CellOrder::mesher);
        order_along_curve<3>(at->second.mesh, at->second.fixed);
    }
    return at->second;
}

void keep_soups_in(const std::filesystem::path& directory) {
    std::filesystem::create_directories(directory);
    kept_in = directory;
}

} // namespace slabhull::bench
