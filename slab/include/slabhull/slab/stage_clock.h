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

/// Seconds by stage, in the order of first occurrence: wall time, and processor time of this process.
class StageClock {
public:
    using Stages = std::vector<std::pair<std::string, double>>;

    /// Books the time since the last call (or the start) on `stage`.
    void book(const std::string& stage) {
        add(stage, watch_.lap(), stages_);
        const double cpu = cpu_seconds();
        add(stage, cpu - cpu_before_, cpu_stages_);
        cpu_before_ = cpu;
    }

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
            add(name, seconds, stages_);
        }
        for (const auto& [name, seconds] : other.cpu_stages_) {
            add(name, seconds, cpu_stages_);
        }
    }

    const Stages& stages() const { return stages_; }
    /// Processor time of all threads of this process while a stage went on, without ended children: also of
    /// what ran beside the stage.
    const Stages& cpu_stages() const { return cpu_stages_; }
    /// Total over all stages, in seconds.
    double total() const {
        double sum = 0;
        for (const auto& stage : stages_) {
            sum += stage.second;
        }
        return sum;
    }

private:
    static void add(const std::string& stage, double passed, Stages& stages) {
        for (auto& [name, seconds] : stages) {
            if (name == stage) {
                seconds += passed;
                return;
            }
        }
        stages.emplace_back(stage, passed);
    }

    Stopwatch watch_;
    double cpu_before_ = cpu_seconds();
    Stages stages_;
    Stages cpu_stages_;
};

} // namespace slabhull
