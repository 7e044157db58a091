// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/message.h"
#include "slabhull/core/stopwatch.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace slabhull::tools {

/// Shows on stderr how far long work has come: a line that is written over, or a JSON object a second.
class ProgressDisplay {
public:
    enum class Form { none, line, json };

    explicit ProgressDisplay(Form form) : form_{form} {}
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;
    /// Clears the line.
    ~ProgressDisplay();

    void show(const RunProgress& run);
    /// Work that is no run, such as that of `check`: its stage and that stage's share. A stage without a name
    /// clears the line.
    Progress for_work();
    /// Makes place for a message.
    void clear();

private:
    bool is_time(const RunProgress& run) const;

    Form form_;
    Stopwatch since_begin_;
    double shown_at_ = -1; ///< in seconds since the beginning
    std::string shown_stage_;
    bool line_is_there_ = false;
};

/// The option --progress of a command. `form` becomes "auto", "line", "json" or "none".
void add_progress_option(CLI::App& command, std::string& form);

/// "auto": a line where stderr is a terminal and the command is not quiet.
ProgressDisplay::Form progress_form(const std::string& form, bool quiet);

} // namespace slabhull::tools
