// SPDX-License-Identifier: BSD-3-Clause
#include "study/plot.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace slabhull {

namespace {

constexpr double width = 640;
constexpr double height = 380;
constexpr double left = 78;
constexpr double right = 470; // the legend is beyond
constexpr double top = 40;
constexpr double bottom = 328;
constexpr std::size_t colours = 7;

/// Okabe and Ito's colours, darker on white and lighter on black where they need it.
constexpr const char* style_sheet = R"(<style>
.plot{--ink:#1c2128;--faint:#d5dae0;--paper:#ffffff;--c0:#0072b2;--c1:#c04a00;--c2:#00795a;--c3:#8d3f86;--c4:#7a5c00;--c5:#2f6fd0;--c6:#555c66;font-family:system-ui,sans-serif;font-size:12px}
@media (prefers-color-scheme:dark){.plot{--ink:#e6e9ed;--faint:#3a414b;--paper:#14181d;--c0:#5cb8f0;--c1:#ff9a55;--c2:#3fd1a5;--c3:#e29bdb;--c4:#e2c14a;--c5:#9dbcff;--c6:#b4bcc6}}
.plot .back{fill:var(--paper)}.plot text{fill:var(--ink)}.plot .title{font-size:14px;font-weight:600}
.plot .grid{stroke:var(--faint);stroke-width:1}.plot .frame{fill:none;stroke:var(--ink);stroke-width:1}
.plot .line{fill:none;stroke-width:1.8}.plot .guide{stroke:var(--ink);stroke-width:1.2;stroke-dasharray:6 4}
.plot .s0{stroke:var(--c0)}.plot .s1{stroke:var(--c1)}.plot .s2{stroke:var(--c2)}.plot .s3{stroke:var(--c3)}.plot .s4{stroke:var(--c4)}.plot .s5{stroke:var(--c5)}.plot .s6{stroke:var(--c6)}
.plot .mark{fill:var(--paper);stroke-width:1.8}
</style>)";

struct Tick {
    double at; ///< a value of the data
    std::string label;
};

std::string superscript(int number) {
    constexpr std::array digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = number < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(number))) {
        text += digits[static_cast<std::size_t>(digit - '0')];
    }
    return text;
}

/// Where the data are on one axis, and its ticks.
class Axis {
public:
    Axis(Plot::Scale scale, double begin, double end)
        : log_{scale == Plot::Scale::logarithmic}, begin_{begin}, end_{end} {}

    bool shows(double value) const { return std::isfinite(value) && (!log_ || value > 0); }

    void include(double value) {
        if (shows(value)) {
            low_ = std::min(low_, value);
            high_ = std::max(high_, value);
        }
    }

    /// After the last include(): leaves some room around the data.
    void settle() {
        if (!(low_ <= high_)) {
            low_ = log_ ? 0.1 : 0;
            high_ = 1;
        }
        if (log_) {
            const double room = std::pow(high_ / low_, 0.06) * 1.1;
            low_ /= room;
            high_ *= room;
        } else {
            high_ += 0.05 * (high_ - low_) + (high_ == low_ ? 1 : 0);
        }
    }

    double position(double value) const {
        const double share =
            log_ ? std::log(value / low_) / std::log(high_ / low_) : (value - low_) / (high_ - low_);
        return begin_ + share * (end_ - begin_);
    }

    std::vector<Tick> ticks() const { return log_ ? log_ticks() : linear_ticks(); }

private:
    std::vector<Tick> log_ticks() const {
        const double decades = std::log10(high_ / low_);
        const std::vector<int> steps = decades > 2.5 ? std::vector{1}
                                       : decades > 1 ? std::vector{1, 3}
                                                     : std::vector{1, 2, 3, 5, 7};
        std::vector<Tick> ticks;
        for (int power = static_cast<int>(std::floor(std::log10(low_))); std::pow(10.0, power) <= high_;
             ++power) {
            for (const int step : steps) {
                const double at = step * std::pow(10.0, power);
                if (at >= low_ && at <= high_) {
                    ticks.push_back(
                        {at, (step == 1 ? "" : std::to_string(step) + "·") + ("10" + superscript(power))});
                }
            }
        }
        return ticks;
    }

    std::vector<Tick> linear_ticks() const {
        const double rough = (high_ - low_) / 6;
        const double power = std::pow(10.0, std::floor(std::log10(rough)));
        const double lead = rough / power;
        const double step = power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
        std::vector<Tick> ticks;
        for (double k = std::ceil(low_ / step); k * step <= high_; ++k) {
            ticks.push_back({k * step, fmt::format("{:g}", k * step)});
        }
        return ticks;
    }

    bool log_;
    double begin_;
    double end_;
    double low_ = std::numeric_limits<double>::infinity();
    double high_ = -std::numeric_limits<double>::infinity();
};

std::string marker(std::size_t shape, std::size_t colour, double x, double y) {
    const std::string look = fmt::format("class=\"mark s{}\"", colour);
    switch (shape % 4) {
    case 0:
        return fmt::format("<circle {} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>", look, x, y);
    case 1:
        return fmt::format("<rect {} x=\"{:.1f}\" y=\"{:.1f}\" width=\"7\" height=\"7\"/>", look, x - 3.5,
                           y - 3.5);
    case 2:
        return fmt::format("<path {} d=\"M{:.1f} {:.1f}l4.5 8h-9z\"/>", look, x, y - 5);
    default:
        return fmt::format("<path {} d=\"M{:.1f} {:.1f}l5 5l-5 5l-5 -5z\"/>", look, x, y - 5);
    }
}

/// The dash pattern that tells a curve without markers from others.
std::string dashes(std::size_t number) {
    constexpr std::array patterns{"", "7 3", "2 3", "9 3 2 3", "4 2", "12 4", "1 2"};
    const std::string pattern = patterns[number % patterns.size()];
    return pattern.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", pattern);
}

class Drawing {
public:
    explicit Drawing(const Plot& plot)
        : plot_{plot}, x_{plot.scale, left, right}, y_{plot.scale, bottom, top} {
        for (const PlotSeries& series : plot.series) {
            for (const auto& [x, y] : series.points) {
                x_.include(x);
                y_.include(y);
            }
        }
        if (plot.scale == Plot::Scale::linear) {
            y_.include(0);
        }
        x_.settle();
        y_.settle();
    }

    std::string svg() {
        const std::string title = escaped(plot_.title);
        add("<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" "
            "width=\"{0:g}\" "
            "height=\"{1:g}\" role=\"img\" aria-label=\"{2}. {3}\">\n",
            width, height, title, escaped(plot_.description));
        text_ += fmt::format("<title>{}</title>\n{}\n", title, style_sheet);
        add("<rect class=\"back\" width=\"{:g}\" height=\"{:g}\"/>\n<text class=\"title\" x=\"{:g}\" "
            "y=\"24\">{}</text>\n",
            width, height, left, title);
        draw_axes();
        std::size_t number = 0;
        for (const PlotSeries& series : plot_.series) {
            draw(series, number);
            add_to_legend(series, number++);
        }
        add("<rect class=\"frame\" x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\"/>\n</svg>\n", left,
            top, right - left, bottom - top);
        return std::move(text_);
    }

private:
    template<class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        text_ += fmt::format(format, std::forward<Values>(values)...);
    }

    void draw_axes() {
        for (const Tick& tick : x_.ticks()) {
            const double x = x_.position(tick.at);
            add("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:g}\" y2=\"{2:g}\"/>", x, top,
                bottom);
            add("<text x=\"{:.1f}\" y=\"{:g}\" text-anchor=\"middle\">{}</text>\n", x, bottom + 16,
                tick.label);
        }
        for (const Tick& tick : y_.ticks()) {
            const double y = y_.position(tick.at);
            add("<line class=\"grid\" x1=\"{1:g}\" x2=\"{2:g}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>", y, left,
                right);
            add("<text x=\"{:g}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 6, y + 4, tick.label);
        }
        add("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\">{}</text>\n", (left + right) / 2, height - 12,
            escaped(plot_.x_label));
        add("<text transform=\"translate(18 {:g}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            (top + bottom) / 2, escaped(plot_.y_label));
    }

    /// The points that can be shown, in the drawing's coordinates.
    std::vector<std::array<double, 2>> places(const PlotSeries& series) const {
        std::vector<std::array<double, 2>> at;
        for (const auto& [x, y] : series.points) {
            if (x_.shows(x) && y_.shows(y)) {
                at.push_back({x_.position(x), y_.position(y)});
            }
        }
        return at;
    }

    void draw(const PlotSeries& series, std::size_t number) {
        const auto at = places(series);
        const bool steps = plot_.style == Plot::Style::steps;
        std::string path;
        for (std::size_t i = 0; i < at.size(); ++i) {
            path += i > 0 && steps ? fmt::format("H{:.1f}V{:.1f}", at[i][0], at[i][1])
                                   : fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", at[i][0], at[i][1]);
        }
        if (!path.empty()) {
            add("<path {} d=\"{}\"/>\n", look_of(series, number), path);
        }
        if (!steps && !series.guide) {
            for (const auto& [x, y] : at) {
                text_ += marker(number, number % colours, x, y);
            }
            text_ += "\n";
        }
    }

    std::string look_of(const PlotSeries& series, std::size_t number) const {
        if (series.guide) {
            return "class=\"line guide\"";
        }
        return fmt::format("class=\"line s{}\"{}", number % colours,
                           plot_.style == Plot::Style::steps ? dashes(number) : "");
    }

    void add_to_legend(const PlotSeries& series, std::size_t number) {
        const double y = top + 12 + 20 * static_cast<double>(number);
        const double x = right + 14;
        add("<path {} d=\"M{:g} {:g}h28\"/>", look_of(series, number), x, y);
        if (!series.guide && plot_.style == Plot::Style::markers) {
            text_ += marker(number, number % colours, x + 14, y);
        }
        add("<text x=\"{:g}\" y=\"{:g}\">{}</text>\n", x + 34, y + 4, escaped(series.name));
    }

    const Plot& plot_;
    Axis x_;
    Axis y_;
    std::string text_;
};

} // namespace

std::string svg_of(const Plot& plot) {
    return Drawing{plot}.svg();
}

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
        case '&':
            safe += "&amp;";
            break;
        case '<':
            safe += "&lt;";
            break;
        case '>':
            safe += "&gt;";
            break;
        case '"':
            safe += "&quot;";
            break;
        default:
            safe += c;
        }
    }
    return safe;
}

} // namespace slabhull
