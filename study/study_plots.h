// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/study/study.h"
#include "study/plot.h"

namespace slabhull {

/// Errors of all measures against the spacing, with the line of order 2.
Plot plot_of_errors(const StudySeries& series);
/// Seconds of wall time by stage against the number of simplices.
Plot plot_of_seconds(const StudySeries& series);
/// Peak memory against the number of simplices.
Plot plot_of_memory(const StudySeries& series);
/// Dihedral angles of the side and of the caps of one hull.
Plot plot_of_angles(const StudyRow& row);
/// Dihedral angles of the sides that different splits make.
Plot plot_of_split_angles(const std::vector<StudyRow>& rows);
/// Errors of one measure by experiment or split, with the line of order 2.
Plot plot_of_measure(const std::vector<StudySeries>& all, std::size_t measure, const std::string& title);

} // namespace slabhull
