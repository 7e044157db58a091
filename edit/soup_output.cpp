// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/edit/soup_output.h"

#include "slabhull/core/patch.h"
#include "slabhull/edit/soup_numbers.h"

namespace slabhull {

void settle_groups(const io::Format& format, io::Soup& soup) {
    const bool arrays_stay =
        io::stores(format, soup, io::ArrayAssociation::cells, {"patch", 1, IntegerList{}});
    const PatchList& groups = soup.groups[static_cast<std::size_t>(soup.top_dimension())];
    if (format.features.groups && (format.features.group_names || !arrays_stay)) {
        arrays_to_groups(soup);
    } else if (!format.features.groups || patch_number(groups, "terminating") != 0) {
        groups_to_arrays(soup);
    }
}

io::MeshColumns columns_to_write(const io::Soup& soup) {
    io::MeshColumns mesh = io::columns_of(soup);
    for (io::DataColumn& column : mesh.cell_data) {
        if (column.type == io::Scalar::int64 &&
            (column.name == "region" || column.name == "patch" || column.name == "layer")) {
            column.type = io::Scalar::int32;
        }
    }
    return mesh;
}

} // namespace slabhull
