// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "slabhull/core/error.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <pugixml.hpp>
#include <string_view>

namespace slabhull::io {

namespace {

double time_of(const std::filesystem::path& path, const pugi::xml_node& set) {
    const std::string_view text = set.attribute("timestep").value();
    double time = 0;
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), time);
    if (problem != std::errc{} || stop != text.data() + text.size() || !std::isfinite(time)) {
        throw InputError(fmt::format("{}: byte {}: the timestep of a DataSet is no finite number",
                                     path.string(), set.offset_debug()));
    }
    return time;
}

} // namespace

std::vector<SeriesEntry> read_pvd(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    pugi::xml_document document;
    const pugi::xml_parse_result result =
        document.load_buffer(bytes.data(), bytes.size(), pugi::parse_default, pugi::encoding_utf8);
    const pugi::xml_node collection = document.child("VTKFile").child("Collection");
    if (!result || !collection) {
        throw InputError(fmt::format("{}: byte {}: this is no PVD file{}{}", path.string(), result.offset,
                                     result ? "" : ": ", result ? "" : result.description()));
    }
    std::vector<SeriesEntry> entries;
    for (const pugi::xml_node set : collection.children("DataSet")) {
        const std::string file = set.attribute("file").value();
        if (file.empty()) {
            throw InputError(
                fmt::format("{}: byte {}: a DataSet names no file", path.string(), set.offset_debug()));
        }
        entries.push_back({time_of(path, set), path.parent_path() / file});
    }
    return entries;
}

} // namespace slabhull::io
