// SPDX-License-Identifier: BSD-3-Clause
// Errors of a slab of an experiment against its exact measures, and the order at which they fall.
#pragma once

#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/slab.h"
#include "slabhull/study/exact_measures.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace slabhull::specimens {

inline constexpr std::array measure_names{"hull", "initial", "side", "terminating", "enclosed"};

struct ErrorRow {
    double cells;
    double vertices;
    std::array<double, measure_names.size()> errors; ///< relative, with sign
};

template<int D>
SpatialMesh<D> initial_cap_of(const Case& the_case, IdCounter& ids) {
    StageClock clock;
    return initial_cap<D>(the_case, ids, {}, clock);
}

/// The errors of the first slab. Throws where its hull has a defect.
template<int D>
ErrorRow errors_of(const Case& the_case, const SpatialMesh<D>& initial, const IdCounter& ids) {
    StageClock clock;
    const auto settings = settings_of<D>(the_case, boundary_of(initial));
    const Slab<D> slab =
        build_slab<D>(initial, boundary_of(initial), 0, the_case.level_times(the_case.start, the_case.end),
                      settings, ids, clock);
    const HullReport report = check_hull<D>(slab.hull);
    if (!report.clean()) {
        throw std::runtime_error("the hull has defects");
    }
    const auto exact = exact_measures(the_case.experiment);
    const auto relative = [](double ours, double theirs) { return ours / theirs - 1; };
    return {static_cast<double>(report.counts.cells),
            static_cast<double>(report.counts.vertices),
            {relative(report.measure, exact.hull()), relative(report.measure_by_region[0], exact.initial),
             relative(report.measure_by_region[1], exact.side),
             relative(report.measure_by_region[2], exact.terminating),
             relative(report.enclosed, exact.enclosed)}};
}

template<int D>
ErrorRow errors_of(const Case& the_case) {
    IdCounter ids;
    const auto initial = initial_cap_of<D>(the_case, ids);
    return errors_of<D>(the_case, initial, ids);
}

/// Slope of log error against log spacing, the spacing being N^(-1/D).
inline double rate(const std::vector<ErrorRow>& rows, std::size_t measure, int dimension) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const ErrorRow& row : rows) {
        const double x = -std::log(row.cells) / dimension;
        const double y = std::log(std::abs(row.errors[measure]));
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const auto n = static_cast<double>(rows.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// A way of getting the boundary from level to level.
struct Movement {
    const char* name;
    Scheme scheme;
    int substeps;
    bool project;

    Case applied_to(Case the_case) const {
        the_case.trajectory.scheme = scheme;
        the_case.trajectory.substeps = substeps;
        if (!project) {
            the_case.projections.clear();
        }
        return the_case;
    }
};

/// An experiment whose layers shrink in proportion to its edges, at any refinement that is a multiple of 1/4.
inline Case proportional_case(const std::string& name, double refinement) {
    Case the_case = experiment_at(name, refinement, Bulk::caps);
    the_case.layers = static_cast<int>(std::lround(4 * refinement));
    return the_case;
}

/// Euler takes so few substeps that its drift outweighs the error of the facets, which has the other sign.
inline constexpr std::array<Movement, 4> movements{{{"rk4-8-projected", Scheme::rk4, 8, true},
                                                    {"rk4-8", Scheme::rk4, 8, false},
                                                    {"euler-4-projected", Scheme::euler, 4, true},
                                                    {"euler-2", Scheme::euler, 2, false}}};

} // namespace slabhull::specimens
