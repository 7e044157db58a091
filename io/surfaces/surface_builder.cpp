// SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_builder.h"

#include "io/files/utf8.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <numeric>

namespace slabhull::io {

namespace {

constexpr std::size_t no_name = std::numeric_limits<std::size_t>::max();

/// The name without blanks around it and without characters that would end it in other files.
std::string tidy(std::string_view name) {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t first = std::min(name.find_first_not_of(blanks), name.size());
    name = name.substr(first, name.find_last_not_of(blanks) + 1 - first);
    std::string text = as_utf8(readable(name));
    std::replace(text.begin(), text.end(), '"', '\'');
    return text;
}

} // namespace

void FaceLabels::set(std::size_t face, std::string_view name) {
    const std::string text = tidy(name);
    std::size_t number = no_name;
    if (!text.empty()) {
        const auto [place, is_new] = numbers_.emplace(text, names_.size());
        number = place->second;
        if (is_new) {
            names_.push_back(text);
        }
    }
    if (!runs_.empty() && runs_.back().first == face) {
        runs_.back().second = number;
    } else {
        runs_.emplace_back(face, number);
    }
}

std::size_t FaceLabels::in_use(std::size_t faces) const {
    std::vector<bool> used(names_.size(), false);
    for (std::size_t run = 0; run < runs_.size(); ++run) {
        if (runs_[run].second != no_name && end_of(run, faces) > runs_[run].first) {
            used[runs_[run].second] = true;
        }
    }
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
}

void FaceLabels::give(std::size_t faces, SimplexBlock& block, PatchList& groups) const {
    if (in_use(faces) == 0) {
        return;
    }
    std::vector<PatchNumber> number(names_.size(), 0);
    block.physical.assign(faces, 0);
    for (std::size_t run = 0; run < runs_.size(); ++run) {
        const auto [begin, name] = runs_[run];
        const std::size_t end = end_of(run, faces);
        if (name == no_name || end <= begin) {
            continue;
        }
        if (number[name] == 0) {
            number[name] = static_cast<PatchNumber>(groups.size() + 1);
            groups.push_back({number[name], names_[name]});
        }
        std::fill(block.physical.begin() + static_cast<std::ptrdiff_t>(begin),
                  block.physical.begin() + static_cast<std::ptrdiff_t>(end), number[name]);
    }
}

void SurfaceBuilder::start_tags() {
    if (!numbers_faces_) {
        numbers_faces_ = true; // the tags alone do not tell: there may be none yet
        tags_.resize(faces_);
        std::iota(tags_.begin(), tags_.end(), std::int64_t{0});
    }
}

PolygonFault SurfaceBuilder::add_face(std::span<const Index> corners) {
    if (corners.size() == 3) {
        add_triangle(corners[0], corners[1], corners[2]);
        return PolygonFault::none;
    }
    polygon_.clear();
    for (const Index corner : corners) {
        polygon_.push_back(points[corner]);
    }
    const PolygonFault fault = cut_polygon(polygon_, cut_);
    if (fault != PolygonFault::none) {
        return fault;
    }
    start_tags();
    for (const PolygonTriangle& triangle : cut_) {
        for (const std::size_t place : triangle) {
            corners_.push_back(corners[place]);
        }
    }
    tags_.insert(tags_.end(), cut_.size(), static_cast<std::int64_t>(faces_));
    ++faces_;
    ++polygons_;
    pieces_ += cut_.size();
    return fault;
}

void SurfaceBuilder::skip_face() {
    start_tags();
    ++faces_;
    ++skipped_;
}

void SurfaceBuilder::label(Soup& soup) const {
    const auto used = [this](const FaceLabels& each) { return each.in_use(triangles()); };
    auto chosen =
        std::find_if(labels.begin(), labels.end(), [&](const auto& each) { return used(each) > 1; });
    if (chosen == labels.end()) {
        chosen = std::find_if(labels.begin(), labels.end(), [&](const auto& each) { return used(each) > 0; });
    }
    if (chosen != labels.end()) {
        chosen->give(triangles(), soup.simplices[2], soup.groups[2]);
    }
}

void SurfaceBuilder::remark(Soup& soup) const {
    for (const std::string& remark : remarks) {
        soup.remarks.push_back(fmt::format("{}: {}", soup.path, remark));
    }
    if (polygons_ > 0) {
        soup.remarks.push_back(
            fmt::format("{}: {} planar polygons are cut into {} triangles", soup.path, polygons_, pieces_));
    }
    if (skipped_ > 0) {
        soup.remarks.push_back(
            fmt::format("{}: {} facets with two equal corners are left out", soup.path, skipped_));
    }
}

Soup SurfaceBuilder::finish(const std::string& path) {
    Soup soup;
    soup.path = path;
    label(soup);
    remark(soup);
    soup.points = std::move(points);
    soup.simplices[2].vertices = std::move(corners_);
    soup.simplices[2].tags = std::move(tags_);
    return soup;
}

} // namespace slabhull::io
