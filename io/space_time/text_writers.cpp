// SPDX-License-Identifier: BSD-3-Clause
// MFEM: https://mfem.org/mesh-format-v1.0. GetFEM: getfem_mesh.cc, write_to_file().
#include "slabhull/io/space_time_files.h"

#include "io/files/text_stream.h"
#include "io/mesh/column_stream.h"
#include "io/others/mfem_types.h"
#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <vector>

namespace slabhull::io {

namespace {

void put_count(TextStream& out, std::string_view section, std::size_t count) {
    out.put(fmt::format("\n{}\n{}\n", section, count));
}

/// The facets of each attribute, ascending.
std::map<std::int64_t, std::vector<std::int64_t>> sides_by_attribute(const SpaceTimeColumns& mesh) {
    std::vector<std::int64_t> attribute(mesh.facets.rows());
    mesh.facet_attribute.fill(0, attribute.size(), attribute.data());
    std::map<std::int64_t, std::vector<std::int64_t>> sides;
    for_each_row(mesh.facet_side, 0, attribute.size(),
                 [&](std::size_t f, const std::int64_t* side) { sides[attribute[f]].push_back(*side); });
    return sides;
}

} // namespace

void write_mfem(AtomicFile& file, const SpaceTimeColumns& mesh, int pentatope_code) {
    constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max();
    if (mesh.points.rows() > limit || mesh.cells.rows() > limit) {
        throw LimitError{fmt::format("MFEM counts in 32 bits, but this mesh has {} vertices and {} cells",
                                     mesh.points.rows(), mesh.cells.rows())};
    }
    const auto width = static_cast<std::size_t>(mesh.dimension);
    const std::string head =
        fmt::format("1 {} ", mesh.dimension == 4 ? pentatope_code : mfem_simplex_type(mesh.dimension));
    const std::string facet_type = fmt::format("{} ", mfem_simplex_type(mesh.dimension - 1));
    std::vector<std::int64_t> attribute(mesh.facets.rows());
    mesh.facet_attribute.fill(0, attribute.size(), attribute.data());
    TextStream out{file};
    out.put(fmt::format("MFEM mesh v1.0\n\ndimension\n{}\n", mesh.dimension));
    put_count(out, "elements", mesh.cells.rows());
    for_each_row(mesh.cells, 0, mesh.cells.rows(), [&](std::size_t, const std::int64_t* vertices) {
        out.put(head);
        out.numbers(vertices, width + 1, '\n');
    });
    put_count(out, "boundary", mesh.facets.rows());
    for_each_row(mesh.facets, 0, mesh.facets.rows(), [&](std::size_t f, const std::int64_t* vertices) {
        out.number(attribute[f], ' ');
        out.put(facet_type);
        out.numbers(vertices, width, '\n');
    });
    put_count(out, "vertices", mesh.points.rows());
    out.put(fmt::format("{}\n", mesh.dimension));
    for_each_row(mesh.points, 0, mesh.points.rows(),
                 [&](std::size_t, const double* x) { out.numbers(x, width, '\n'); });
    out.flush();
}

void write_getfem(AtomicFile& file, const SpaceTimeColumns& mesh) {
    const auto width = static_cast<std::size_t>(mesh.dimension);
    const std::string kind = fmt::format(" 'GT_PK({},1)' ", mesh.dimension);
    TextStream out{file};
    out.put(
        fmt::format("% GETFEM MESH FILE\n% GETFEM VERSION 5.4.2\n\nBEGIN POINTS LIST\n\n  POINT COUNT {}\n",
                    mesh.points.rows()));
    for_each_row(mesh.points, 0, mesh.points.rows(), [&](std::size_t v, const double* x) {
        out.put("  POINT ");
        out.number(v, ' ');
        out.numbers(x, width, '\n');
    });
    out.put(fmt::format("\nEND POINTS LIST\n\nBEGIN MESH STRUCTURE DESCRIPTION\n\nCONVEX COUNT {}\n",
                        mesh.cells.rows()));
    for_each_row(mesh.cells, 0, mesh.cells.rows(), [&](std::size_t c, const std::int64_t* vertices) {
        out.put("CONVEX ");
        out.number(c);
        out.put(kind);
        out.numbers(vertices, width + 1, '\n');
    });
    out.put("\nEND MESH STRUCTURE DESCRIPTION\n");
    for (const auto& [attribute, sides] : sides_by_attribute(mesh)) {
        out.put(fmt::format("BEGIN REGION {}\n", attribute));
        for (const std::int64_t side : sides) {
            out.number(side / (mesh.dimension + 1), '/');
            out.number(side % (mesh.dimension + 1), '\n');
        }
        out.put(fmt::format("END REGION {}\n", attribute));
    }
    out.flush();
}

} // namespace slabhull::io
