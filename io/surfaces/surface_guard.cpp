// SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_guard.h"

#include "io/files/coordinate.h"
#include "io/files/file_cursor.h"

#include <array>
#include <cctype>
#include <fmt/format.h>

namespace slabhull::io {

namespace {

std::string lower(std::string_view text) {
    std::string result;
    for (const char c : text) {
        result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return result;
}

/// Three coordinates as they stand, each after a blank.
std::string copy_point(FileCursor& in, Point<3>& point, const std::string& whose) {
    std::string text;
    for (double& x : point) {
        in.skip_blanks();
        const std::string_view rest = in.rest();
        const std::size_t begin = in.offset();
        x = in.parsed<double>("a coordinate");
        require_coordinate(in, x, whose);
        text += ' ';
        text += rest.substr(0, in.offset() - begin);
    }
    return text;
}

// --- STL ---

void expect(FileCursor& in, std::string_view keyword) {
    const std::string_view found = in.word();
    if (lower(found) != keyword) {
        in.fail(fmt::format("\"{}\" was expected, not \"{}\"", keyword, found.substr(0, 40)));
    }
}

std::string copy_facet(FileCursor& in, std::size_t facet) {
    expect(in, "normal");
    for (int i = 0; i < 3; ++i) {
        in.word(); // normals are often nonsense, and not needed
    }
    expect(in, "outer");
    expect(in, "loop");
    std::string text = "facet normal 0 0 0\nouter loop\n";
    for (int i = 0; i < 3; ++i) {
        expect(in, "vertex");
        Point<3> point{};
        text += "vertex" + copy_point(in, point, fmt::format("facet {}", facet)) + '\n';
    }
    const std::string_view end = in.word();
    if (lower(end) == "vertex") {
        in.fail(fmt::format("facet {} has more than three vertices", facet));
    }
    if (lower(end) != "endloop") {
        in.fail(fmt::format("\"endloop\" was expected, not \"{}\"", end.substr(0, 40)));
    }
    expect(in, "endfacet");
    return text + "endloop\nendfacet\n";
}

GuardedSurface guard_text_stl(FileCursor in) {
    GuardedSurface guarded;
    guarded.text = "solid\n";
    while (!in.at_end()) {
        expect(in, "solid");
        in.line(); // its name
        std::string word = lower(in.word());
        for (; word == "facet"; word = lower(in.word())) {
            guarded.text += copy_facet(in, guarded.faces++);
        }
        if (word != "endsolid") {
            in.fail(fmt::format("\"facet\" or \"endsolid\" was expected, not \"{}\"", word.substr(0, 40)));
        }
        in.line();
    }
    guarded.text += "endsolid\n";
    return guarded;
}

constexpr std::size_t stl_head = 84; // title and count
constexpr std::size_t stl_facet = 50;

GuardedSurface guard_binary_stl(std::string_view bytes, FileCursor in) {
    GuardedSurface guarded;
    guarded.binary = true;
    guarded.text = bytes;
    in.set_binary(true);
    in.seek(stl_head);
    for (; in.remaining() > 0; ++guarded.faces) {
        std::array<float, 12> values{}; // normal and corners
        in.numbers(values.data(), values.size(), "a facet");
        for (std::size_t i = 3; i < values.size(); ++i) {
            require_coordinate(in, values[i], fmt::format("facet {}", guarded.faces));
        }
        in.take(2, "a facet");
    }
    return guarded;
}

// --- OFF ---

/// The next line that says anything, without its comment.
std::string_view next_line(FileCursor& in, const char* wanted) {
    while (!in.at_end()) {
        std::string_view line = in.line();
        line = line.substr(0, line.find('#'));
        if (line.find_first_not_of(" \t\r") != std::string_view::npos) {
            return line;
        }
    }
    in.fail(fmt::format("the file ends where {} was expected", wanted));
}

/// A cursor that ends with the line but counts lines as the file does.
class LineCursor : public FileCursor {
public:
    LineCursor(std::string_view bytes, std::string_view line, const std::string& path)
        : FileCursor{bytes.substr(0, static_cast<std::size_t>(line.data() - bytes.data()) + line.size()),
                     path} {
        seek(static_cast<std::size_t>(line.data() - bytes.data()));
    }
};

std::uint32_t corner(FileCursor& in, std::size_t points, const std::string& face) {
    const auto index = in.parsed<std::int64_t>("a vertex's number");
    if (index < 0 || static_cast<std::uint64_t>(index) >= points) {
        in.fail(fmt::format("{} names vertex {}, but there are {}", face, index, points));
    }
    return static_cast<std::uint32_t>(index);
}

void require_off_head(FileCursor& in, std::string_view line) {
    const std::string_view kind = line.substr(0, line.find_first_of(" \t\r"));
    if (lower(line).find("binary") != std::string::npos) {
        in.fail("binary OFF is not read; save it as text");
    }
    if (kind != "OFF" && kind != "COFF" && kind != "NOFF" && kind != "CNOFF" && kind != "STOFF") {
        in.fail(fmt::format("OFF was expected, not \"{}\"", kind.substr(0, 40)));
    }
}

} // namespace

GuardedSurface guard_stl(std::string_view bytes, const std::string& path) {
    FileCursor in{bytes, path};
    std::uint32_t count = 0;
    if (bytes.size() >= stl_head) {
        std::memcpy(&count, bytes.data() + stl_head - sizeof count, sizeof count);
    }
    const std::uint64_t binary_size = stl_head + std::uint64_t{stl_facet} * count;
    if (bytes.size() == binary_size) { // the only safe sign: binary files may start with "solid", too
        return guard_binary_stl(bytes, in);
    }
    if (lower(bytes.substr(0, 5)) == "solid") {
        return guard_text_stl(in);
    }
    in.set_binary(true);
    in.fail(bytes.size() < stl_head ? "this is no STL file"
                                    : fmt::format("{} facets take {} bytes, but the file has {}", count,
                                                  binary_size, bytes.size()));
}

GuardedSurface guard_off(std::string_view bytes, const std::string& path) {
    FileCursor in{bytes, path};
    require_off_head(in, next_line(in, "OFF"));
    const std::string_view counts = next_line(in, "the counts");
    LineCursor head{bytes, counts, path};
    const std::size_t points =
        in.plausible(head.parsed<std::uint64_t>("the count of vertices"), 6, "vertices");
    const std::size_t faces = in.plausible(head.parsed<std::uint64_t>("the count of faces"), 7, "faces");

    GuardedSurface guarded;
    guarded.text = fmt::format("OFF\n{} {} 0\n", points, faces);
    for (std::size_t i = 0; i < points; ++i) {
        LineCursor line{bytes, next_line(in, "a vertex"), path};
        guarded.points.emplace_back();
        guarded.text += copy_point(line, guarded.points.back(), fmt::format("vertex {}", i)).substr(1) + '\n';
    }
    for (; guarded.faces < faces; ++guarded.faces) {
        LineCursor line{bytes, next_line(in, "a face"), path};
        const std::string face = fmt::format("face {}", guarded.faces);
        if (const auto corners = line.parsed<std::uint64_t>("a count of vertices"); corners != 3) {
            line.fail(fmt::format("{} has {} vertices; only triangles are read", face, corners));
        }
        guarded.text += '3';
        for (int k = 0; k < 3; ++k) {
            guarded.text += fmt::format(" {}", corner(line, points, face));
        }
        guarded.text += '\n';
    }
    return guarded;
}

namespace {

// --- OBJ ---

/// The vertices of a face, "7", "7/1" or "7//3" each, counted from 1 or, when negative, from the last one.
std::string copy_corners(FileCursor& in, std::string_view line, std::size_t points, const std::string& face) {
    std::string text;
    std::size_t corners = 0;
    for (std::size_t at = line.find_first_not_of(" \t\r"); at != std::string_view::npos; ++corners) {
        const std::string_view word = line.substr(at, line.find_first_of(" \t\r", at) - at);
        std::int64_t index = 0;
        const auto [stop, problem] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (problem != std::errc{} || (stop != word.data() + word.size() && *stop != '/')) {
            in.fail(fmt::format("{}: a vertex's number was expected, not \"{}\"", face, word.substr(0, 40)));
        }
        const std::int64_t place = index < 0 ? index + static_cast<std::int64_t>(points) : index - 1;
        if (index == 0 || place < 0 || static_cast<std::uint64_t>(place) >= points) {
            in.fail(fmt::format("{} names vertex {}, but {} were given before it", face, index, points));
        }
        text += fmt::format(" {}", place + 1);
        at = line.find_first_not_of(" \t\r", at + word.size());
    }
    if (corners != 3) {
        in.fail(fmt::format("{} has {} vertices; only triangles are read", face, corners));
    }
    return text;
}

} // namespace

GuardedSurface guard_obj(std::string_view bytes, const std::string& path) {
    FileCursor in{bytes, path};
    GuardedSurface guarded;
    while (!in.at_end()) {
        const std::size_t start = in.offset();
        std::string_view line = in.line();
        line = line.substr(0, line.find('#'));
        const std::string_view kind = line.substr(0, std::min(line.find_first_of(" \t\r"), line.size()));
        if (!line.empty() && line.back() == '\\' && (kind == "v" || kind == "f")) {
            in.fail_at(start, "lines continued by \\ are not read");
        }
        if (kind == "v") {
            LineCursor values{bytes, line.substr(1), path};
            guarded.points.emplace_back();
            guarded.text +=
                'v' +
                copy_point(values, guarded.points.back(), fmt::format("vertex {}", guarded.points.size())) +
                '\n';
        } else if (kind == "f") {
            LineCursor place{bytes, line, path};
            const std::string face = fmt::format("face {}", ++guarded.faces);
            guarded.text += 'f' + copy_corners(place, line.substr(1), guarded.points.size(), face) + '\n';
        }
    }
    return guarded;
}

} // namespace slabhull::io
