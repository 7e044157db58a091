// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/inner_places.h"

#include "slabhull/geometry/cap_motion.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

template<int D>
class InnerPlaces {
public:
    InnerPlaces(const Hull<D>& hull, const SlabColumns<D>& columns, Filling<D>& filling)
        : columns_{columns}, filling_{filling}, levels_(columns.layers() + 1),
          cells_(hull.cells.begin(), hull.cells.begin() + static_cast<std::ptrdiff_t>(hull.initial_cells)),
          column_of_(hull.initial_points) {
        for (Simplex<D>& cell : cells_) {
            std::swap(cell[0], cell[1]); // the hull's cells face back in time
        }
        for (Index k = 0; k < columns.count; ++k) {
            column_of_[columns.at(0, k)] = k;
        }
        for (Index v = 0; v < hull.initial_points; ++v) {
            if (columns.on_boundary[column_of_[v]] != 0) {
                boundary_.push_back(v);
            }
        }
        levels_.front() = ends(0);
        levels_.back() = ends(columns.layers());
    }

    void run() {
        if (!from_start()) {
            const std::vector<Array<Point<D>>> first = levels_;
            if (!step_by_step()) {
                levels_ = first;
            }
        }
        store();
    }

private:
    Array<Point<D>> ends(std::size_t level) const {
        Array<Point<D>> places(column_of_.size());
        for (Index v = 0; v < column_of_.size(); ++v) {
            places[v] = in_space(filling_.points[columns_.at(level, column_of_[v])]);
        }
        return places;
    }

    static Point<D> in_space(const Point<D + 1>& point) {
        Point<D> place;
        std::copy_n(point.begin(), D, place.begin());
        return place;
    }

    MovedCap<D> moved(const Array<Point<D>>& from, std::size_t level,
                      const CapMotionOptions& options = {}) const {
        std::vector<Point<D>> targets;
        targets.reserve(boundary_.size());
        for (const Index v : boundary_) {
            targets.push_back(in_space(filling_.points[columns_.at(level, column_of_[v])]));
        }
        return move_cap<D>(from, cells_, boundary_, targets, options);
    }

    /// Moves the initial cap to each level. False if a level has cells that are not positive.
    bool from_start() {
        bool sound = true;
        for (std::size_t level = 1; level < columns_.layers(); ++level) {
            MovedCap<D> cap = moved(levels_.front(), level);
            sound = sound && cap.sound;
            levels_[level] = std::move(cap.points);
        }
        return sound;
    }

    bool step_by_step() {
        const std::size_t last = columns_.layers();
        CapMotionOptions options;
        options.tolerance = careful_tolerance;
        for (std::size_t level = 1; level < last; ++level) {
            MovedCap<D> cap = moved(levels_[level - 1], level, options);
            if (!cap.sound) {
                return false;
            }
            levels_[level] = std::move(cap.points);
        }
        const Array<Point<D>> end = moved(levels_[last - 1], last, options).points;
        for (std::size_t level = 1; level < last; ++level) {
            const double share =
                (columns_.times[level] - columns_.times[0]) / (columns_.times[last] - columns_.times[0]);
            for (std::size_t v = 0; v < end.size(); ++v) {
                for (std::size_t k = 0; k < D; ++k) {
                    levels_[level][v][k] += share * (levels_[last][v][k] - end[v][k]);
                }
            }
            if (!all_positive(levels_[level])) {
                return false;
            }
        }
        return true;
    }

    bool all_positive(const Array<Point<D>>& places) const {
        return std::all_of(cells_.begin(), cells_.end(), [&](const Simplex<D>& cell) {
            return signed_measure<D>(corners_of<D, D>(cell, places)) > 0;
        });
    }

    void store() {
        for (std::size_t level = 1; level < columns_.layers(); ++level) {
            for (Index v = 0; v < column_of_.size(); ++v) {
                if (columns_.on_boundary[column_of_[v]] == 0) {
                    Point<D + 1>& point = filling_.points[columns_.at(level, column_of_[v])];
                    std::copy_n(levels_[level][v].begin(), D, point.begin());
                    point[D] = columns_.times[level];
                }
            }
        }
    }

    const SlabColumns<D>& columns_;
    Filling<D>& filling_;
    std::vector<Array<Point<D>>> levels_; ///< by level, the places of the initial cap's vertices
    Array<Simplex<D>> cells_;
    std::vector<Index> column_of_; ///< column of each vertex of the initial cap
    std::vector<Index> boundary_;  ///< the initial cap's vertices on the side
};

} // namespace

template<int D>
void place_inside(const Hull<D>& hull, const SlabColumns<D>& columns, Filling<D>& filling) {
    if (columns.layers() > 1) {
        InnerPlaces<D>{hull, columns, filling}.run();
    }
}

template void place_inside<2>(const Hull<2>&, const SlabColumns<2>&, Filling<2>&);
template void place_inside<3>(const Hull<3>&, const SlabColumns<3>&, Filling<3>&);

} // namespace slabhull
