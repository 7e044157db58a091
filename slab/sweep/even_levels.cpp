// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/layers.h"

namespace slabhull {

std::vector<double> even_levels(double begin, double end, std::size_t layers) {
    const auto wanted = static_cast<double>(layers);
    std::vector<double> times;
    for (double layer = 0; layer < wanted; ++layer) {
        times.push_back(begin + (end - begin) * layer / wanted);
    }
    times.push_back(end);
    return times;
}

std::vector<double> halved_levels(const std::vector<double>& times) {
    std::vector<double> finer{times.front()};
    for (std::size_t k = 1; k < times.size(); ++k) {
        finer.push_back(0.5 * (times[k - 1] + times[k]));
        finer.push_back(times[k]);
    }
    return finer;
}

} // namespace slabhull
