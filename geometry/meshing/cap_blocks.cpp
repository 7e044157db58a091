// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_blocks.h"

#include "geometry/meshing/cap_limits.h"
#include "geometry/meshing/domain_blocks.h"
#include "geometry/meshing/sliver_repair.h"
#include "geometry/meshing/solid_mesher.h"

#include "slabhull/core/communicator.h"
#include "slabhull/core/error.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "slabhull/geometry/size_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
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

/// Whether this process gets the mesh: of ranks, the first does.
bool has_mesh(const CapOptions& options) {
    return options.ranks == nullptr || options.ranks->first();
}

CapMesh<3> fill(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                const CapOptions& options) {
    return options.mesher == SolidMesher::hxt ? fill_with_hxt(boundary, surface, size, options)
                                              : fill_with_tetgen(boundary, surface, size, options);
}

/// Memory for meshing in so many blocks, `at_once` of them at the same time.
double bytes_for(SolidMesher mesher, double cells, int blocks, int at_once) {
    const double mesher_bytes = mesher == SolidMesher::hxt ? hxt_bytes : tetgen_bytes;
    return cells * (own_bytes + mesher_bytes * std::min(1.0, static_cast<double>(at_once) / blocks));
}

/// A facet of a cell without a neighbour in its own block.
struct OpenFacet {
    Facet<3> vertices; ///< ascending
    Index cell;
    Index place;
    friend auto operator<=>(const OpenFacet&, const OpenFacet&) = default;
};

/// Joins the meshes of blocks, one after the other.
class BlockJoiner {
public:
    BlockJoiner(const DomainBlocks& blocks, std::size_t expected_cells) {
        mesh_.points = blocks.points;
        mesh_.cells.reserve(expected_cells); // untouched memory costs nothing
        mesh_.neighbors.reserve(expected_cells);
    }

    void add(const BlockSurface& block, const CapMesh<3>& part);
    CapMesh<3> finish(std::size_t boundary_facets);

private:
    CapMesh<3> mesh_;
    std::vector<OpenFacet> open_;
};

void BlockJoiner::add(const BlockSurface& block, const CapMesh<3>& part) {
    const std::size_t given = block.vertex.size();
    if (part.points.size() < given ||
        std::memcmp(part.points.data(), block.surface.points.data(), given * sizeof(Point<3>)) != 0) {
        throw GeometryError{"the mesher's result was refused: it moved or renumbered the points of a block"};
    }
    const Index first_cell = checked_index(mesh_.cells.size(), "cells of a cap");
    const Index first_point = checked_index(mesh_.points.size(), "points of a cap");
    checked_index(mesh_.cells.size() + part.cells.size(), "cells of a cap");
    checked_index(mesh_.points.size() + part.points.size(), "points of a cap");
    mesh_.points.insert(mesh_.points.end(), part.points.begin() + static_cast<std::ptrdiff_t>(given),
                        part.points.end());
    for (std::size_t c = 0; c < part.cells.size(); ++c) {
        Simplex<3> cell = part.cells[c];
        Neighbors<3> neighbors = part.neighbors[c];
        for (Index& v : cell) {
            v = v < given ? block.vertex[v] : first_point + (v - static_cast<Index>(given));
        }
        for (std::size_t i = 0; i < 4; ++i) {
            if (neighbors[i] != no_index) {
                neighbors[i] += first_cell;
                continue;
            }
            Facet<3> facet = outward_facet<3>(cell, static_cast<int>(i));
            std::sort(facet.begin(), facet.end());
            open_.push_back({facet, static_cast<Index>(mesh_.cells.size()), static_cast<Index>(i)});
        }
        mesh_.cells.push_back(cell);
        mesh_.neighbors.push_back(neighbors);
    }
}

/// Joins blocks across their common facets.
CapMesh<3> BlockJoiner::finish(std::size_t boundary_facets) {
    std::sort(open_.begin(), open_.end());
    std::size_t alone = open_.size();
    for (std::size_t k = 0; k + 1 < open_.size(); ++k) {
        const OpenFacet& a = open_[k];
        const OpenFacet& b = open_[k + 1];
        if (a.vertices == b.vertices) {
            mesh_.neighbors[a.cell][a.place] = b.cell;
            mesh_.neighbors[b.cell][b.place] = a.cell;
            alone -= 2;
            ++k;
        }
    }
    if (alone != boundary_facets) {
        throw GeometryError{
            fmt::format("the mesher's result was refused: blocks joined leave {} facets open, "
                        "and the boundary has {}",
                        alone, boundary_facets)};
    }
    return std::move(mesh_);
}

/// A block's surface, and the mesh of the block.
struct MeshedBlock {
    BlockSurface surface;
    CapMesh<3> mesh;
};

MeshedBlock mesh_block(const DomainBlocks& blocks, std::size_t number, const SizeField<3>& size,
                       const CapOptions& options) {
    MeshedBlock block{surface_of_block(blocks.points, blocks.facets[number]), {}};
    block.mesh = fill(Boundary<3>{block.surface.surface}, block.surface.surface, size, options);
    return block;
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

/// The mesh that rank `from` has, on the first rank; elsewhere none. Collective.
CapMesh<3> brought_to_first(Communicator& ranks, int from, CapMesh<3>& mesh) {
    const auto bring = [&]<class T>(Array<T>& list) {
        std::vector<Array<T>> to(static_cast<std::size_t>(ranks.size()));
        if (ranks.rank() == from) {
            to.front().swap(list);
        }
        return std::move(ranks.all_to_all(to)[static_cast<std::size_t>(from)]);
    };
    CapMesh<3> here;
    here.points = bring(mesh.points);
    here.cells = bring(mesh.cells);
    here.neighbors = bring(mesh.neighbors);
    return here;
}

/// Consecutive blocks from `first` on, one by each rank. The first rank joins them, one at a time.
void join_blocks_of_ranks(const DomainBlocks& blocks, std::size_t first, std::size_t count,
                          const SizeField<3>& size, const CapOptions& options, BlockJoiner& joiner) {
    Communicator& ranks = *options.ranks;
    const auto mine = static_cast<std::size_t>(ranks.rank());
    MeshedBlock own = together(ranks, [&] {
        return mine < count ? mesh_block(blocks, first + mine, size, options) : MeshedBlock{};
    });
    for (std::size_t k = 0; k < count; ++k) {
        const CapMesh<3> block = brought_to_first(ranks, static_cast<int>(k), own.mesh);
        if (ranks.first()) {
            joiner.add(surface_of_block(blocks.points, blocks.facets[first + k]), block);
        }
    }
}

void join_blocks(const DomainBlocks& blocks, std::size_t first, std::size_t count, const SizeField<3>& size,
                 const CapOptions& options, BlockJoiner& joiner) {
    for (MeshedBlock& block : mesh_blocks(blocks, first, count, size, options)) {
        joiner.add(block.surface, block.mesh);
        block = {};
    }
}

CapMesh<3> mesh_and_join(const DomainBlocks& blocks, const SizeField<3>& size, const CapOptions& options,
                         std::size_t at_once, double expected_cells, const Surface<3>& boundary) {
    BlockJoiner joiner{blocks, has_mesh(options) ? static_cast<std::size_t>(expected_cells) : 0};
    for (std::size_t first = 0; first < blocks.facets.size(); first += at_once) {
        const std::size_t count = std::min(at_once, blocks.facets.size() - first);
        options.ranks != nullptr ? join_blocks_of_ranks(blocks, first, count, size, options, joiner)
                                 : join_blocks(blocks, first, count, size, options, joiner);
    }
    CapMesh<3> mesh;
    if (has_mesh(options)) {
        mesh = joiner.finish(boundary.facets.size());
        repair_slivers(mesh, boundary.points.size(), options.min_dihedral); // interfaces may move now
    }
    mesh.blocks = static_cast<int>(blocks.facets.size());
    return mesh;
}

SizeField<3> wanted_size(const Surface<3>& surface, const CapOptions& options) {
    return {surface.points, boundary_spacing<3>(surface.points, surface.facets), options.grading};
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

CapMesh<3> mesh_alone(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options) {
    const SizeField<3> size = wanted_size(surface, options);
    const double most = most_cells(size);
    expect_work(static_cast<std::uint64_t>(most));
    const double memory = usable_memory * static_cast<double>(available_memory());
    if (options.blocks == 1 || (options.blocks == 0 && bytes_for(options.mesher, most, 1, 1) <= memory)) {
        return fill(boundary, surface, size, options);
    }
    std::vector<LoadSample> load = sample_load(surface, size);
    const double cells = cells_per_cube<3> * cubes_in(load);
    const int count = options.blocks > 0 ? options.blocks : blocks_that_fit(options.mesher, cells, memory);
    if (count == 1) {
        return fill(boundary, surface, size, options);
    }
    const DomainBlocks blocks =
        cut_domain(boundary, surface, size, options.grading.growth, std::move(load), count);
    return mesh_and_join(blocks, size, options, blocks_at_once(options, cells, count, memory), cells,
                         surface);
}

/// The blocks that the first rank has. Collective.
DomainBlocks blocks_of_first(const DomainBlocks& of_first, Communicator& ranks) {
    DomainBlocks blocks;
    blocks.points = ranks.broadcast<Point<3>>(of_first.points, 0);
    blocks.facets.resize(ranks.gather(of_first.facets.size()).front());
    for (std::size_t k = 0; k < blocks.facets.size(); ++k) {
        const auto list = ranks.first() ? std::span{of_first.facets[k]} : std::span<const Facet<3>>{};
        blocks.facets[k] = ranks.broadcast(list, 0);
    }
    return blocks;
}

/// The field that the first rank has. Collective.
SizeField<3> size_of_first(const SizeField<3>* of_first, Communicator& ranks) {
    Array<std::byte> lists;
    SizeField<3>::Packed heading;
    if (of_first != nullptr) {
        heading = of_first->packed();
        lists.insert(lists.end(), of_first->source_bytes().begin(), of_first->source_bytes().end());
        lists.insert(lists.end(), of_first->box_bytes().begin(), of_first->box_bytes().end());
    }
    heading = ranks.gather(heading).front();
    return {heading, ranks.broadcast<std::byte>(lists, 0)};
}

/// The first rank cuts the domain, and each meshes some of the blocks; a single one is the first's.
CapMesh<3> mesh_in_ranks(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options) {
    if (options.blocks == 0) {
        throw UsageError{"ranks mesh a cap in a given number of blocks, as their memory may differ"};
    }
    Communicator& ranks = *options.ranks;
    std::optional<SizeField<3>> size;
    if (ranks.first()) {
        size = wanted_size(surface, options);
        expect_work(static_cast<std::uint64_t>(most_cells(*size)));
    }
    if (options.blocks == 1) {
        return ranks.first() ? fill(boundary, surface, *size, options) : CapMesh<3>{};
    }
    DomainBlocks blocks;
    double cells = 0;
    if (ranks.first()) {
        std::vector<LoadSample> load = sample_load(surface, *size);
        cells = cells_per_cube<3> * cubes_in(load);
        blocks =
            cut_domain(boundary, surface, *size, options.grading.growth, std::move(load), options.blocks);
    }
    size = size_of_first(ranks.first() ? &*size : nullptr, ranks);
    blocks = blocks_of_first(blocks, ranks);
    return mesh_and_join(blocks, *size, options, static_cast<std::size_t>(ranks.size()), cells, surface);
}

} // namespace

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

CapMesh<3> mesh_in_blocks(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options) {
    return options.ranks != nullptr ? mesh_in_ranks(boundary, surface, options)
                                    : mesh_alone(boundary, surface, options);
}

} // namespace slabhull
