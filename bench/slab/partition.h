// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace slabhull::bench {

/// The dual graph of a hull as lists: the neighbours of cell c are targets[first[c]] up to first[c + 1].
struct CellGraph {
    std::vector<std::int32_t> first;
    std::vector<std::int32_t> targets;
    std::int32_t cells() const { return static_cast<std::int32_t>(first.size()) - 1; }
};

/// A way to part the cells: the part of each.
struct Partitioner {
    std::string name;
    std::function<std::vector<std::int32_t>(const CellGraph&, int parts)> part;
};

/// Each peer's .cpp adds its own, where its library is installed.
inline std::vector<Partitioner>& partitioners() {
    static std::vector<Partitioner> all;
    return all;
}

inline bool add_partitioner(Partitioner partitioner) {
    partitioners().push_back(std::move(partitioner));
    return true;
}

} // namespace slabhull::bench
