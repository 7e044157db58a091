// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/rank_order.h"

#include "core/parallel_sort.h"
#include "core/pieces.h"

#include "geometry/meshing/curve_places.h"
#include "geometry/meshing/z_order.h"

#include "slabhull/core/communicator.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_piece = 1 << 14;
constexpr std::size_t samples_per_rank = 512;

/// What cells are sorted by, and the row of the cell.
struct CellKey {
    std::uint64_t place;
    Index number;
    Index row;

    friend bool operator<(const CellKey& a, const CellKey& b) {
        return std::tie(a.place, a.number) < std::tie(b.place, b.number);
    }
};

/// Sends rows of a rank's cells to the ranks where they stand in the order of all.
class RowSorter {
public:
    RowSorter(Array<CellKey> keys, Communicator& ranks) : ranks_{ranks}, keys_{std::move(keys)} {
        parallel_sort(keys_);
        divide();
        Array<CellKey> here = joined(ranks_.all_to_all(slices(keys_, begin_)));
        first_ = static_cast<Index>(ranks_.sum_before(here.size()));
        for (std::size_t k = 0; k < here.size(); ++k) {
            here[k].row = static_cast<Index>(k);
        }
        parallel_sort(here);
        place_.resize(here.size());
        for (std::size_t k = 0; k < here.size(); ++k) {
            place_[here[k].row] = static_cast<Index>(k);
        }
    }

    /// The new numbers of this rank's rows.
    Array<Index> new_numbers() {
        Array<Index> numbers(place_.size());
        std::transform(place_.begin(), place_.end(), numbers.begin(), [this](Index k) { return first_ + k; });
        const std::vector<std::size_t> come = ranks_of_rows();
        const Array<Index> sorted = joined(ranks_.all_to_all(slices(numbers, come)));
        Array<Index> of_rows(keys_.size());
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            of_rows[keys_[k].row] = sorted[k];
        }
        return of_rows;
    }

    /// The rows that stand here.
    template<class Row>
    Array<Row> sent(const Array<Row>& rows) {
        Array<Row> leaving(rows.size());
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            leaving[k] = rows[keys_[k].row];
        }
        const Array<Row> come = joined(ranks_.all_to_all(slices(leaving, begin_)));
        Array<Row> placed(come.size());
        for (std::size_t k = 0; k < come.size(); ++k) {
            placed[place_[k]] = come[k];
        }
        return placed;
    }

private:
    template<class T>
    static std::vector<std::span<const T>> slices(const Array<T>& list,
                                                  const std::vector<std::size_t>& begin) {
        std::vector<std::span<const T>> parts;
        for (std::size_t r = 0; r + 1 < begin.size(); ++r) {
            parts.emplace_back(list.data() + begin[r], begin[r + 1] - begin[r]);
        }
        return parts;
    }

    /// Where in the sorted keys those of each rank begin: between samples that all ranks know.
    void divide() {
        const auto count = static_cast<std::size_t>(ranks_.size());
        const std::size_t step =
            std::max<std::size_t>(1, ranks_.sum(keys_.size()) / (count * samples_per_rank));
        Array<CellKey> mine;
        for (std::size_t k = step / 2; k < keys_.size(); k += step) {
            mine.push_back(keys_[k]);
        }
        Array<CellKey> samples = joined(ranks_.all_gather<CellKey>(mine));
        std::sort(samples.begin(), samples.end());
        begin_.assign(1, 0);
        for (std::size_t r = 1; r < count; ++r) {
            const CellKey& first = samples[samples.size() * r / count];
            begin_.push_back(static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), first) -
                                                      keys_.begin()));
        }
        begin_.push_back(keys_.size());
    }

    /// Where the rows from each rank begin among those that come here.
    std::vector<std::size_t> ranks_of_rows() {
        const auto count = static_cast<std::size_t>(ranks_.size());
        std::vector<std::size_t> leave(count);
        for (std::size_t r = 0; r < count; ++r) {
            leave[r] = begin_[r + 1] - begin_[r];
        }
        std::vector<std::size_t> begin(1, 0);
        for (const Array<std::size_t>& of_rank : ranks_.all_gather<std::size_t>(leave)) {
            begin.push_back(begin.back() + of_rank[static_cast<std::size_t>(ranks_.rank())]);
        }
        return begin;
    }

    Communicator& ranks_;
    Array<CellKey> keys_;
    std::vector<std::size_t> begin_; ///< in keys_, by rank, and the end
    Index first_ = 0;                ///< number of the first cell here
    Array<Index> place_;             ///< of each row that comes, in the order of ranks
};

/// The new numbers of cells across blocks, which other ranks know.
class NumbersAcross {
public:
    NumbersAcross(const CapMesh<3>& mesh, const Array<Index>& fresh, const BlockNumbers& numbers,
                  Communicator& ranks)
        : fresh_{fresh}, numbers_{numbers}, own_{static_cast<std::size_t>(ranks.rank())},
          next_(static_cast<std::size_t>(ranks.size()), 0) {
        std::vector<Array<Index>> asked(next_.size());
        for (const Neighbors<3>& neighbors : mesh.neighbors) {
            for (const Index across : neighbors) {
                if (across != no_index && numbers.rank_of(across) != own_) {
                    asked[numbers.rank_of(across)].push_back(across);
                }
            }
        }
        answers_ = ranks.all_to_all(asked);
        for (Array<Index>& list : answers_) {
            std::transform(list.begin(), list.end(), list.begin(),
                           [&](Index cell) { return fresh[numbers.row_of(cell)]; });
        }
        answers_ = ranks.all_to_all(answers_);
    }

    /// To be asked in the order of the mesh.
    Index operator()(Index across) {
        if (across == no_index) {
            return no_index;
        }
        const std::size_t rank = numbers_.rank_of(across);
        return rank == own_ ? fresh_[numbers_.row_of(across)] : answers_[rank][next_[rank]++];
    }

private:
    const Array<Index>& fresh_;
    const BlockNumbers& numbers_;
    std::size_t own_;
    std::vector<std::size_t> next_;
    std::vector<Array<Index>> answers_;
};

CapMesh<3> sorted_rows(CapMesh<3>&& mesh, Array<CellKey> keys, const BlockNumbers& numbers,
                       Communicator& ranks) {
    RowSorter sorter{std::move(keys), ranks};
    {
        const Array<Index> fresh = sorter.new_numbers();
        NumbersAcross across{mesh, fresh, numbers, ranks};
        for (Neighbors<3>& neighbors : mesh.neighbors) {
            for (Index& cell : neighbors) {
                cell = across(cell);
            }
        }
    }
    mesh.cells = sorter.sent(mesh.cells);
    mesh.neighbors = sorter.sent(mesh.neighbors);
    return std::move(mesh);
}

} // namespace

CapMesh<3> ordered_along_curve(CapMesh<3>&& mesh, const BlockNumbers& numbers, std::size_t fixed_points,
                               Communicator& ranks) {
    const Array<Index> order =
        ranks.broadcast<Index>(ranks.first() ? point_order<3>(mesh.points, fixed_points) : Array<Index>{}, 0);
    const Array<Index> fresh = inverse_order(order);
    const ZOrder<3> curve{mesh.points};
    const Array<Index> number = numbers.numbers_of_rows();
    Array<CellKey> keys(mesh.cells.size());
    parallel_for(keys.size(), cells_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            Simplex<3>& cell = mesh.cells[row];
            keys[row] = {curve(centre_of_cell<3>(cell, mesh.points)), number[row], static_cast<Index>(row)};
            for (Index& v : cell) {
                v = fresh[v];
            }
        }
    });
    Array<Point<3>> points(order.size());
    for (std::size_t v = 0; v < order.size(); ++v) {
        points[v] = mesh.points[order[v]];
    }
    mesh.points = std::move(points);
    return sorted_rows(std::move(mesh), std::move(keys), numbers, ranks);
}

CapMesh<3> ordered_by_number(CapMesh<3>&& mesh, const BlockNumbers& numbers, Communicator& ranks) {
    const Array<Index> number = numbers.numbers_of_rows();
    Array<CellKey> keys;
    for (std::size_t row = 0; row < number.size(); ++row) {
        keys.push_back({0, number[row], static_cast<Index>(row)});
    }
    return sorted_rows(std::move(mesh), std::move(keys), numbers, ranks);
}

} // namespace slabhull
