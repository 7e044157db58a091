// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_in_ranks.h"

#include "core/hash.h"
#include "core/pieces.h"

#include "geometry/meshing/block_numbers.h"
#include "geometry/meshing/cap_blocks.h"
#include "geometry/meshing/cap_limits.h"
#include "geometry/meshing/rank_order.h"
#include "geometry/meshing/sliver_repair.h"

#include "slabhull/core/communicator.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

template<class T>
using ListsByRank = std::vector<Array<T>>;

std::size_t count_of(const Communicator& ranks) {
    return static_cast<std::size_t>(ranks.size());
}

/// The points of the blocks that the first rank has, and the facets of those that are this rank's.
/// Collective.
DomainBlocks blocks_of_first(const DomainBlocks& of_first, Communicator& ranks) {
    std::vector<std::size_t> counts;
    ListsByRank<Facet<3>> to(count_of(ranks));
    for (const Array<Facet<3>>& facets : of_first.facets) {
        Array<Facet<3>>& list = to[counts.size() % to.size()];
        list.insert(list.end(), facets.begin(), facets.end());
        counts.push_back(facets.size());
    }
    const Array<std::size_t> all_counts = ranks.broadcast<std::size_t>(counts, 0);
    const Array<Facet<3>> here = std::move(ranks.all_to_all(to).front());
    DomainBlocks blocks;
    blocks.points = ranks.broadcast<Point<3>>(of_first.points, 0);
    blocks.facets.resize(all_counts.size());
    auto next = here.begin();
    for (auto block = static_cast<std::size_t>(ranks.rank()); block < all_counts.size(); block += to.size()) {
        const auto end = next + static_cast<std::ptrdiff_t>(all_counts[block]);
        blocks.facets[block].assign(next, end);
        next = end;
    }
    return blocks;
}

/// The box around a block, by its lowest and highest corners.
std::array<Point<3>, 2> box_around(const DomainBlocks& blocks, std::size_t number) {
    constexpr double most = std::numeric_limits<double>::infinity();
    std::array<Point<3>, 2> box{{{most, most, most}, {-most, -most, -most}}};
    for (const Facet<3>& facet : blocks.facets[number]) {
        for (const Index v : facet) {
            for (std::size_t k = 0; k < 3; ++k) {
                box[0][k] = std::min(box[0][k], blocks.points[v][k]);
                box[1][k] = std::max(box[1][k], blocks.points[v][k]);
            }
        }
    }
    return box;
}

/// What this rank's blocks need of the field that the first rank has. Collective.
SizeField<3> size_of_first(const SizeField<3>* of_first, const DomainBlocks& blocks, Communicator& ranks) {
    const std::size_t count = count_of(ranks);
    ListsByRank<SizeField<3>::Packed> headings(count);
    ListsByRank<std::byte> lists(count);
    for (std::size_t rank = 0; rank < count && of_first != nullptr; ++rank) {
        std::vector<std::array<Point<3>, 2>> boxes;
        for (std::size_t block = rank; block < blocks.facets.size(); block += count) {
            boxes.push_back(box_around(blocks, block));
        }
        const SizeField<3> part = of_first->part_within(boxes);
        headings[rank].push_back(part.packed());
        for (const std::span<const std::byte> bytes : {part.source_bytes(), part.box_bytes()}) {
            lists[rank].insert(lists[rank].end(), bytes.begin(), bytes.end());
        }
    }
    const SizeField<3>::Packed heading = ranks.all_to_all(headings).front().front();
    return {heading, ranks.all_to_all(lists).front()};
}

/// This rank's blocks. As many are meshed at once as there are ranks, so that the first error is that of one
/// process. Collective.
std::vector<MeshedBlock> own_blocks(const DomainBlocks& blocks, const SizeField<3>& size,
                                    const CapOptions& options) {
    Communicator& ranks = *options.ranks;
    std::vector<MeshedBlock> own;
    for (std::size_t first = 0; first < blocks.facets.size(); first += count_of(ranks)) {
        together(ranks, [&] {
            const std::size_t mine = first + static_cast<std::size_t>(ranks.rank());
            if (mine < blocks.facets.size()) {
                own.push_back(mesh_block(blocks, mine, size, options));
                verify_cap<3>(own.back().mesh, own.back().surface.surface);
            }
        });
    }
    return own;
}

/// Puts the meshes of blocks together: each rank has the cells of its own, and all points.
class RankJoiner {
public:
    RankJoiner(const DomainBlocks& blocks, std::vector<MeshedBlock> own, Communicator& ranks)
        : ranks_{ranks}, numbers_{own, blocks.facets.size(), blocks.points.size(), ranks} {
        share_points(blocks, own);
        take_cells(std::move(own));
    }

    /// Joins blocks across their common facets.
    void join(std::size_t boundary_facets) {
        ListsByRank<OpenFacet> to(count_of(ranks_));
        for (const OpenFacet& facet : open_) {
            to[hash_of_all(facet.vertices) % to.size()].push_back(facet);
        }
        Array<OpenFacet> met = joined(ranks_.all_to_all(to));
        ListsByRank<Link> links(count_of(ranks_));
        const auto link = [&](const OpenFacet& from, const OpenFacet& across) {
            links[numbers_.rank_of(from.cell)].push_back({from.cell, from.place, across.cell});
        };
        const std::size_t left = join_open_facets(met, [&](const OpenFacet& a, const OpenFacet& b) {
            link(a, b);
            link(b, a);
        });
        require_closed_blocks(ranks_.sum(left), boundary_facets);
        for (const Array<Link>& list : ranks_.all_to_all(links)) {
            for (const auto& [cell, place, across] : list) {
                mesh_.neighbors[numbers_.row_of(cell)][place] = across;
            }
        }
    }

    /// As repair_slivers() of the whole: the first rank gets the cells around the vertices that may move.
    void repair(std::size_t fixed_points, double wanted) {
        const Array<Index> vertices = vertices_to_move(fixed_points, wanted);
        if (vertices.empty()) {
            return;
        }
        ListsByRank<CellOfCap> to(count_of(ranks_));
        to.front() = cells_around(vertices);
        Array<CellOfCap> region = joined(ranks_.all_to_all(to));
        Array<Point<3>> moved;
        if (ranks_.first()) {
            repair_region(std::move(region), fixed_points, wanted);
            for (const Index v : vertices) {
                moved.push_back(mesh_.points[v]);
            }
        }
        moved = ranks_.broadcast<Point<3>>(moved, 0);
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            mesh_.points[vertices[k]] = moved[k];
        }
    }

    CapMesh<3> ordered(std::size_t fixed_points, bool along_curve) && {
        mesh_.blocks = static_cast<int>(numbers_.blocks());
        return along_curve ? ordered_along_curve(std::move(mesh_), numbers_, fixed_points, ranks_)
                           : ordered_by_number(std::move(mesh_), numbers_, ranks_);
    }

private:
    /// Facet `place` of a cell, and the cell across.
    struct Link {
        Index cell;
        Index place;
        Index across;
    };
    struct CellOfCap {
        Index number;
        Simplex<3> vertices;
        Neighbors<3> neighbors;
    };

    void share_points(const DomainBlocks& blocks, std::span<const MeshedBlock> own) {
        Array<Point<3>> fresh;
        for (const MeshedBlock& block : own) {
            fresh.insert(fresh.end(),
                         block.mesh.points.begin() + static_cast<std::ptrdiff_t>(block.surface.vertex.size()),
                         block.mesh.points.end());
        }
        const ListsByRank<Point<3>> of_ranks = ranks_.all_gather<Point<3>>(fresh);
        std::vector<std::size_t> taken(of_ranks.size(), 0);
        mesh_.points.reserve(numbers_.points());
        mesh_.points = blocks.points;
        for (std::size_t block = 0; block < numbers_.blocks(); ++block) {
            const std::size_t rank = block % of_ranks.size();
            const auto begin = of_ranks[rank].begin() + static_cast<std::ptrdiff_t>(taken[rank]);
            taken[rank] += numbers_.new_points_of(block);
            mesh_.points.insert(mesh_.points.end(), begin,
                                of_ranks[rank].begin() + static_cast<std::ptrdiff_t>(taken[rank]));
        }
    }

    void take_cells(std::vector<MeshedBlock> own) {
        auto number = static_cast<std::size_t>(ranks_.rank());
        for (MeshedBlock& block : own) {
            number_in_cap(block, numbers_.place(number), open_);
            mesh_.cells.insert(mesh_.cells.end(), block.mesh.cells.begin(), block.mesh.cells.end());
            mesh_.neighbors.insert(mesh_.neighbors.end(), block.mesh.neighbors.begin(),
                                   block.mesh.neighbors.end());
            block = {};
            number += count_of(ranks_);
        }
    }

    /// The vertices of slivers that are not fixed, ascending. All ranks get all.
    Array<Index> vertices_to_move(std::size_t fixed_points, double wanted) {
        Array<Index> mine;
        for (const Index cell : find_slivers(mesh_, wanted)) {
            std::copy_if(mesh_.cells[cell].begin(), mesh_.cells[cell].end(), std::back_inserter(mine),
                         [=](Index v) { return v >= fixed_points; });
        }
        Array<Index> all = joined(ranks_.all_gather<Index>(mine));
        sort_out(all);
        return all;
    }

    /// Those of this rank.
    Array<CellOfCap> cells_around(const Array<Index>& vertices) const {
        std::vector<bool> moves(mesh_.points.size(), false);
        for (const Index v : vertices) {
            moves[v] = true;
        }
        const Array<Index> numbers = numbers_.numbers_of_rows();
        Array<CellOfCap> around;
        for (std::size_t row = 0; row < mesh_.cells.size(); ++row) {
            const Simplex<3>& cell = mesh_.cells[row];
            if (std::any_of(cell.begin(), cell.end(), [&](Index v) { return moves[v]; })) {
                around.push_back({numbers[row], cell, mesh_.neighbors[row]});
            }
        }
        return around;
    }

    /// Moves points. The cells keep their order, so that they are repaired as among all others.
    void repair_region(Array<CellOfCap> cells, std::size_t fixed_points, double wanted) {
        const auto by_number = [](const CellOfCap& a, const CellOfCap& b) { return a.number < b.number; };
        std::sort(cells.begin(), cells.end(), by_number);
        const auto place_of = [&](Index number) {
            const auto at =
                std::lower_bound(cells.begin(), cells.end(), CellOfCap{number, {}, {}}, by_number);
            return at != cells.end() && at->number == number ? static_cast<Index>(at - cells.begin())
                                                             : no_index;
        };
        CapMesh<3> region;
        region.points = std::move(mesh_.points);
        for (const CellOfCap& cell : cells) {
            region.cells.push_back(cell.vertices);
            Neighbors<3> neighbors = cell.neighbors;
            std::transform(neighbors.begin(), neighbors.end(), neighbors.begin(), place_of);
            region.neighbors.push_back(neighbors);
        }
        repair_slivers(region, fixed_points, wanted);
        mesh_.points = std::move(region.points);
    }

    Communicator& ranks_;
    BlockNumbers numbers_;
    CapMesh<3> mesh_; ///< cells of this rank's blocks; their neighbours have the cap's numbers
    std::vector<OpenFacet> open_;
};

} // namespace

CapMesh<3> mesh_in_ranks(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options) {
    Communicator& ranks = *options.ranks;
    std::optional<SizeField<3>> size;
    DomainBlocks blocks;
    if (ranks.first()) {
        size = wanted_size(surface, options);
        blocks = cut_domain(boundary, surface, *size, options.grading.growth, sample_load(surface, *size),
                            options.blocks);
    }
    size = size_of_first(ranks.first() ? &*size : nullptr, blocks, ranks);
    blocks = blocks_of_first(blocks, ranks);
    std::vector<MeshedBlock> own = own_blocks(blocks, *size, options);
    size.reset();
    RankJoiner joiner{blocks, std::move(own), ranks};
    joiner.join(surface.facets.size());
    joiner.repair(surface.points.size(), options.min_dihedral); // interfaces may move now
    return std::move(joiner).ordered(surface.points.size(), options.curve_order);
}

} // namespace slabhull
