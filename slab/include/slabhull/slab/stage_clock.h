// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/stopwatch.h"

#include <string>
#include <utility>
#include <vector>

namespace slabhull {

/// Seconds by stage, in the order in which the stages first came.
class StageClock {
public:
    /// Books the time since the last call (or the start) on `stage`.
    void book(const std::string& stage) {
        const double passed = watch_.lap();
        for (auto& [name, seconds] : stages_) {
            if (name == stage) {
                seconds += passed;
                return;
            }
        }
        stages_.emplace_back(stage, passed);
    }
    const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
    /// Of all stages, in seconds.
    double total() const {
        double sum = 0;
        for (const auto& stage : stages_) {
            sum += stage.second;
        }
        return sum;
    }

private:
    Stopwatch watch_;
    std::vector<std::pair<std::string, double>> stages_;
};

} // namespace slabhull
