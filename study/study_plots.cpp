// SPDX-License-Identifier: BSD-3-Clause
#include "study/study_plots.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace slabhull {

namespace {

double spacing(const StudyRow& row) {
    return std::pow(static_cast<double>(row.counts.cells), -1.0 / row.dimension);
}

std::string spacing_label(int dimension) {
    return dimension == 2 ? "spacing N^(-1/2)" : "spacing N^(-1/3)";
}

/// Of order 2 in x, somewhat below the lowest curve at its finest point.
PlotSeries order_two(const std::vector<PlotSeries>& curves) {
    double low_x = 0, high_x = 0, at_low = 0;
    for (const PlotSeries& curve : curves) {
        for (const auto& [x, y] : curve.points) {
            low_x = low_x == 0 ? x : std::min(low_x, x);
            high_x = std::max(high_x, x);
            const double constant = y / (x * x);
            at_low = at_low == 0 || (constant > 0 && constant < at_low) ? constant : at_low;
        }
    }
    at_low *= 0.6;
    return {"order 2", {{low_x, at_low * low_x * low_x}, {high_x, at_low * high_x * high_x}}, true};
}

PlotSeries errors(const StudySeries& series, std::size_t measure, const std::string& name) {
    PlotSeries curve{name, {}};
    for (const StudyRow& row : series) {
        curve.points.push_back({spacing(row), std::abs(row.error(measure))});
    }
    return curve;
}

/// The shares, in per cent of all angles, as the left ends of steps.
PlotSeries histogram(const CellShapes& shapes, const std::string& name) {
    double total = 0;
    for (const std::size_t count : shapes.histogram) {
        total += static_cast<double>(count);
    }
    PlotSeries curve{name, {}};
    constexpr double bin = 180.0 / angle_bins;
    for (std::size_t k = 0; k < angle_bins; ++k) {
        curve.points.push_back(
            {bin * static_cast<double>(k), 100 * static_cast<double>(shapes.histogram[k]) / total});
    }
    curve.points.push_back({180, 0});
    return curve;
}

std::string angle_name(int dimension) {
    return dimension == 2 ? "angle in degrees" : "dihedral angle in degrees";
}

Plot of_angles(const std::string& title, int dimension) {
    return {title,
            "Share of the angles in each ten degrees.",
            angle_name(dimension),
            "share of the angles, %",
            Plot::Scale::linear,
            Plot::Style::steps,
            {}};
}

std::string split_word(const StudyRow& row) {
    return row.experiment + ", split " + row.split;
}

} // namespace

Plot plot_of_errors(const StudySeries& series) {
    Plot plot{"Errors: " + split_word(series.front()),
              "Relative error of each measure against the spacing; all fall with order 2.",
              spacing_label(series.front().dimension),
              "relative error",
              Plot::Scale::logarithmic,
              Plot::Style::markers,
              {}};
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        plot.series.push_back(errors(series, m, study_measures[m]));
    }
    plot.series.push_back(order_two(plot.series));
    return plot;
}

Plot plot_of_seconds(const StudySeries& series) {
    Plot plot{"Time: " + split_word(series.front()),
              "Seconds by stage against the number of simplices.",
              "simplices",
              "seconds",
              Plot::Scale::logarithmic,
              Plot::Style::markers,
              {}};
    for (const auto& [stage, passed] : series.back().seconds) {
        PlotSeries curve{stage, {}};
        for (const StudyRow& row : series) {
            for (const auto& [name, seconds] : row.seconds) {
                if (name == stage) {
                    curve.points.push_back({static_cast<double>(row.counts.cells), seconds});
                }
            }
        }
        plot.series.push_back(std::move(curve));
    }
    return plot;
}

Plot plot_of_memory(const StudySeries& series) {
    Plot plot{"Memory: " + split_word(series.front()),
              "Peak resident memory against the number of simplices.",
              "simplices",
              "megabytes",
              Plot::Scale::logarithmic,
              Plot::Style::markers,
              {{"hull", {}}, {"mesher", {}}}};
    for (const StudyRow& row : series) {
        const auto cells = static_cast<double>(row.counts.cells);
        plot.series[0].points.push_back({cells, 1e-6 * static_cast<double>(row.peak_bytes)});
        plot.series[1].points.push_back({cells, 1e-6 * static_cast<double>(row.mesher_peak_bytes)});
    }
    return plot;
}

Plot plot_of_angles(const StudyRow& row) {
    Plot plot = of_angles(fmt::format("Angles: {}, level {}", split_word(row), row.level), row.dimension);
    plot.series = {histogram(row.side, "side"), histogram(row.caps, "caps")};
    return plot;
}

Plot plot_of_split_angles(const std::vector<StudyRow>& rows) {
    const StudyRow& first = rows.front();
    Plot plot =
        of_angles(fmt::format("Angles of the side by split: {}, level {}", first.experiment, first.level),
                  first.dimension);
    for (const StudyRow& row : rows) {
        plot.series.push_back(histogram(row.side, "split " + row.split));
    }
    return plot;
}

Plot plot_of_measure(const std::vector<StudySeries>& all, std::size_t measure, const std::string& title) {
    Plot plot{title,
              "Relative error against the spacing.",
              "spacing N^(-1/D)",
              "relative error",
              Plot::Scale::logarithmic,
              Plot::Style::markers,
              {}};
    const bool one_case = std::all_of(all.begin(), all.end(), [&all](const StudySeries& series) {
        return series.front().experiment == all.front().front().experiment;
    });
    for (const StudySeries& series : all) {
        const StudyRow& row = series.front();
        plot.series.push_back(errors(series, measure, one_case ? "split " + row.split : row.experiment));
    }
    plot.series.push_back(order_two(plot.series));
    return plot;
}

} // namespace slabhull
