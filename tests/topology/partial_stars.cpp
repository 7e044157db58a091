// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/partial_stars.h"

#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/manifold.h"
#include "topology/specimens.h"

#include <catch2/catch.hpp>

#include <optional>
#include <random>

using namespace slabhull;
using specimens::Complex;

namespace {

/// A range of a complex's cells, and all others at vertices that no earlier range uses.
template<int D>
struct Part {
    Array<Neighbors<D>> own_neighbors;
    Array<Index> outside;
    Array<Simplex<D>> ghosts;
    Array<Neighbors<D>> ghost_neighbors;
    Array<std::uint8_t> wanted;
    std::span<const Simplex<D>> own;

    Part(const Complex<D>& complex, const Array<Neighbors<D>>& neighbors, std::size_t begin, std::size_t end)
        : own{std::span{complex.cells}.subspan(begin, end - begin)} {
        wanted.assign(complex.vertices, 0);
        for (std::size_t c = end; c-- > 0;) {
            for (const Index v : complex.cells[c]) {
                wanted[v] = c >= begin ? 1 : 0;
            }
        }
        Array<Index> here; // by cell of the complex
        here.assign(complex.cells.size(), no_index);
        std::vector<std::size_t> of_ghosts;
        for (std::size_t c = 0; c < complex.cells.size(); ++c) {
            const Simplex<D>& cell = complex.cells[c];
            if (begin <= c && c < end) {
                here[c] = static_cast<Index>(c - begin);
            } else if (std::any_of(cell.begin(), cell.end(), [&](Index v) { return wanted[v] != 0; })) {
                here[c] = static_cast<Index>(own.size() + ghosts.size());
                ghosts.push_back(cell);
                of_ghosts.push_back(c);
            }
        }
        const auto place = [&](Index cell) { return cell < here.size() ? here[cell] : no_index; };
        for (std::size_t c = begin; c < end; ++c) {
            Neighbors<D>& across = own_neighbors.emplace_back();
            for (std::size_t i = 0; i <= D; ++i) {
                across[i] = place(neighbors[c][i]);
                if (across[i] >= own.size()) {
                    outside.push_back(across[i]);
                    across[i] = static_cast<Index>(own.size() + outside.size() - 1);
                }
            }
        }
        for (const std::size_t c : of_ghosts) {
            Neighbors<D>& across = ghost_neighbors.emplace_back();
            for (std::size_t i = 0; i <= D; ++i) {
                across[i] = place(neighbors[c][i]);
            }
        }
    }

    PartialMesh<D> mesh() const { return {own, own_neighbors, outside, ghosts, ghost_neighbors, wanted}; }
};

/// What the parts confirm together; empty if one does not.
template<int D>
std::optional<StarCounts> confirmed_in_parts(const Complex<D>& complex, const Array<Neighbors<D>>& neighbors,
                                             std::size_t parts) {
    StarCounts all;
    for (std::size_t p = 0; p < parts; ++p) {
        const std::size_t count = complex.cells.size();
        const Part<D> part{complex, neighbors, count * p / parts, count * (p + 1) / parts};
        const auto here = confirm_stars<D>(part.mesh());
        if (!here) {
            return std::nullopt;
        }
        all.vertices += here->vertices;
        all.link_vertices += here->link_vertices;
    }
    return all.vertices == complex.vertices ? std::optional{all} : std::nullopt;
}

/// Parts say of a complex what confirm_manifold() does of it as a whole.
template<int D>
void require_same_verdict(const Complex<D>& complex, const Array<Neighbors<D>>& neighbors) {
    const auto whole = confirm_manifold<D>(complex.cells, complex.vertices, neighbors);
    for (std::size_t parts = 1; parts <= 5; ++parts) {
        CAPTURE(parts);
        const auto in_parts = confirmed_in_parts(complex, neighbors, parts);
        REQUIRE(in_parts.has_value() == whole.has_value());
        if (whole && D == 3) {
            REQUIRE(in_parts->link_vertices == 2 * whole->counts.edges);
        }
    }
}

template<int D>
void require_same_verdict(const Complex<D>& complex) {
    require_same_verdict(complex, build_adjacency<D>(complex.cells, complex.vertices).neighbors);
}

} // namespace

TEST_CASE("parts of manifolds confirm together what the whole does") {
    require_same_verdict(specimens::sphere<2>());
    require_same_verdict(specimens::shuffled(specimens::torus<2>(5), 3));
    require_same_verdict(specimens::disjoint_union(specimens::sphere<2>(), specimens::torus<2>(3)));
    require_same_verdict(specimens::sphere<3>());
    require_same_verdict(specimens::torus<3>(4));
    require_same_verdict(specimens::shuffled(specimens::torus<3>(4), 5));
    require_same_verdict(specimens::refined(specimens::projective_space()));
}

TEST_CASE("parts find what is not a manifold, wherever it is") {
    for (std::size_t at = 0; at < 384; at += 29) {
        CAPTURE(at);
        auto holed = specimens::torus<3>(4);
        holed.cells.erase(holed.cells.begin() + static_cast<std::ptrdiff_t>(at));
        require_same_verdict(holed);
        auto doubled = specimens::torus<3>(4);
        doubled.cells.push_back(doubled.cells[at]);
        require_same_verdict(doubled);
        auto turned = specimens::torus<3>(4);
        specimens::flip(turned.cells[at]);
        require_same_verdict(turned);
        auto repeated = specimens::torus<3>(4);
        repeated.cells[at][0] = repeated.cells[at][1];
        require_same_verdict(repeated);
        auto pinched = specimens::disjoint_union(specimens::sphere<3>(), specimens::torus<3>(4));
        specimens::merge_vertices(pinched, 0, static_cast<Index>(5 + at % 64));
        require_same_verdict(pinched);
    }
    require_same_verdict(Complex<3>{{{0, 1, 2, 3}, {1, 0, 2, 3}}, 4});
    require_same_verdict(specimens::suspension(specimens::torus<2>(4)));
}

TEST_CASE("parts trust no neighbour that they are told of") {
    std::mt19937 random{4};
    const auto complex = specimens::torus<3>(4);
    const auto neighbors = build_adjacency<3>(complex.cells, complex.vertices).neighbors;
    for (int round = 0; round < 200; ++round) {
        CAPTURE(round);
        auto claimed = neighbors;
        claimed[random() % claimed.size()][random() % 4] =
            round % 9 == 0 ? no_index : static_cast<Index>(random() % (claimed.size() + 2));
        require_same_verdict(complex, claimed);
        REQUIRE(confirmed_in_parts(complex, claimed, 3).has_value() == (claimed == neighbors));
    }
}
