// SPDX-License-Identifier: BSD-3-Clause
#include "cell_groups.h"

#include <fmt/format.h>
#include <set>
#include <stdexcept>

namespace slabhull::io {

std::vector<MeshColumns::Group> groups_of(const MeshColumns& mesh, const char* writer) {
    if (mesh.groups.empty()) {
        return {{0, mesh.cells.rows(), 0, ""}};
    }
    std::size_t end = 0;
    for (const MeshColumns::Group& group : mesh.groups) {
        if (group.begin != end || group.end < group.begin) {
            throw std::invalid_argument{fmt::format("{}: the groups must follow one another", writer)};
        }
        end = group.end;
    }
    if (end != mesh.cells.rows()) {
        throw std::invalid_argument{fmt::format("{}: the groups must hold all cells", writer)};
    }
    return mesh.groups;
}

void list_groups_in_use(Soup& soup) {
    for (std::size_t dimension = 0; dimension < soup.simplices.size(); ++dimension) {
        const auto& physical = soup.simplices[dimension].physical;
        for (const PatchNumber number : std::set<PatchNumber>(physical.begin(), physical.end())) {
            if (number > 0) {
                soup.groups[dimension].push_back({number, ""});
            }
        }
    }
}

} // namespace slabhull::io
