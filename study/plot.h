// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

namespace slabhull {

/// A curve of a plot: a colour, and so that it can be told without colours, a marker or a dash pattern.
struct PlotSeries {
    std::string name;
    std::vector<std::array<double, 2>> points;
    bool guide = false; ///< a thin dashed line for comparison, without markers
};

/// A line plot as SVG, drawn without scripts, in colours that follow the reader's light or dark scheme.
struct Plot {
    enum class Scale { linear, logarithmic };
    enum class Style { markers, steps };

    std::string title;
    std::string description; ///< what it shows, for those who cannot see it
    std::string x_label;
    std::string y_label;
    Scale scale =
        Scale::logarithmic; ///< of both axes; points that are not positive are left out of logarithmic ones
    Style style = Style::markers; ///< steps: a point is the left end of a step to the next
    std::vector<PlotSeries> series;
};

/// A complete <svg> element with a namespace, good inside a page and as a file.
std::string svg_of(const Plot& plot);

/// For text inside elements and attributes.
std::string escaped(const std::string& text);

} // namespace slabhull
