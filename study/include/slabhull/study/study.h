// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/cases/experiments.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace slabhull {

/// The measures that a study compares with exact values, in the order of its arrays.
inline constexpr std::array study_measures{"hull", "initial", "side", "terminating", "enclosed"};

/// Shapes of some of a hull's cells, in space-time.
struct CellShapes {
    AngleRange angles{180, 0};  ///< dihedral ones, in degrees (D = 2: the angles)
    AngleHistogram histogram{}; ///< of them
    AspectRatios aspect;
};

/// One hull of a study: an experiment at a level in a split.
struct StudyRow {
    std::string experiment;
    int level = 0;
    int dimension = 0;
    std::string split;

    HullCounts counts{};
    HullCounts paper{};
    std::array<std::size_t, 3> cells_by_region{};
    std::size_t layers = 0;
    std::size_t boundary_facets = 0;
    std::size_t centres = 0; ///< points that the split puts into faces and prisms

    std::array<double, study_measures.size()> measured{};
    std::array<double, study_measures.size()> exact{};
    double closure = 0; ///< |sum of N|

    CellShapes side;
    CellShapes caps;

    std::vector<std::pair<std::string, double>> seconds; ///< of wall time, by stage
    double cpu_seconds = 0;                              ///< of this process and the mesher's, all threads
    std::size_t peak_bytes = 0;                          ///< of resident memory of this process ...
    std::size_t mesher_peak_bytes = 0; ///< ... and of the mesher's, which begins as a copy of this one

    /// Relative, with sign.
    double error(std::size_t measure) const { return measured[measure] / exact[measure] - 1; }
    double total_seconds() const;
    /// The larger of both peaks: the memory that the machine needs.
    std::size_t peak() const { return std::max(peak_bytes, mesher_peak_bytes); }
};

/// Builds a level of an experiment with the case's split, checks the hull, and measures it. `hull_file`:
/// where to write the hull, if anywhere; the ending says the format, vtu or msh. Peak memory and CPU time are
/// those of the process since it began: run it in a process of its own to have them for the level alone.
/// Throws what building throws; GeometryError when the check finds anything.
StudyRow study_level(const Case& the_case, const std::optional<std::filesystem::path>& hull_file);

/// The exponent p of y ~ x^p by least squares over logarithms; none for fewer than two different x, or values
/// that are not positive.
std::optional<double> power_law(const std::vector<std::array<double, 2>>& xy);

/// The levels of one experiment in one split, ascending.
using StudySeries = std::vector<StudyRow>;

/// The rows by experiment and split, in the order in which they first come.
std::vector<StudySeries> series_of(const std::vector<StudyRow>& rows);

/// The order at which the error of a measure falls with the spacing N^(-1/D).
std::optional<double> order_of(const StudySeries& series, std::size_t measure);
/// The exponents with which CPU time and peak memory grow with the number of simplices.
std::optional<double> time_growth(const StudySeries& series);
std::optional<double> memory_growth(const StudySeries& series);

/// A row as text on one line, and back; read_row() needs what row_as_text() gave.
std::string row_as_text(const StudyRow& row);
StudyRow row_from_text(const std::string& text);

/// The tables of docs/formats.md: a line per row, and all with rates as one JSON document.
std::string study_csv(const std::vector<StudyRow>& rows);
std::string study_json(const std::vector<StudyRow>& rows);

/// All tables and plots as one page that needs no other file, no network and no scripts.
std::string study_page(const std::vector<StudyRow>& rows);

/// A plot of the page that is good as a file of its own.
struct StudyFigure {
    std::string name; ///< of the file, without ending
    std::string svg;
};
std::vector<StudyFigure> study_figures(const std::vector<StudyRow>& rows);

} // namespace slabhull
