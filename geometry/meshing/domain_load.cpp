// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/domain_load.h"

#include "core/pieces.h"
#include "geometry/embedding/components.h"

#include <array>
#include <cstddef>

namespace slabhull {

namespace {

/// Largest edge of a piece, in spacings.
constexpr double piece_edge = 2;
constexpr int deepest_cube = 40;

struct Cube {
    Point<3> centre{};
    double half = 0;

    Box<3> box() const {
        Box<3> box{centre, centre};
        for (std::size_t k = 0; k < 3; ++k) {
            box.low[k] -= half;
            box.high[k] += half;
        }
        return box;
    }
    std::array<Cube, 8> parts() const {
        std::array<Cube, 8> parts;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i] = {centre, half / 2};
            for (std::size_t k = 0; k < 3; ++k) {
                parts[i].centre[k] += ((i >> k) & 1) != 0 ? half / 2 : -half / 2;
            }
        }
        return parts;
    }
};

class LoadSampler {
public:
    LoadSampler(const Surface<3>& surface, const SizeField<3>& size)
        : surface_{surface}, size_{size}, tree_{facet_boxes(surface)} {}

    std::vector<LoadSample> run() const {
        std::vector<Cube> cubes{around_surface()};
        for (int level = 0; level < 3; ++level) {
            std::vector<Cube> finer;
            for (const Cube& cube : cubes) {
                for (const Cube& part : cube.parts()) {
                    finer.push_back(part);
                }
            }
            cubes = std::move(finer);
        }
        return parallel_gather<LoadSample>(cubes.size(), 1,
                                           [&](std::size_t c, std::size_t, std::vector<LoadSample>& found) {
                                               sample(cubes[c], false, 3, found);
                                           });
    }

private:
    Cube around_surface() const {
        Box<3> all;
        for (const Point<3>& p : surface_.points) {
            all.include(p);
        }
        Cube cube{{}, all.extent() / 2};
        for (std::size_t k = 0; k < 3; ++k) {
            cube.centre[k] = (all.low[k] + all.high[k]) / 2;
        }
        return cube;
    }

    /// `inside`: the cube is known to be in the domain.
    void sample(const Cube& cube, bool inside, int depth, std::vector<LoadSample>& found) const {
        const bool crossed = !inside && meets_surface(cube);
        if (!inside && !crossed && !contains(cube.centre)) {
            return;
        }
        const double spacing = size_(cube.centre);
        if (2 * cube.half > piece_edge * spacing && depth < deepest_cube) {
            for (const Cube& part : cube.parts()) {
                sample(part, !crossed, depth + 1, found);
            }
        } else if (!crossed || contains(cube.centre)) {
            const double edge = 2 * cube.half / spacing;
            found.push_back({cube.centre, spacing, edge * edge * edge});
        }
    }

    bool meets_surface(const Cube& cube) const {
        bool meets = false;
        tree_.find(cube.box(), [&](Index) { meets = true; });
        return meets;
    }
    bool contains(const Point<3>& p) const {
        return winding_number<3>(surface_, tree_, p, [](Index) { return true; }) > 0;
    }

    const Surface<3>& surface_;
    const SizeField<3>& size_;
    BoxTree<3> tree_;
};

} // namespace

std::vector<LoadSample> sample_load(const Surface<3>& surface, const SizeField<3>& size) {
    return LoadSampler{surface, size}.run();
}

double cubes_in(const std::vector<LoadSample>& load) {
    double sum = 0;
    for (const LoadSample& sample : load) {
        sum += sample.cubes;
    }
    return sum;
}

} // namespace slabhull
