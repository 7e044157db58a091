// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_groups.h"
#include "column_stream.h"
#include "slabhull/core/point.h"
#include "slabhull/io/atomic_file.h"
#include "slabhull/io/soup.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace slabhull::io {

struct Box {
    Point<3> min;
    Point<3> max;
};

Box box_of(const Column<double>& points);

/// The cells of one dimension.
struct MshPart {
    using Group = MeshColumns::Group;

    int dimension;
    const Column<std::int64_t>& cells;
    std::vector<Group> groups;
    std::vector<PatchNumber> entities; ///< the number of each one's physical group; groups may share one
    std::size_t tags_before = 0;       ///< element tags used before this part's

    MshPart(int its_dimension, const Column<std::int64_t>& its_cells, const std::vector<Group>& given)
        : dimension{its_dimension}, cells{its_cells}, groups{checked_groups(its_cells, given, "write_msh")} {
        for (const Group& group : groups) {
            if (std::find(entities.begin(), entities.end(), group.number) == entities.end()) {
                entities.push_back(group.number);
            }
        }
    }

    std::size_t entity_of(const Group& group) const {
        const auto place = std::find(entities.begin(), entities.end(), group.number);
        return 1 + static_cast<std::size_t>(place - entities.begin());
    }
};

/// The cells first, so that their tags are their numbers from 1; then those of lower dimensions.
std::vector<MshPart> msh_parts(const MeshColumns& mesh);

/// What comes before the nodes in a binary file: the format, the groups' names and the entities, in
/// that box.
void write_msh_head(AtomicFile& file, const MeshColumns& mesh, const Box& box);
/// Throws LimitError where data have more rows than MSH can count.
void require_msh_rows(const MeshColumns& mesh);

/// The arrays that MSH makes of one: use(title, first, last) for each with the components from `first` to
/// before `last`. Gmsh knows reals of 3 or 9 components; all others go apart.
template<class Use>
void for_each_msh_array(const DataColumn& data, const Use& use) {
    const int components = components_of(data);
    if (data.type == Scalar::float64 && (components == 3 || components == 9)) {
        use(data.name, 0, components);
        return;
    }
    for (int k = 0; k < components; ++k) {
        use(components > 1 ? data.name + "_" + std::to_string(k) : data.name, k, k + 1);
    }
}

} // namespace slabhull::io
