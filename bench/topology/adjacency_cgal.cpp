// SPDX-License-Identifier: BSD-3-Clause
#include "adjacency_peers.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_3/tet_soup_to_c3t3.h>
#include <CGAL/Tetrahedral_remeshing/Remeshing_triangulation_3.h>

#include <map>
#include <memory>
#include <stdexcept>

namespace slabhull::bench {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Tetrahedral_remeshing::Remeshing_triangulation_3<Kernel>;
using Patches = std::map<std::array<int, 3>, Triangulation::Cell::Surface_patch_index>;

struct Input {
    std::vector<Triangulation::Point> points;
    std::vector<std::array<int, 5>> cells; ///< four vertices, and a number to be kept with the cell: its own
};

Input input_of(const TetSoup& soup) {
    Input input;
    for (std::size_t v = 0; v < soup.point_count; ++v) {
        input.points.emplace_back(Kernel::Point_3{soup.points[v][0], soup.points[v][1], soup.points[v][2]});
    }
    for (std::size_t c = 0; c < soup.cell_count; ++c) {
        const Quad& cell = soup.cells[c];
        input.cells.push_back({static_cast<int>(cell[0]), static_cast<int>(cell[1]),
                               static_cast<int>(cell[2]), static_cast<int>(cell[3]), static_cast<int>(c)});
    }
    return input;
}

/// What CGAL reads its .mesh files with: cells of a triangulation data structure, joined through a hash map
/// of facets. Without the check of the whole at the end.
Peer::Find build_triangulation(const TetSoup& soup) {
    return [input = std::make_shared<Input>(input_of(soup))](Quad* result) {
        constexpr bool no_check = true;
        Triangulation triangulation;
        std::vector<Triangulation::Vertex_handle> vertices;
        if (!CGAL::build_triangulation<Triangulation, no_check>(triangulation, input->points, input->cells,
                                                                Patches{}, vertices)) {
            throw std::runtime_error{"CGAL did not take the soup"};
        }
        for (const auto cell : triangulation.finite_cell_handles()) {
            for (int i = 0; i < 4; ++i) {
                const auto other = cell->neighbor(i);
                result[cell->subdomain_index()][static_cast<std::size_t>(i)] =
                    triangulation.is_infinite(other) ? no_cell
                                                     : static_cast<std::uint32_t>(other->subdomain_index());
            }
        }
    };
}

const bool added = add_peer({"cgal_build_triangulation", 9, build_triangulation});

} // namespace

} // namespace slabhull::bench
