// SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_readers.h"

#include "io/surfaces/text_line.h"

namespace slabhull::io {

namespace {

class ObjReader {
public:
    ObjReader(FileBytes& file, SurfaceBuilder& surface) : in_{file}, surface_{surface} {
        surface_.labels.resize(3);
    }

    void run() {
        pass_byte_order_mark(in_); // else the first statement would be unknown
        while (!in_.at_end()) {
            read_line(TextLine{in_});
        }
    }

private:
    enum Label : std::size_t { group, object, material };

    void read_line(TextLine line) {
        const std::string_view kind = line.word();
        if (kind == "v") {
            require_whole(line);
            surface_.points.push_back(line.point("vertex", surface_.points.size() + 1));
        } else if (kind == "f") {
            require_whole(line);
            read_face(line);
        } else if (kind == "g") {
            label(group, line);
        } else if (kind == "o") {
            label(object, line);
        } else if (kind == "usemtl") {
            label(material, line);
        }
    }

    void label(Label which, const TextLine& line) {
        surface_.labels[which].set(surface_.triangles(), line.rest());
    }

    static void require_whole(const TextLine& line) {
        if (!line.rest().empty() && line.rest().back() == '\\') {
            line.fail("lines continued by \\ are not read");
        }
    }

    void read_face(TextLine& line) {
        const std::size_t face = surface_.faces() + 1;
        corners_.clear();
        while (!line.at_end()) {
            corners_.push_back(corner(line, face));
        }
        const PolygonFault fault = corners_.size() < 3 ? PolygonFault::no_area : surface_.add_face(corners_);
        if (fault != PolygonFault::none) {
            line.fail(fmt::format("face {} has {} vertices{}", face, corners_.size(), explained(fault)));
        }
    }

    /// "7", "7/1" or "7//3", counted from 1 or, when negative, from the last one.
    Index corner(TextLine& line, std::size_t face) {
        const std::string_view word = line.word();
        std::int64_t number = 0;
        const auto [stop, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (problem != std::errc{} || (stop != word.data() + word.size() && *stop != '/')) {
            line.fail(
                fmt::format("face {}: a vertex's number was expected, not \"{}\"", face, word.substr(0, 40)));
        }
        const auto points = static_cast<std::int64_t>(surface_.points.size());
        const std::int64_t place = number < 0 ? number + points : number - 1;
        if (number == 0 || place < 0 || place >= points) {
            line.fail(
                fmt::format("face {} names vertex {}, but {} were given before it", face, number, points));
        }
        return static_cast<Index>(place);
    }

    FileCursor in_;
    SurfaceBuilder& surface_;
    std::vector<Index> corners_;
};

} // namespace

void read_obj(FileBytes& file, SurfaceBuilder& surface) {
    ObjReader{file, surface}.run();
}

} // namespace slabhull::io
