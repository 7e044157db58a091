// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/text_stream.h"
#include "io/mesh/column_stream.h"
#include "io/mesh/scalar_data.h"

#include <fmt/format.h>

namespace slabhull::io {

namespace {

void write_vertices(TextStream& out, const MeshColumns& mesh, PointScalars<double>& time) {
    const std::size_t count = mesh.points.rows();
    for_each_row(mesh.points, 0, count, [&](std::size_t row, const double* x) {
        for (int k = 0; k < 3; ++k) {
            out.put(k > 0 ? "," : row > 0 ? ",\n" : "");
            out.number(x[k]);
        }
        if (time.given()) {
            out.put(",");
            out.number(time[row]);
        }
    });
}

void write_elements(TextStream& out, const MeshColumns& mesh) {
    for_each_row(mesh.cells, 0, mesh.cells.rows(), [&](std::size_t row, const std::int64_t* vertices) {
        for (int k = 0; k <= mesh.dimension; ++k) {
            out.put(k > 0 ? "," : row > 0 ? ",\n" : "");
            out.number(vertices[k]);
        }
    });
}

} // namespace

void write_avro(AtomicFile& file, const MeshColumns& mesh) {
    PointScalars<double> time;
    if (mesh.dimension == 3) { // else the third coordinate is the time
        time = {mesh, "t"};
    }
    TextStream out{file};
    out.put(fmt::format(
        "{{\"dim\": {}, \"number\": {}, \"nb_ghost\": 0, \"type\": \"simplex\",\n\"vertices\": [\n",
        time.given() ? 4 : 3, mesh.dimension));
    write_vertices(out, mesh, time);
    out.put("\n],\n\"elements\": [\n");
    write_elements(out, mesh);
    out.put("\n]}\n");
    out.flush();
}

void write_avro(const std::filesystem::path& path, const MeshColumns& mesh) {
    AtomicFile file{path};
    write_avro(file, mesh);
    file.commit();
}

} // namespace slabhull::io
