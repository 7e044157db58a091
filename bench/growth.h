// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <map>

namespace slabhull::bench {

/// The exponent e of seconds ~ size^e over the runs of one bench: least squares over logarithms, of each
/// size's shortest time. Keep one per series of sizes, and show it where two or more sizes have run:
///     growth.add(cells, watch.seconds());                                      // for every iteration
///     if (growth.known()) { state.counters["growth"] = growth.exponent(); }
class Growth {
public:
    void add(double size, double seconds) {
        const auto [shortest, fresh] = shortest_.try_emplace(size, seconds);
        shortest->second = std::min(shortest->second, seconds);
    }

    bool known() const { return shortest_.size() > 1; }

    double exponent() const {
        double x_mean = 0, y_mean = 0;
        for (const auto& [size, seconds] : shortest_) {
            x_mean += std::log(size) / static_cast<double>(shortest_.size());
            y_mean += std::log(seconds) / static_cast<double>(shortest_.size());
        }
        double xx = 0, xy = 0;
        for (const auto& [size, seconds] : shortest_) {
            const double x = std::log(size) - x_mean;
            xx += x * x;
            xy += x * (std::log(seconds) - y_mean);
        }
        return xy / xx;
    }

private:
    std::map<double, double> shortest_; ///< seconds by size
};

} // namespace slabhull::bench
