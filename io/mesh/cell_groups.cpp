// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/cell_groups.h"

#include <fmt/format.h>
#include <set>
#include <stdexcept>

namespace slabhull::io {

std::vector<MeshColumns::Group> checked_groups(const Column<std::int64_t>& cells,
                                               const std::vector<MeshColumns::Group>& groups,
                                               const char* writer) {
    if (groups.empty()) {
        return {{0, cells.rows(), 0, ""}};
    }
    std::size_t end = 0;
    for (const MeshColumns::Group& group : groups) {
        if (group.begin != end || group.end < group.begin) {
            throw std::invalid_argument{fmt::format("{}: the groups must follow one another", writer)};
        }
        end = group.end;
    }
    if (end != cells.rows()) {
        throw std::invalid_argument{fmt::format("{}: the groups must hold all cells", writer)};
    }
    return groups;
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
