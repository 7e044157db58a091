// SPDX-License-Identifier: BSD-3-Clause
#include "partition.h"

#include <cstdio>
#include <stdexcept>

#include <scotch.h> // needs FILE

namespace slabhull::bench {

namespace {

std::vector<std::int32_t> part(const CellGraph& graph, int parts) {
    static_assert(sizeof(SCOTCH_Num) == sizeof(std::int32_t));
    SCOTCH_randomSeed(1);
    SCOTCH_randomReset();
    SCOTCH_Graph in;
    SCOTCH_Strat strategy;
    std::vector<SCOTCH_Num> part_of(graph.first.size() - 1);
    SCOTCH_graphInit(&in);
    SCOTCH_stratInit(&strategy); // its own choice
    const bool done = SCOTCH_graphBuild(&in, 0, graph.cells(), graph.first.data(), graph.first.data() + 1,
                                        nullptr, nullptr, static_cast<SCOTCH_Num>(graph.targets.size()),
                                        graph.targets.data(), nullptr) == 0 &&
                      SCOTCH_graphPart(&in, parts, &strategy, part_of.data()) == 0;
    SCOTCH_stratExit(&strategy);
    SCOTCH_graphExit(&in);
    if (!done) {
        throw std::runtime_error{"Scotch gave up"};
    }
    return std::vector<std::int32_t>(part_of.begin(), part_of.end());
}

const bool added = add_partitioner({"scotch", part});

} // namespace

} // namespace slabhull::bench
