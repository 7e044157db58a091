// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtu_skeleton.h"

#include "io/files/file_cursor.h"

#include <algorithm>

namespace slabhull::io {

VtuSkeleton::VtuSkeleton(FileBytes& file) : file_{file} {
    while (next()) {
    }
}

/// Reads a text and a tag; false at the end.
bool VtuSkeleton::next() {
    pass_blanks();
    const std::size_t begin = at_;
    if (!pass("<", nullptr)) {
        return false;
    }
    if (at_ > begin) {
        places_.push_back({xml_.size(), {begin, at_}});
        xml_ += 'x';
    }
    if (starts_with("<!--")) {
        return pass_until("-->");
    }
    if (starts_with("<![CDATA[")) {
        return pass_until("]]>");
    }
    const bool is_last = starts_with("<AppendedData");
    const std::size_t tag = xml_.size();
    places_.push_back({tag, {at_, at_}});
    if (!pass_tag()) {
        return false;
    }
    if (is_last) {
        appended_is_base64_ = xml_.find("base64", tag) != std::string::npos;
        const bool has_mark = pass("_", nullptr);
        appended_ = {at_ + (has_mark ? 1 : 0), file_.size()};
        xml_.resize(tag);
        xml_ += "</VTKFile>";
    }
    return !is_last;
}

/// Moves to the first of some characters, keeping what it passes if wanted; false if there is none.
bool VtuSkeleton::pass(std::string_view stops, std::string* kept) {
    while (at_ < file_.size()) {
        file_.load(at_, at_ + 1);
        const std::string_view there = file_.view().substr(at_, file_.loaded_end() - at_);
        const std::size_t found = stops.size() == 1 ? there.find(stops.front()) : there.find_first_of(stops);
        const std::size_t passed = std::min(found, there.size());
        if (kept != nullptr) {
            kept->append(there.substr(0, passed));
        }
        at_ += passed;
        if (found != std::string_view::npos) {
            return true;
        }
    }
    return false;
}

void VtuSkeleton::pass_blanks() {
    while (at_ < file_.size()) {
        file_.load(at_, at_ + 1);
        const std::string_view there = file_.view().substr(at_, file_.loaded_end() - at_);
        const auto end = std::find_if_not(there.begin(), there.end(), is_blank);
        at_ += static_cast<std::size_t>(end - there.begin());
        if (end != there.end()) {
            return;
        }
    }
}

bool VtuSkeleton::starts_with(std::string_view text) {
    file_.load(at_, at_ + text.size());
    return file_.view().substr(at_, std::min(file_.loaded_end() - at_, text.size())) == text;
}

/// Moves past a tag, in which '>' may be part of an attribute's value.
bool VtuSkeleton::pass_tag() {
    while (pass("\"'>", &xml_)) {
        const char stop = file_.view()[at_++];
        xml_ += stop;
        if (stop == '>') {
            return true;
        }
        if (!pass({&stop, 1}, &xml_)) {
            return false;
        }
        xml_ += stop;
        ++at_;
    }
    return false;
}

bool VtuSkeleton::pass_until(std::string_view end) {
    std::string passed;
    do {
        if (!pass(">", &passed)) {
            return false;
        }
        passed += '>';
        ++at_;
    } while (!passed.ends_with(end));
    return true;
}

FileRange VtuSkeleton::text(std::ptrdiff_t byte) const {
    const auto found =
        std::lower_bound(places_.begin(), places_.end(), static_cast<std::size_t>(byte),
                         [](const Place& place, std::size_t wanted) { return place.byte < wanted; });
    return byte >= 0 && found != places_.end() && found->byte == static_cast<std::size_t>(byte) ? found->text
                                                                                                : FileRange{};
}

std::ptrdiff_t VtuSkeleton::in_file(std::ptrdiff_t byte) const {
    const auto after = std::upper_bound(
        places_.begin(), places_.end(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, byte)),
        [](std::size_t wanted, const Place& place) { return wanted < place.byte; });
    if (after == places_.begin()) {
        return byte;
    }
    const Place& place = *(after - 1);
    return static_cast<std::ptrdiff_t>(place.text.begin) + byte - static_cast<std::ptrdiff_t>(place.byte);
}

} // namespace slabhull::io
