// SPDX-License-Identifier: BSD-3-Clause
// The format is described in ParaView's documentation, "ParaView's data file format (PVD)".
#include "slabhull/io/files.h"

#include "io/vtk/xml_text.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace slabhull::io {

namespace {

void require_writable(const std::filesystem::path& path, const SeriesEntry& entry) {
    const std::string name = entry.file.generic_string();
    if (!std::isfinite(entry.time)) {
        throw UsageError{fmt::format("{}: the time of {} is {}, which is not a finite number", path.string(),
                                     name, entry.time)};
    }
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
    if (std::any_of(name.begin(), name.end(), is_control)) {
        throw UsageError{fmt::format("{}: a file of the series has control characters in its name, which XML "
                                     "cannot hold",
                                     path.string())};
    }
}

} // namespace

void write_pvd(const std::filesystem::path& path, std::span<const SeriesEntry> entries) {
    std::string xml = "<?xml version=\"1.0\"?>\n"
                      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
                      "<Collection>\n";
    std::map<double, int> parts; // so far, by time
    for (const SeriesEntry& entry : entries) {
        require_writable(path, entry);
        xml += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", entry.time,
                           parts[entry.time]++, escaped(entry.file.generic_string()));
    }
    write_text(path, xml + "</Collection>\n</VTKFile>\n");
}

} // namespace slabhull::io
