// SPDX-License-Identifier: BSD-3-Clause
#include "progress_display.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <sys/ioctl.h>
#include <unistd.h>

namespace slabhull::tools {

namespace {

std::size_t terminal_width() {
    winsize size{};
    constexpr std::size_t usual = 80;
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

/// "3 h 12 min", "5 min 20 s", "12 s"
std::string duration_in_words(double seconds) {
    const auto whole = std::lround(std::min(seconds, 1e9));
    if (whole >= 3600) {
        return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
    }
    return whole >= 60 ? fmt::format("{} min {} s", whole / 60, whole % 60) : fmt::format("{} s", whole);
}

std::string stage_in_words(const WorkState& work) {
    const std::optional<double> share = work.share();
    return share ? fmt::format("{} {:.0f} %", work.stage, std::floor(100 * *share)) : work.stage;
}

std::string in_words(const RunProgress& run) {
    std::string text;
    if (run.slabs > 0) {
        text = fmt::format("[{:3.0f} %] ", std::floor(100 * run.share));
        if (run.slab && run.share < 1) {
            text += fmt::format("slab {} of {}: ", *run.slab, run.slabs);
        }
    }
    text += stage_in_words(run.work);
    if (run.cells > 0) {
        text += fmt::format(", {:.3g} cells, {:.2g} cells/s", static_cast<double>(run.cells),
                            run.cells_per_second());
    }
    if (run.seconds_left && run.share < 1) {
        text += fmt::format(", {} left", duration_in_words(*run.seconds_left));
    }
    return text;
}

/// Numbers have few digits: they are estimates.
nlohmann::ordered_json rounded(std::optional<double> number, double digits) {
    if (!number) {
        return {};
    }
    return std::round(*number * digits) / digits;
}

std::string as_json_line(const RunProgress& run) {
    nlohmann::ordered_json json;
    json["stage"] = run.work.stage;
    json["stage_share"] = rounded(run.work.share(), 1e4);
    json["slab"] = run.slab ? nlohmann::ordered_json(*run.slab) : nlohmann::ordered_json();
    json["slabs"] = run.slabs;
    json["share"] = rounded(run.share, 1e4);
    json["cells"] = run.cells;
    json["cells_per_second"] = rounded(run.cells_per_second(), 1);
    json["seconds"] = rounded(run.seconds, 1e3);
    json["seconds_left"] = rounded(run.seconds_left, 1e3);
    return json.dump();
}

} // namespace

ProgressDisplay::~ProgressDisplay() {
    clear();
}

void ProgressDisplay::clear() {
    if (line_is_there_) {
        std::fputs("\r\033[K", stderr);
        std::fflush(stderr);
        line_is_there_ = false;
    }
}

/// A line a quarter of a second, and at once for a new stage; an object a second; both at the end.
bool ProgressDisplay::is_time(const RunProgress& run) const {
    if (shown_at_ < 0 || run.share >= 1) {
        return true;
    }
    const double passed = since_begin_.seconds() - shown_at_;
    return form_ == Form::json ? passed >= 1 : passed >= 0.25 || run.work.stage != shown_stage_;
}

void ProgressDisplay::show(const RunProgress& run) {
    if (form_ == Form::none || !is_time(run)) {
        return;
    }
    shown_at_ = since_begin_.seconds();
    shown_stage_ = run.work.stage;
    if (form_ == Form::json) {
        fmt::print(stderr, "{}\n", as_json_line(run));
    } else {
        const bool end = run.share >= 1;
        fmt::print(stderr, "\r\033[K{}{}", in_words(run).substr(0, terminal_width() - 1), end ? "\n" : "");
        line_is_there_ = !end;
    }
    std::fflush(stderr);
}

Progress ProgressDisplay::for_work() {
    return [this](const WorkState& work) {
        if (work.stage.empty()) {
            clear();
        } else {
            RunProgress run;
            run.work = work;
            run.seconds = since_begin_.seconds();
            show(run);
        }
        return true;
    };
}

void add_progress_option(CLI::App& command, std::string& form) {
    command
        .add_option(
            "--progress", form,
            "How to show progress on stderr: a line, a JSON object each second, or none; auto: a line "
            "on a terminal")
        ->check(CLI::IsMember({"auto", "line", "json", "none"}))
        ->capture_default_str();
}

ProgressDisplay::Form progress_form(const std::string& form, bool quiet) {
    if (form == "auto") {
        return !quiet && ::isatty(STDERR_FILENO) != 0 ? ProgressDisplay::Form::line
                                                      : ProgressDisplay::Form::none;
    }
    return form == "line"   ? ProgressDisplay::Form::line
           : form == "json" ? ProgressDisplay::Form::json
                            : ProgressDisplay::Form::none;
}

} // namespace slabhull::tools
