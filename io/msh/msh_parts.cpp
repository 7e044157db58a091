// SPDX-License-Identifier: BSD-3-Clause
#include "io/msh/msh_parts.h"

#include "io/mesh/cell_groups.h"
#include "io/mesh/column_stream.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace slabhull::io {

Box box_of(const Column<double>& points) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr std::size_t grain = 65536;
    const std::size_t pieces = (points.rows() + grain - 1) / grain;
    std::vector<Box> boxes(pieces, {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}});
    parallel_for(points.rows(), grain, [&](std::size_t begin, std::size_t end) {
        Box& box = boxes[begin / grain];
        for_each_row(points, begin, end, [&](std::size_t, const double* x) {
            for (std::size_t i = 0; i < 3; ++i) {
                box.min[i] = std::min(box.min[i], x[i]);
                box.max[i] = std::max(box.max[i], x[i]);
            }
        });
    });
    Box whole = boxes.empty() ? Box{} : boxes.front();
    for (const Box& box : boxes) {
        for (std::size_t i = 0; i < 3; ++i) {
            whole.min[i] = std::min(whole.min[i], box.min[i]);
            whole.max[i] = std::max(whole.max[i], box.max[i]);
        }
    }
    return whole;
}

namespace {

void require_rows(const char* section, const std::vector<DataColumn>& columns) {
    for (const DataColumn& data : columns) {
        const std::size_t rows = rows_of(data);
        if (rows > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
            throw FormatLimit(
                fmt::format("\"{}\" has {} rows, but ${} in an MSH file counts in 32 bits; write VTU",
                            data.name, rows, section));
        }
    }
}

} // namespace

/// Checked before anything is written, so that the error does not come after an hour.
void require_msh_rows(const MeshColumns& mesh) {
    require_rows("NodeData", mesh.point_data);
    require_rows("ElementData", mesh.cell_data);
}

MshEntities::MshEntities(const std::vector<MeshColumns::Group>& groups) {
    for (const MeshColumns::Group& group : groups) {
        if (numbers_.emplace(group.number, groups_.size() + 1).second) {
            groups_.push_back(group.number);
        }
    }
}

std::vector<MshPart> msh_parts(const MeshColumns& mesh) {
    std::vector<MshPart> parts;
    std::size_t elements = 0;
    const auto add = [&](int dimension, const Column<std::int64_t>& cells,
                         const std::vector<MeshColumns::Group>& given) {
        auto groups = checked_groups(cells, given, "write_msh");
        auto entities = std::make_shared<const MshEntities>(groups);
        parts.push_back({dimension, cells, std::move(groups), std::move(entities), {elements, nullptr}});
        elements += cells.rows();
    };
    add(mesh.dimension, mesh.cells, mesh.groups);
    for (const MeshColumns::Part& part : mesh.lower) {
        add(part.dimension, part.cells, part.groups);
    }
    return parts;
}

} // namespace slabhull::io
