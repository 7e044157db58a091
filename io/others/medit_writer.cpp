// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/text_stream.h"
#include "io/mesh/cell_groups.h"
#include "io/mesh/column_stream.h"
#include "io/mesh/scalar_data.h"
#include "slabhull/core/error.h"

#include <array>
#include <limits>

namespace slabhull::io {

namespace {

class MeditWriter {
public:
    MeditWriter(AtomicFile& file, const MeshColumns& mesh, const MeditOptions& options)
        : mesh_{mesh}, out_{file}, references_{mesh, "medit:ref"} {
        if (options.four_dimensional) {
            time_ = {mesh, "t"};
            if (!time_.given()) {
                throw UsageError("a Medit file of four dimensions needs the times of points, the point data "
                                 "\"t\"; this mesh has none");
            }
        }
    }

    void write() {
        constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max();
        const bool large = mesh_.points.rows() > limit || mesh_.cells.rows() > limit;
        out_.put(large ? "MeshVersionFormatted 4\n" : "MeshVersionFormatted 2\n");
        out_.put(time_.given() ? "Dimension 4\n" : "Dimension 3\n");
        write_vertices();
        write_cells(mesh_.dimension, mesh_.cells, mesh_.groups);
        for (const MeshColumns::Part& part : mesh_.lower) {
            if (part.dimension > 0) { // Medit's corners are not cells
                write_cells(part.dimension, part.cells, part.groups);
            }
        }
        out_.put("End\n");
        out_.flush();
    }

private:
    void write_vertices() {
        out_.put("Vertices\n");
        out_.number(mesh_.points.rows(), '\n');
        for_each_row(mesh_.points, 0, mesh_.points.rows(), [&](std::size_t row, const double* x) {
            out_.numbers(x, 3, ' ');
            if (time_.given()) {
                out_.number(time_[row], ' ');
            }
            out_.number(references_.given() ? references_[row] : 0, '\n');
        });
    }

    void write_cells(int dimension, const Column<std::int64_t>& cells,
                     const std::vector<MeshColumns::Group>& groups) {
        constexpr std::array<std::string_view, 3> names{"Edges\n", "Triangles\n", "Tetrahedra\n"};
        const auto corners = static_cast<std::size_t>(dimension) + 1;
        out_.put(names.at(corners - 2));
        out_.number(cells.rows(), '\n');
        for (const MeshColumns::Group& group : checked_groups(cells, groups, "write_medit")) {
            for_each_row(cells, group.begin, group.end, [&](std::size_t, const std::int64_t* vertices) {
                for (std::size_t k = 0; k < corners; ++k) {
                    out_.number(vertices[k] + 1, ' ');
                }
                out_.number(group.number, '\n');
            });
        }
    }

    const MeshColumns& mesh_;
    TextStream out_;
    PointScalars<double> time_; ///< only used in four dimensions
    PointScalars<std::int64_t> references_;
};

} // namespace

void write_medit(AtomicFile& file, const MeshColumns& mesh, const MeditOptions& options) {
    MeditWriter{file, mesh, options}.write();
}

void write_medit(const std::filesystem::path& path, const MeshColumns& mesh, const MeditOptions& options) {
    AtomicFile file{path};
    write_medit(file, mesh, options);
    file.commit();
}

} // namespace slabhull::io
