// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/hull_view.h"

#include "core/pieces.h"

#include "slab/check/cell_survey.h"
#include "slabhull/core/progress.h"

namespace slabhull {

namespace {

template<int D>
struct PieceOfSurvey {
    std::array<MeasureSums<D>, 3> sums;
    std::vector<Index> degenerate;
    std::vector<Index> inverted;
};

template<int D>
void survey_piece(const HullView<D>& view, double sign, std::size_t begin, std::size_t end,
                  PieceOfSurvey<D>& piece) {
    const Point<D + 1> origin = view.points().front();
    for (std::size_t c = begin; c < end; ++c) {
        const auto corners = corners_of<D, D + 1>(view.cells()[c], view.points());
        const CellFaults faults = survey_cell<D>(view.region_of(c), corners, origin, sign, piece.sums);
        if (faults.degenerate && !repeats_a_vertex(view.cells()[c])) {
            piece.degenerate.push_back(static_cast<Index>(c));
        }
        if (faults.inverted) {
            piece.inverted.push_back(static_cast<Index>(c));
        }
    }
}

} // namespace

template<int D>
CellSurvey<D> survey_cells(const HullView<D>& view, double sign) {
    const auto pieces =
        parallel_pieces<PieceOfSurvey<D>>(view.cells().size(), cells_per_survey,
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
