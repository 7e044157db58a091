// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/point.h"
#include "slabhull/geometry/projection.h"

#include "geometry/basics/vector_algebra.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Common parts of all projections of many points.
namespace slabhull::detail {

/// Throws GeometryError naming the point unless its image is finite.
template<std::size_t N>
void require_on_surface(const std::array<double, N>& image, const std::array<double, N>& x,
                        std::size_t number) {
    if (!all_finite(image)) {
        const auto entity = static_cast<std::int64_t>(number);
        throw GeometryError{
            fmt::format("point {} at {} cannot be put on its projection surface", number, to_text(x)),
            {{"vertex", entity, {}}}};
    }
}

/// Replaces each x by image(x, its number), in parallel, and reports the distances moved. `moved`, unless
/// empty, receives them. The report has the same bits for any number of threads.
template<int D, class Image>
ProjectionReport move_points(std::span<Point<D>> x, std::span<double> moved, const Image& image) {
    constexpr std::size_t chunk_size = 1024;
    std::vector<ProjectionReport> parts((x.size() + chunk_size - 1) / chunk_size);
    parallel_for(x.size(), chunk_size, [&](std::size_t begin, std::size_t end) {
        ProjectionReport& part = parts[begin / chunk_size];
        for (std::size_t i = begin; i < end; ++i) {
            const Point<D> to = image(x[i], i);
            const double distance = norm(minus(to, x[i]));
            x[i] = to;
            part.largest = std::max(part.largest, distance);
            part.mean += distance;
            if (!moved.empty()) {
                moved[i] = distance;
            }
        }
    });
    ProjectionReport report;
    for (const ProjectionReport& part : parts) {
        report.largest = std::max(report.largest, part.largest);
        report.mean += part.mean;
    }
    report.count = x.size();
    report.mean /= static_cast<double>(std::max<std::size_t>(1, x.size()));
    return report;
}

} // namespace slabhull::detail
