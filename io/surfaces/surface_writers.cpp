// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "io/files/text_stream.h"
#include "io/mesh/column_stream.h"
#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"

#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace slabhull::io {

static_assert(std::endian::native == std::endian::little,
              "binary files are written in the machine's own byte order");

namespace {

void require_triangles(const MeshColumns& mesh, const char* format) {
    if (mesh.dimension != 2) {
        throw FormatLimit(fmt::format("{} files hold triangles, but this mesh has {}; write VTU or MSH",
                                      format, mesh.dimension == 3 ? "tetrahedra" : "lines"));
    }
}

void require_count(std::size_t count, std::size_t limit, const char* format, const char* what) {
    if (count > limit) {
        throw FormatLimit(fmt::format("{} files hold up to {} {}, but this mesh has {}; write VTU", format,
                                      limit, what, count));
    }
}

/// Writes rows of three numbers, each with a prefix and a line end.
template<class T>
void put_rows(TextStream& out, const Column<T>& column, std::string_view before, T offset) {
    for_each_row(column, 0, column.rows(), [&](std::size_t, const T* values) {
        out.put(before);
        for (int k = 0; k < 3; ++k) {
            out.number(values[k] + offset, k < 2 ? ' ' : '\n');
        }
    });
}

// --- STL ---

using Corners = std::array<Point<3>, 3>;

/// The unit normal by the right-hand rule; zero if the corners are collinear.
Point<3> unit_normal(const Corners& corners) {
    Point<3> normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    for (double& x : normal) {
        x = length > 0 ? x / length : 0;
    }
    return normal;
}

void put_single(char*& out, const Point<3>& x) {
    for (const double value : x) {
        put(out, static_cast<float>(value));
    }
}

void put_facet(char*& out, const Column<double>& points, const std::int64_t* vertices) {
    Corners corners{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto vertex = static_cast<std::size_t>(vertices[k]);
        points.fill(vertex, vertex + 1, corners[k].data());
    }
    put_single(out, unit_normal(corners));
    for (const Point<3>& corner : corners) {
        put_single(out, corner);
    }
    put(out, std::uint16_t{0});
}

void require_single(const Column<double>& points) {
    constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
    for_each_row(points, 0, points.rows(), [](std::size_t row, const double* x) {
        for (int k = 0; k < 3; ++k) {
            if (!(std::abs(x[k]) <= largest)) {
                throw FormatLimit(fmt::format("vertex {} has the coordinate {}, which single precision, all "
                                              "that STL has, cannot hold; write PLY",
                                              row, x[k]));
            }
        }
    });
}

} // namespace

void write_stl(AtomicFile& file, const MeshColumns& mesh) {
    constexpr std::size_t facet_bytes = 50;
    require_triangles(mesh, "STL");
    require_count(mesh.cells.rows(), std::numeric_limits<std::uint32_t>::max(), "STL", "triangles");
    require_single(mesh.points);
    file.write(fmt::format("{:<80}", "binary STL, normals by the right-hand rule"));
    const auto count = static_cast<std::uint32_t>(mesh.cells.rows());
    file.write(&count, sizeof count);
    stream_rows(file, mesh.cells.rows(), facet_bytes, [&](std::size_t begin, std::size_t end, char* out) {
        for_each_row(mesh.cells, begin, end, [&](std::size_t, const std::int64_t* vertices) {
            put_facet(out, mesh.points, vertices);
        });
    });
}

void write_off(AtomicFile& file, const MeshColumns& mesh) {
    require_triangles(mesh, "OFF");
    TextStream out{file};
    out.put(fmt::format("OFF\n{} {} 0\n", mesh.points.rows(), mesh.cells.rows()));
    put_rows(out, mesh.points, "", -0.0); // x + -0.0 is x, even for zeros
    put_rows<std::int64_t>(out, mesh.cells, "3 ", 0);
    out.flush();
}

void write_obj(AtomicFile& file, const MeshColumns& mesh) {
    require_triangles(mesh, "OBJ");
    TextStream out{file};
    put_rows(out, mesh.points, "v ", -0.0);
    put_rows<std::int64_t>(out, mesh.cells, "f ", 1);
    out.flush();
}

void write_ply(AtomicFile& file, const MeshColumns& mesh) {
    constexpr std::size_t face_bytes = 1 + 3 * sizeof(std::int32_t);
    require_triangles(mesh, "PLY");
    require_count(mesh.points.rows(), std::numeric_limits<std::int32_t>::max(), "PLY", "vertices");
    file.write(fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
                           "property double y\nproperty double z\nelement face {}\n"
                           "property list uchar int vertex_indices\nend_header\n",
                           mesh.points.rows(), mesh.cells.rows()));
    stream_rows(file, mesh.points.rows(), 3 * sizeof(double), stored_as<double>(mesh.points));
    stream_rows(file, mesh.cells.rows(), face_bytes, [&](std::size_t begin, std::size_t end, char* out) {
        for_each_row(mesh.cells, begin, end, [&](std::size_t, const std::int64_t* vertices) {
            put(out, std::uint8_t{3});
            for (int k = 0; k < 3; ++k) {
                put(out, static_cast<std::int32_t>(vertices[k]));
            }
        });
    });
}

void write_surface(const std::filesystem::path& path, const MeshColumns& mesh) {
    constexpr std::array<std::pair<std::string_view, void (*)(AtomicFile&, const MeshColumns&)>, 4> writers{
        {{".stl", write_stl}, {".off", write_off}, {".obj", write_obj}, {".ply", write_ply}}};
    const std::string extension = lower_extension(path);
    for (const auto& [name, write] : writers) {
        if (extension == name) {
            AtomicFile file{path};
            write(file, mesh);
            file.commit();
            return;
        }
    }
    throw UsageError(fmt::format("{}: a surface file .stl, .off, .obj or .ply was expected", path.string()));
}

} // namespace slabhull::io
