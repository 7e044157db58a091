// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/filling_quality.h"

#include "core/pieces.h"

#include "slab/fill/layer_scale.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_piece_of_quality = 1 << 14;

AngleRange both(const AngleRange& a, const AngleRange& b) {
    return {std::min(a.smallest, b.smallest), std::max(a.largest, b.largest)};
}

/// The facets of a filling that are the cells of the initial cap.
template<int D>
std::span<const Simplex<D>> initial_facets(const Filling<D>& filling) {
    const auto end = std::find_if(filling.facet_attribute.begin(), filling.facet_attribute.end(),
                                  [](FacetAttribute attribute) { return attribute != 1; });
    return std::span{filling.facets}.first(static_cast<std::size_t>(end - filling.facet_attribute.begin()));
}

template<int N>
double mean_ratio(const std::array<Point<N>, N + 1>& corners) {
    double squares = 0;
    for (std::size_t i = 0; i <= N; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Point<N> edge = minus(corners[i], corners[j]);
            squares += dot(edge, edge);
        }
    }
    double regular = std::sqrt((N + 1) / std::pow(2.0, N));
    for (int k = 2; k <= N; ++k) {
        regular /= k;
    }
    const double volume = std::max(0.0, signed_measure<N>(corners));
    return std::pow(volume / regular, 2.0 / N) * N * (N + 1) / 2 / squares;
}

} // namespace

template<int D>
FillingQuality filling_quality(const Filling<D>& filling, std::size_t layers) {
    FillingQuality quality;
    if (filling.cells.empty()) {
        return quality;
    }
    quality.time_scale = layer_scale<D>(initial_facets(filling), filling.points, layers, filling.time);
    Array<float> ratios(filling.cells.size());
    const auto measure = [&](std::size_t begin, std::size_t end, AngleRange& angles) {
        for (std::size_t c = begin; c < end; ++c) {
            auto corners = corners_of<D + 1, D + 1>(filling.cells[c], filling.points);
            for (Point<D + 1>& corner : corners) {
                corner[D] *= quality.time_scale;
            }
            ratios[c] = static_cast<float>(mean_ratio<D + 1>(corners));
            angles = both(angles, dihedral_angles<D + 1, D + 1>(corners));
        }
    };
    for (const AngleRange& angles :
         parallel_pieces<AngleRange>(ratios.size(), cells_per_piece_of_quality, measure, quality.angles)) {
        quality.angles = both(quality.angles, angles);
    }
    const auto quantile = [&](std::size_t rank) {
        const auto place = ratios.begin() + static_cast<std::ptrdiff_t>(rank);
        std::nth_element(ratios.begin(), place, ratios.end());
        return static_cast<double>(*place);
    };
    quality.median = quantile(ratios.size() / 2);
    quality.one_per_cent = quantile(ratios.size() / 100);
    quality.smallest = *std::min_element(ratios.begin(), ratios.end());
    return quality;
}

template FillingQuality filling_quality<2>(const Filling<2>&, std::size_t);
template FillingQuality filling_quality<3>(const Filling<3>&, std::size_t);

} // namespace slabhull
