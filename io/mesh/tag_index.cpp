// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/tag_index.h"

#include <algorithm>

namespace slabhull::io {

TagIndex::TagIndex(std::span<const std::int64_t> tags) : count_{tags.size()} {
    if (tags.empty()) {
        return;
    }
    smallest_ = static_cast<std::uint64_t>(tags.front());
    for (std::size_t i = 0; i < tags.size() && consecutive_; ++i) {
        consecutive_ = static_cast<std::uint64_t>(tags[i]) - smallest_ == i;
    }
    if (consecutive_) {
        return;
    }
    const auto [least, most] = std::minmax_element(tags.begin(), tags.end());
    smallest_ = static_cast<std::uint64_t>(*least);
    const std::uint64_t range = static_cast<std::uint64_t>(*most) - smallest_;
    if (range / 4 <= count_) { // the table is not larger than the file
        fill_table(tags, range + 1);
    } else {
        sort(tags);
    }
}

void TagIndex::fill_table(std::span<const std::int64_t> tags, std::uint64_t size) {
    table_.assign(size, no_index);
    for (std::size_t i = 0; i < tags.size(); ++i) {
        Index& place = table_[static_cast<std::uint64_t>(tags[i]) - smallest_];
        if (place != no_index) {
            repeated_ = tags[i];
        }
        place = static_cast<Index>(i);
    }
}

void TagIndex::sort(std::span<const std::int64_t> tags) {
    places_.resize(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) {
        places_[i] = {tags[i], static_cast<Index>(i)};
    }
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.tag < b.tag; });
    const auto twice = std::adjacent_find(places_.begin(), places_.end(),
                                          [](const Place& a, const Place& b) { return a.tag == b.tag; });
    if (twice != places_.end()) {
        repeated_ = twice->tag;
    }
}

Index TagIndex::search(std::int64_t tag) const {
    const auto found =
        std::lower_bound(places_.begin(), places_.end(), tag,
                         [](const Place& place, std::int64_t wanted) { return place.tag < wanted; });
    return found != places_.end() && found->tag == tag ? found->index : no_index;
}

} // namespace slabhull::io
