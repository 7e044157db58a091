// SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_readers.h"

#include "io/surfaces/text_line.h"

#include <algorithm>
#include <array>

namespace slabhull::io {

namespace {

/// The next line that is not empty.
TextLine next_line(FileCursor& in, const char* wanted) {
    while (!in.at_end()) {
        const TextLine line{in};
        if (!line.at_end()) {
            return line;
        }
    }
    in.fail(fmt::format("the file ends where {} was expected", wanted));
}

/// The line of counts: the second one, or the rest of the first one after its keyword.
TextLine pass_head(FileCursor& in) {
    constexpr std::array<std::string_view, 5> kinds{"OFF", "COFF", "NOFF", "CNOFF", "STOFF"};
    TextLine line = next_line(in, "OFF");
    const std::string_view kind = line.word();
    if (line.rest().starts_with("BINARY") || line.rest().starts_with("binary")) {
        line.fail("binary OFF is not read; save it as text");
    }
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) {
        line.fail(fmt::format("OFF was expected, not \"{}\"", kind.substr(0, 40)));
    }
    return line.at_end() ? next_line(in, "the counts") : line;
}

void read_face(TextLine line, SurfaceBuilder& surface, std::vector<Index>& corners) {
    const auto count = line.parsed<std::uint64_t>("a count of vertices");
    if (count < 3 || count > line.rest().size()) { // a vertex takes a digit at least
        line.fail(fmt::format("face {} has {} vertices, which are not there or no polygon", surface.faces(),
                              count));
    }
    corners.clear();
    for (std::uint64_t k = 0; k < count; ++k) {
        const auto vertex = line.parsed<std::int64_t>("a vertex's number");
        if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= surface.points.size()) {
            line.fail(fmt::format("face {} names vertex {}, but there are {}", surface.faces(), vertex,
                                  surface.points.size()));
        }
        corners.push_back(static_cast<Index>(vertex));
    }
    const PolygonFault fault = surface.add_face(corners);
    if (fault != PolygonFault::none) {
        line.fail(fmt::format("face {} has {} vertices{}", surface.faces(), count, explained(fault)));
    }
}

/// Comments and empty lines may follow.
void require_end(FileCursor& in, std::size_t faces) {
    while (!in.at_end()) {
        const TextLine line{in};
        if (!line.at_end()) {
            line.fail(fmt::format("more follows after the {} faces that the file says it has; correct the "
                                  "counts, or export it anew",
                                  faces));
        }
    }
}

} // namespace

void read_off(FileBytes& file, SurfaceBuilder& surface) {
    FileCursor in{file};
    pass_byte_order_mark(in);
    TextLine counts = pass_head(in);
    const auto claimed_points = counts.parsed<std::uint64_t>("the count of vertices");
    const auto claimed_faces = counts.parsed<std::uint64_t>("the count of faces");
    const std::size_t points = in.plausible(claimed_points, 6, "vertices");
    const std::size_t faces = in.plausible(claimed_faces, 7, "faces");
    for (std::size_t i = 0; i < points; ++i) {
        surface.points.push_back(next_line(in, "a vertex").point("vertex", i));
    }
    std::vector<Index> corners;
    for (std::size_t i = 0; i < faces; ++i) {
        read_face(next_line(in, "a face"), surface, corners);
    }
    require_end(in, faces);
}

} // namespace slabhull::io
