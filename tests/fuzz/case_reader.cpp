// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/harness.h"
#include "slabhull/cases/case.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fuzz {

using namespace slabhull;

namespace {

std::string fault_of(const Case& the_case) {
    constexpr int most_times = 100000; // a case may have as many slabs and layers as there is room for
    if (the_case.slabs > most_times || the_case.layers.value_or(1) > most_times) {
        return {};
    }
    for (const int slab : {0, the_case.slabs - 1}) {
        const std::vector<double> times = the_case.level_times(slab);
        for (std::size_t level = 0; level < times.size(); ++level) {
            if (!std::isfinite(times[level]) || (level > 0 && !(times[level] > times[level - 1]))) {
                return fmt::format("level {} of slab {} is at {}", level, slab, times[level]);
            }
        }
    }
    return {};
}

} // namespace

Outcome read_case_file(std::string_view bytes) {
    const auto read = read_or_refuse<Error>(read_case, folder().put("a.toml", bytes), bytes);
    require(read ? fault_of(*read) : "", "case");
    return read ? Outcome::read : Outcome::refused;
}

} // namespace fuzz
