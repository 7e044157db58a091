// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_blocks.h"

#include "geometry/meshing/block_mesh.h"
#include "geometry/meshing/cap_limits.h"
#include "geometry/meshing/domain_blocks.h"
#include "geometry/meshing/sliver_repair.h"
#include "geometry/meshing/solid_mesher.h"

#include "slabhull/core/error.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "slabhull/geometry/size_field.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// Bytes per cell: in the mesher's process, and here while the blocks are received.
constexpr double tetgen_bytes = 220;
constexpr double hxt_bytes = 280;
constexpr double own_bytes = 100;
/// Fraction of the free memory that meshing may use.
constexpr double usable_memory = 0.85;

/// Memory for meshing in so many blocks, `at_once` of them at the same time.
double bytes_for(SolidMesher mesher, double cells, int blocks, int at_once) {
    const double mesher_bytes = mesher == SolidMesher::hxt ? hxt_bytes : tetgen_bytes;
    return cells * (own_bytes + mesher_bytes * std::min(1.0, static_cast<double>(at_once) / blocks));
}

/// Joins the meshes of blocks, one after the other.
class BlockJoiner {
public:
    BlockJoiner(const DomainBlocks& blocks, std::size_t expected_cells) {
        mesh_.points = blocks.points;
        mesh_.cells.reserve(expected_cells); // untouched memory costs nothing
        mesh_.neighbors.reserve(expected_cells);
    }

    void add(MeshedBlock block);
    CapMesh<3> finish(std::size_t boundary_facets);

private:
    CapMesh<3> mesh_;
    std::vector<OpenFacet> open_;
};

void BlockJoiner::add(MeshedBlock block) {
    const CapMesh<3>& part = block.mesh;
    const BlockPlace place{checked_index(mesh_.cells.size(), "cells of a cap"),
                           checked_index(mesh_.points.size(), "points of a cap")};
    checked_index(mesh_.cells.size() + part.cells.size(), "cells of a cap");
    checked_index(mesh_.points.size() + part.points.size(), "points of a cap");
    number_in_cap(block, place, open_);
    const auto given = static_cast<std::ptrdiff_t>(block.surface.vertex.size());
    mesh_.points.insert(mesh_.points.end(), part.points.begin() + given, part.points.end());
    mesh_.cells.insert(mesh_.cells.end(), part.cells.begin(), part.cells.end());
    mesh_.neighbors.insert(mesh_.neighbors.end(), part.neighbors.begin(), part.neighbors.end());
}

/// Joins blocks across their common facets.
CapMesh<3> BlockJoiner::finish(std::size_t boundary_facets) {
    const std::size_t left = join_open_facets(open_, [this](const OpenFacet& a, const OpenFacet& b) {
        mesh_.neighbors[a.cell][a.place] = b.cell;
        mesh_.neighbors[b.cell][b.place] = a.cell;
    });
    require_closed_blocks(left, boundary_facets);
    return std::move(mesh_);
}

/// Consecutive blocks from `first` on, meshed at once in processes of this machine.
std::vector<MeshedBlock> mesh_blocks(const DomainBlocks& blocks, std::size_t first, std::size_t count,
                                     const SizeField<3>& size, const CapOptions& options) {
    std::vector<MeshedBlock> meshed(count);
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            meshed[k] = mesh_block(blocks, first + k, size, options);
        }
    });
    return meshed;
}

void join_blocks(const DomainBlocks& blocks, std::size_t first, std::size_t count, const SizeField<3>& size,
                 const CapOptions& options, BlockJoiner& joiner) {
    for (MeshedBlock& block : mesh_blocks(blocks, first, count, size, options)) {
        joiner.add(std::move(block));
    }
}

CapMesh<3> mesh_and_join(const DomainBlocks& blocks, const SizeField<3>& size, const CapOptions& options,
                         std::size_t at_once, double expected_cells, const Surface<3>& boundary) {
    BlockJoiner joiner{blocks, static_cast<std::size_t>(expected_cells)};
    for (std::size_t first = 0; first < blocks.facets.size(); first += at_once) {
        join_blocks(blocks, first, std::min(at_once, blocks.facets.size() - first), size, options, joiner);
    }
    CapMesh<3> mesh = joiner.finish(boundary.facets.size());
    repair_slivers(mesh, boundary.points.size(), options.min_dihedral); // interfaces may move now
    mesh.blocks = static_cast<int>(blocks.facets.size());
    return mesh;
}

/// If the domain filled its bounding box.
double most_cells(const SizeField<3>& size) {
    return cells_per_cube<3> * size.cube_count();
}

/// How many blocks are meshed at the same time.
std::size_t blocks_at_once(const CapOptions& options, double cells, int count, double memory) {
    int at_once = std::min(thread_count(), count);
    while (at_once > 1 && bytes_for(options.mesher, cells, count, at_once) > memory) {
        --at_once;
    }
    return static_cast<std::size_t>(at_once);
}

} // namespace

SizeField<3> wanted_size(const Surface<3>& surface, const CapOptions& options) {
    SizeField<3> size{surface.points, boundary_spacing<3>(surface.points, surface.facets), options.grading};
    expect_work(static_cast<std::uint64_t>(most_cells(size)));
    return size;
}

CapMesh<3> mesh_in_blocks(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options) {
    const SizeField<3> size = wanted_size(surface, options);
    const double most = most_cells(size);
    const double memory = usable_memory * static_cast<double>(available_memory());
    if (options.blocks == 1 || (options.blocks == 0 && bytes_for(options.mesher, most, 1, 1) <= memory)) {
        return fill_solid(boundary, surface, size, options);
    }
    std::vector<LoadSample> load = sample_load(surface, size);
    const double cells = cells_per_cube<3> * cubes_in(load);
    const int count = options.blocks > 0 ? options.blocks : blocks_that_fit(options.mesher, cells, memory);
    if (count == 1) {
        return fill_solid(boundary, surface, size, options);
    }
    const DomainBlocks blocks =
        cut_domain(boundary, surface, size, options.grading.growth, std::move(load), count);
    return mesh_and_join(blocks, size, options, blocks_at_once(options, cells, count, memory), cells,
                         surface);
}

int blocks_that_fit(SolidMesher mesher, double cells, double bytes) {
    if (bytes_for(mesher, cells, 1, 1) <= bytes) {
        return 1;
    }
    int blocks = 2;
    while (blocks < most_blocks && bytes_for(mesher, cells, blocks, 2) > bytes) {
        blocks *= 2;
    }
    return blocks;
}

} // namespace slabhull
