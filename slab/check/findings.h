// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pieces.h"
#include "slabhull/core/column.h"
#include "slabhull/core/integer_list.h"
#include "slabhull/core/parallel.h"
#include "slabhull/slab/check.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace slabhull {

/// Adds findings to a result as text and entities. Counts all, keeps a limited number of each kind.
class Findings {
public:
    Findings(CheckResult& result, const CheckOptions& options) : result_{result}, options_{options} {}

    void vertex(Defect what, Index vertex, const std::string& detail) {
        vertices(what, {&vertex, 1}, {}, detail);
    }
    void cell(Defect what, Index cell, const std::string& detail) { cells(what, {&cell, 1}, detail); }

    /// About a vertex, an edge or a facet, given by its vertices, with the cells involved.
    void vertices(Defect what, std::span<const Index> vertices, std::span<const Index> cells,
                  const std::string& detail);
    /// About the first of `cells`.
    void cells(Defect what, std::span<const Index> cells, const std::string& detail);
    void other(Defect what, std::vector<Entity> entities, const std::string& text);
    /// Sets the count of findings that were counted elsewhere.
    void set_count(Defect what, std::size_t count) { result_.found[static_cast<std::size_t>(what)] = count; }

    /// Notes, once per check, that it was skipped.
    void skip(const std::string& check, const std::string& reason);

    std::size_t count(Defect what) const { return result_.count(what); }
    bool any(std::initializer_list<Defect> kinds) const {
        return std::any_of(kinds.begin(), kinds.end(), [&](Defect what) { return count(what) > 0; });
    }

    /// Entities with the user's numbers.
    std::vector<Entity> vertex_entities(std::span<const Index> vertices) const {
        return name("vertex", vertices);
    }
    std::vector<Entity> cell_entities(std::span<const Index> cells) const { return name("cell", cells); }

private:
    bool keep(Defect what);
    std::vector<Entity> name(const char* kind, std::span<const Index> numbers) const;

    CheckResult& result_;
    const CheckOptions& options_;
};

/// Numbers that one thread of select() tests at a time.
constexpr std::size_t select_grain = 1 << 16;

/// The numbers below `count` for which `bad` holds, ascending; tested in parallel.
template<class Predicate>
std::vector<Index> select(std::size_t count, const Predicate& bad) {
    return parallel_gather<Index>(count, select_grain,
                                  [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
                                      for (std::size_t k = begin; k < end; ++k) {
                                          if (bad(k)) {
                                              found.push_back(static_cast<Index>(k));
                                          }
                                      }
                                  });
}

/// The rows of a column for which bad(row, values) holds, ascending; tested in parallel.
template<class Predicate>
std::vector<Index> select_rows(const Column<std::int64_t>& column, const Predicate& bad) {
    constexpr std::size_t grain = 1 << 14;
    const auto width = static_cast<std::size_t>(column.components());
    return parallel_gather<Index>(column.rows(), grain,
                                  [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
                                      Array<std::int64_t> values((end - begin) * width); // not cleared first
                                      column.fill(begin, end, values.data());
                                      for (std::size_t row = begin; row < end; ++row) {
                                          if (bad(row, values.data() + (row - begin) * width)) {
                                              found.push_back(static_cast<Index>(row));
                                          }
                                      }
                                  });
}

/// One row of a column.
inline std::vector<std::int64_t> row_of(const Column<std::int64_t>& column, std::size_t row) {
    std::vector<std::int64_t> values(static_cast<std::size_t>(column.components()));
    column.fill(row, row + 1, values.data());
    return values;
}

/// Calls visit(row, values) for each row of a column, with only a few rows in memory.
template<class Visit>
void each_row(const Column<std::int64_t>& column, const Visit& visit) {
    constexpr std::size_t batch = 1 << 14;
    const auto width = static_cast<std::size_t>(column.components());
    std::vector<std::int64_t> values(std::min(batch, column.rows()) * width);
    for (std::size_t begin = 0; begin < column.rows(); begin += batch) {
        const std::size_t end = std::min(column.rows(), begin + batch);
        column.fill(begin, end, values.data());
        for (std::size_t row = begin; row < end; ++row) {
            visit(row, values.data() + (row - begin) * width);
        }
    }
}

/// All values of a column, for random access.
template<class T>
Array<T> read_column(const Column<std::int64_t>& column) {
    Array<T> values(column.rows());
    each_row(column,
             [&](std::size_t row, const std::int64_t* value) { values[row] = static_cast<T>(*value); });
    return values;
}

/// All values of a column of ids or tracks.
inline IntegerList read_ids(const Column<std::int64_t>& column) {
    IntegerList ids;
    each_row(column, [&](std::size_t, const std::int64_t* value) { ids.push_back(*value); });
    return ids;
}

} // namespace slabhull
