// SPDX-License-Identifier: BSD-3-Clause
// The format is described at https://mfem.org/mesh-format-v1.0, "Straight meshes".
#include "slabhull/io/files.h"

#include "io/files/text_stream.h"
#include "io/mesh/cell_groups.h"
#include "io/mesh/column_stream.h"
#include "io/others/mfem_types.h"
#include "slabhull/core/error.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <set>

namespace slabhull::io {

namespace {

/// The facet with the orientation that its cell induces.
template<int D>
Facet<D> oriented(Facet<D> facet, const Simplex<D>& cell) {
    const auto apex = std::find_if(cell.begin(), cell.end(), [&](Index vertex) {
        return std::find(facet.begin(), facet.end(), vertex) == facet.end();
    });
    std::copy_if(cell.begin(), cell.end(), facet.begin(), [&](const Index& one) { return &one != &*apex; });
    if (D > 1 && (apex - cell.begin()) % 2 == 1) {
        std::swap(facet[0], facet[static_cast<std::size_t>(D - 1)]);
    }
    return facet;
}

/// Adjacency is defined only for cells with distinct vertices.
template<int D>
void require_distinct(Simplex<D> cell, std::size_t row) {
    std::sort(cell.begin(), cell.end());
    if (const auto twice = std::adjacent_find(cell.begin(), cell.end()); twice != cell.end()) {
        throw FormatLimit(
            fmt::format("cell {} has the vertex {} twice, so that the boundary, which MFEM meshes "
                        "need, is not defined; remove the cell",
                        row, *twice));
    }
}

/// The facets of one cell only, in the order of their vertices' numbers.
template<int D>
std::vector<Facet<D>> boundary_of(const MeshColumns& mesh) {
    Array<Simplex<D>> cells(mesh.cells.rows());
    for_each_row(mesh.cells, 0, cells.size(), [&](std::size_t row, const std::int64_t* vertices) {
        std::transform(vertices, vertices + D + 1, cells[row].begin(),
                       [](std::int64_t vertex) { return static_cast<Index>(vertex); });
        require_distinct<D>(cells[row], row);
    });
    std::vector<Facet<D>> boundary;
    for (const auto& defect : build_adjacency<D>(cells, mesh.points.rows()).defects) {
        if (defect.kind == FacetDefect<D>::Kind::open) {
            boundary.push_back(oriented<D>(defect.facet, cells[defect.cells.front()]));
        }
    }
    return boundary;
}

template<int D>
void write_found_boundary(TextStream& out, const MeshColumns& mesh) {
    const std::vector<Facet<D>> boundary = boundary_of<D>(mesh);
    out.put(fmt::format("\nboundary\n{}\n", boundary.size()));
    for (const Facet<D>& facet : boundary) {
        out.put(fmt::format("1 {} ", mfem_simplex_type(D - 1)));
        out.numbers(facet.data(), facet.size(), '\n');
    }
}

void write_found_boundary(TextStream& out, const MeshColumns& mesh) {
    switch (mesh.dimension) {
    case 1:
        return write_found_boundary<1>(out, mesh);
    case 2:
        return write_found_boundary<2>(out, mesh);
    default:
        return write_found_boundary<3>(out, mesh);
    }
}

/// A number that no group has: the one after the largest or, where there is none, the smallest.
PatchNumber free_number(const std::vector<MeshColumns::Group>& groups) {
    std::set<PatchNumber> used{0};
    for (const MeshColumns::Group& group : groups) {
        used.insert(group.number);
    }
    if (*used.rbegin() < std::numeric_limits<PatchNumber>::max()) {
        return *used.rbegin() + 1;
    }
    PatchNumber number = 1;
    while (used.contains(number)) {
        ++number;
    }
    return number;
}

/// Attributes are positive: cells without a group get a number of their own.
void write_elements(TextStream& out, const char* section, int dimension, const Column<std::int64_t>& cells,
                    const std::vector<MeshColumns::Group>& given) {
    const std::vector<MeshColumns::Group> groups = checked_groups(cells, given, "write_mfem");
    const PatchNumber of_none = free_number(groups);
    out.put(fmt::format("\n{}\n{}\n", section, cells.rows()));
    for (const MeshColumns::Group& group : groups) {
        const std::string head =
            fmt::format("{} {} ", group.number > 0 ? group.number : of_none, mfem_simplex_type(dimension));
        for_each_row(cells, group.begin, group.end, [&](std::size_t, const std::int64_t* vertices) {
            out.put(head);
            out.numbers(vertices, static_cast<std::size_t>(dimension) + 1, '\n');
        });
    }
}

/// Writes the mesh's simplices of one dimension less, if any; else all facets of one cell only.
void write_boundary(TextStream& out, const MeshColumns& mesh) {
    const auto told = std::find_if(mesh.lower.begin(), mesh.lower.end(), [&](const MeshColumns::Part& part) {
        return part.dimension == mesh.dimension - 1;
    });
    told == mesh.lower.end() ? write_found_boundary(out, mesh)
                             : write_elements(out, "boundary", told->dimension, told->cells, told->groups);
}

bool lies_in_plane(const MeshColumns& mesh) {
    bool flat = mesh.dimension < 3;
    for_each_row(mesh.points, 0, flat ? mesh.points.rows() : 0,
                 [&](std::size_t, const double* x) { flat = flat && x[2] == 0 && !std::signbit(x[2]); });
    return flat;
}

void write_vertices(TextStream& out, const MeshColumns& mesh) {
    const std::size_t width = lies_in_plane(mesh) ? 2 : 3;
    out.put(fmt::format("\nvertices\n{}\n{}\n", mesh.points.rows(), width));
    for_each_row(mesh.points, 0, mesh.points.rows(),
                 [&](std::size_t, const double* x) { out.numbers(x, width, '\n'); });
}

} // namespace

void write_mfem(AtomicFile& file, const MeshColumns& mesh) {
    constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max();
    if (mesh.points.rows() > limit || mesh.cells.rows() > limit) {
        throw FormatLimit(fmt::format("MFEM counts in 32 bits, but this mesh has {} vertices and {} cells",
                                      mesh.points.rows(), mesh.cells.rows()));
    }
    TextStream out{file};
    out.put(fmt::format("MFEM mesh v1.0\n\ndimension\n{}\n", mesh.dimension));
    write_elements(out, "elements", mesh.dimension, mesh.cells, mesh.groups);
    write_boundary(out, mesh);
    write_vertices(out, mesh);
    out.flush();
}

void write_mfem(const std::filesystem::path& path, const MeshColumns& mesh) {
    AtomicFile file{path};
    write_mfem(file, mesh);
    file.commit();
}

} // namespace slabhull::io
