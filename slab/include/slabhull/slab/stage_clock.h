// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/progress.h"
#include "slabhull/core/stopwatch.h"

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace slabhull {

// Names of stages that several parts of the program share.
inline constexpr const char* boundary_check_stage = "boundary check";
inline constexpr const char* cap_meshing_stage = "cap meshing";

/// Seconds by stage, in the order of first occurrence.
class StageClock {
public:
    /// Books the time since the last call (or the start) on `stage`.
    void book(const std::string& stage) { add(stage, watch_.lap()); }

    /// Runs a stage of the work: announces its name (enter_stage()), then books its time. Returns what `work`
    /// returns.
    template<class Work>
    auto run(const std::string& stage, const Work& work) {
        enter_stage(stage);
        if constexpr (std::is_void_v<decltype(work())>) {
            work();
            book(stage);
        } else {
            auto result = work();
            book(stage);
            return result;
        }
    }

    /// Adds the stages of another clock, which ran meanwhile.
    void add(const StageClock& other) {
        for (const auto& [name, seconds] : other.stages_) {
            add(name, seconds);
        }
    }

    const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
    /// Total over all stages, in seconds.
    double total() const {
        double sum = 0;
        for (const auto& stage : stages_) {
            sum += stage.second;
        }
        return sum;
    }

private:
    void add(const std::string& stage, double passed) {
        for (auto& [name, seconds] : stages_) {
            if (name == stage) {
                seconds += passed;
                return;
            }
        }
        stages_.emplace_back(stage, passed);
    }

    Stopwatch watch_;
    std::vector<std::pair<std::string, double>> stages_;
};

} // namespace slabhull
