// SPDX-License-Identifier: BSD-3-Clause
#include "partition.h"

#include <metis.h>

#include <stdexcept>

namespace slabhull::bench {

namespace {

std::vector<std::int32_t> part(const CellGraph& graph, int parts) {
    static_assert(sizeof(idx_t) == sizeof(std::int32_t));
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    idx_t cells = graph.cells();
    idx_t constraints = 1;
    idx_t count = parts;
    idx_t cut = 0;
    std::vector<idx_t> part_of(graph.first.size() - 1);
    auto& lists = const_cast<CellGraph&>(graph); // METIS only reads them
    if (METIS_PartGraphKway(&cells, &constraints, lists.first.data(), lists.targets.data(), nullptr, nullptr,
                            nullptr, &count, nullptr, nullptr, options, &cut, part_of.data()) != METIS_OK) {
        throw std::runtime_error{"METIS gave up"};
    }
    return std::vector<std::int32_t>(part_of.begin(), part_of.end());
}

const bool added = add_partitioner({"metis", part});

} // namespace

} // namespace slabhull::bench
