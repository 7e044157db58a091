// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/hull_view.h"

#include "core/pieces.h"

#include "slab/check/check_shape.h"
#include "slabhull/core/progress.h"
#include "slabhull/core/vector.h"

#include <cmath>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_piece = 1 << 15;

template<int D>
struct PieceOfSurvey {
    std::array<MeasureSums<D>, 3> sums;
    std::vector<Index> degenerate;
    std::vector<Index> inverted;
};

/// Component of a cell's normal out of its cap; 0 for a side cell.
template<int D>
double out_of_cap(Region region, const Point<D + 1>& normal) {
    return region == Region::intermediate ? 0 : region == Region::initial ? -normal[D] : normal[D];
}

template<int D>
void survey_piece(const HullView<D>& view, double sign, std::size_t begin, std::size_t end,
                  PieceOfSurvey<D>& piece) {
    const Point<D + 1> origin = view.points().front();
    for (std::size_t c = begin; c < end; ++c) {
        const auto corners = corners_of<D, D + 1>(view.cells()[c], view.points());
        const Point<D + 1> normal = piece.sums[static_cast<std::size_t>(view.region[c])].add(corners, origin);
        if (is_degenerate<D, D + 1>(corners, norm(normal)) && !repeats_a_vertex(view.cells()[c])) {
            piece.degenerate.push_back(static_cast<Index>(c));
        }
        if (sign * out_of_cap<D>(view.region_of(c), normal) < 0) {
            piece.inverted.push_back(static_cast<Index>(c));
        }
    }
}

} // namespace

template<int D>
CellSurvey<D> survey_cells(const HullView<D>& view, double sign) {
    const auto pieces =
        parallel_pieces<PieceOfSurvey<D>>(view.cells().size(), cells_per_piece,
                                          [&](std::size_t begin, std::size_t end, PieceOfSurvey<D>& piece) {
                                              survey_piece(view, sign, begin, end, piece);
                                              work_done(end - begin);
                                          });
    CellSurvey<D> survey;
    std::array<MeasureSums<D>, 3> sums;
    for (const PieceOfSurvey<D>& piece : pieces) {
        for (std::size_t r = 0; r < 3; ++r) {
            sums[r].add(piece.sums[r]);
        }
        survey.degenerate.insert(survey.degenerate.end(), piece.degenerate.begin(), piece.degenerate.end());
        survey.inverted.insert(survey.inverted.end(), piece.inverted.begin(), piece.inverted.end());
    }
    for (std::size_t r = 0; r < 3; ++r) {
        survey.regions[r] = sums[r].value();
    }
    return survey;
}

template CellSurvey<2> survey_cells<2>(const HullView<2>&, double);
template CellSurvey<3> survey_cells<3>(const HullView<3>&, double);

} // namespace slabhull
