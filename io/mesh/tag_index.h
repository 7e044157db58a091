// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace slabhull::io {

/// The position of each of a file's own numbers in the order of the file.
/// Numbers without gaps need no memory, few gaps a table, others a search.
class TagIndex {
public:
    TagIndex() = default;
    explicit TagIndex(std::span<const std::int64_t> tags);

    /// no_index when there is no such tag.
    Index find(std::int64_t tag) const {
        const std::uint64_t offset = static_cast<std::uint64_t>(tag) - smallest_;
        if (consecutive_) {
            return offset < count_ ? static_cast<Index>(offset) : no_index;
        }
        return table_.empty() ? search(tag) : offset < table_.size() ? table_[offset] : no_index;
    }
    /// A tag that occurs twice.
    std::optional<std::int64_t> repeated() const { return repeated_; }

private:
    struct Place {
        std::int64_t tag;
        Index index;
    };
    void fill_table(std::span<const std::int64_t> tags, std::uint64_t size);
    void sort(std::span<const std::int64_t> tags);
    Index search(std::int64_t tag) const;

    bool consecutive_ = true;
    std::uint64_t smallest_ = 0; ///< unsigned, so that differences cannot overflow
    std::uint64_t count_ = 0;
    Array<Index> table_;
    Array<Place> places_;
    std::optional<std::int64_t> repeated_;
};

} // namespace slabhull::io
