// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/message.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/slab/stage_clock.h"

#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace slabhull {

/// Tells a listener how far a run has come, within its slabs too. What is left is estimated by the last slab,
/// stage by stage; for the first slab by its number of cells.
class ProgressMeter {
public:
    /// The run goes through `slabs` slabs from time `start` to `end`.
    ProgressMeter(const Listener& listener, double start, double end, int slabs);
    ProgressMeter(const ProgressMeter&) = delete;
    ProgressMeter& operator=(const ProgressMeter&) = delete;

    /// To be told of the work: a Progress that lets it go on.
    Progress watch();

    /// A slab is begun that goes to time `end`.
    void begin_slab(int slab, double begin, double end);
    /// What a slab takes, unless an earlier one has shown it.
    void expect_seconds(double seconds);
    /// Another hull is there, of so many cells.
    void hull_built(std::uint64_t cells);
    /// A slab is finished, maybe while the next one is built.
    void end_slab(const StageClock& clock);
    /// The run is finished.
    void end();

private:
    void tell(const WorkState& work);
    /// Seconds that a stage took in the last slab; 0 where it had none such.
    double expected_of(const std::string& stage) const;
    std::optional<double> seconds_left(const WorkState& work) const;

    const Listener& listener_;
    double end_;
    std::mutex lock_; ///< for all below: stages are told by any thread
    RunProgress run_;
    Stopwatch since_begin_;
    double slab_begin_;
    double slab_end_;
    std::uint64_t hull_cells_ = 0;                         ///< of all hulls so far
    std::vector<std::pair<std::string, double>> expected_; ///< the last slab's stages with their seconds
    double stage_seconds_ = 0;                             ///< their sum; 0: not known
    double expected_seconds_ = 0;                          ///< of a slab; 0: not known
    Stopwatch since_slab_;
    std::string stage_;
    Stopwatch since_stage_;
    double in_stages_ = 0; ///< expected seconds of the stages that the slab at hand has left behind
};

} // namespace slabhull
