// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/space_time_files.h"

#include "io/files/comments.h"
#include "io/files/file_bytes.h"
#include "io/files/file_cursor.h"
#include "io/others/mfem_types.h"
#include "io/space_time/getfem_reader.h"
#include "io/space_time/h5_reader.h"
#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace slabhull::io {

namespace {

constexpr std::string_view h5_signature{"\x89HDF\r\n\x1a\n", 8};

std::string start_of(const std::filesystem::path& path) {
    std::ifstream in{path, std::ios::binary};
    std::string start(256, '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(in.gcount()));
    return start;
}

/// MFEM mesh v1.0 of simplices in space-time.
class MfemReader {
public:
    MfemReader(std::string_view bytes, const std::string& path) : in_{bytes, path} { soup_.path = path; }

    SpaceTimeSoup read() {
        const std::string_view head = in_.line();
        in_.require(head.substr(0, head.find_last_not_of(" \t\r") + 1) == "MFEM mesh v1.0",
                    "\"MFEM mesh v1.0\" was expected");
        expect_keyword(in_, "dimension");
        soup_.dimension = in_.parsed<int>("a dimension");
        in_.require(soup_.dimension == 3 || soup_.dimension == 4,
                    "dimension 3 or 4 of space-time was expected");
        Array<std::int64_t> attribute; // of elements: not kept
        read_elements("elements", soup_.dimension, soup_.cells, attribute);
        read_elements("boundary", soup_.dimension - 1, soup_.facets, soup_.facet_attribute);
        read_vertices();
        return std::move(soup_);
    }

private:
    static bool right_type(int type, int dimension) {
        return dimension == 4 ? type >= 6 && type <= 8 : type == mfem_simplex_type(dimension);
    }

    void read_elements(const std::string& section, int dimension, Array<Index>& vertices,
                       Array<std::int64_t>& attribute) {
        expect_keyword(in_, section);
        const auto corners = static_cast<std::size_t>(dimension) + 1;
        const auto claimed = in_.parsed<std::uint64_t>("a count");
        const std::size_t count = in_.plausible(claimed, 2 * (corners + 2) - 1, section.c_str());
        checked_index(count, section.c_str());
        vertices.resize(count * corners);
        attribute.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            attribute[i] = in_.parsed<std::int32_t>("an attribute");
            const int type = in_.parsed<int>("a geometry type");
            in_.require(
                right_type(type, dimension),
                fmt::format("{} number {} has the geometry type {}, which is no simplex of dimension {}",
                            section, i, type, dimension));
            in_.numbers(vertices.data() + i * corners, corners, "a vertex's number");
        }
    }

    void read_vertices() {
        expect_keyword(in_, "vertices");
        const auto claimed = in_.parsed<std::uint64_t>("a count");
        skip_comments(in_);
        const auto width = in_.parsed<int>("the number of coordinates");
        in_.require(width == soup_.dimension, fmt::format("{} coordinates were expected", soup_.dimension));
        const auto columns = static_cast<std::size_t>(width);
        const std::size_t count = in_.plausible(claimed, 2 * columns - 1, "vertices");
        checked_index(count, "vertices");
        soup_.points.resize(count * columns);
        for (std::size_t i = 0; i < count; ++i) {
            in_.numbers(soup_.points.data() + i * columns, columns, "a vertex's coordinates");
        }
    }

    FileCursor in_;
    SpaceTimeSoup soup_;
};

void require_vertices(const SpaceTimeSoup& soup, const Array<Index>& vertices, std::size_t corners,
                      const char* what) {
    const std::size_t count = soup.points.size() / static_cast<std::size_t>(soup.dimension);
    const auto bad = std::find_if(vertices.begin(), vertices.end(), [&](Index v) { return v >= count; });
    if (bad != vertices.end()) {
        const auto row = static_cast<std::size_t>(bad - vertices.begin()) / corners;
        throw InputError{
            fmt::format("{}: {} {} has the vertex {}, but there are {}", soup.path, what, row, *bad, count),
            {{what, static_cast<std::int64_t>(row), {}}}};
    }
}

void require_finite(const SpaceTimeSoup& soup) {
    const auto bad =
        std::find_if(soup.points.begin(), soup.points.end(), [](double x) { return !std::isfinite(x); });
    if (bad != soup.points.end()) {
        const auto vertex = (bad - soup.points.begin()) / soup.dimension;
        throw InputError{
            fmt::format("{}: vertex {} has a coordinate that is not a finite number", soup.path, vertex),
            {{"vertex", vertex, {}}}};
    }
}

} // namespace

bool is_space_time_file(const std::filesystem::path& path) {
    const std::string start = start_of(path);
    if (start.starts_with(h5_signature) || starts_like_getfem(start)) {
        return true;
    }
    const std::size_t keyword = start.find("dimension");
    return start.starts_with("MFEM mesh") && keyword != std::string::npos &&
           start.find_first_not_of(" \t\r\n", keyword + 9) == start.find('4', keyword + 9);
}

SpaceTimeSoup read_space_time(const std::filesystem::path& path) {
    SpaceTimeSoup soup;
    if (start_of(path).starts_with(h5_signature)) {
        soup = read_h5(path);
    } else {
        const Array<char> bytes = read_bytes(path);
        const std::string_view text{bytes.data(), bytes.size()};
        soup = starts_like_getfem(text) ? read_getfem(text, path.string())
                                        : MfemReader{text, path.string()}.read();
    }
    const auto width = static_cast<std::size_t>(soup.dimension);
    require_vertices(soup, soup.cells, width + 1, "cell");
    require_vertices(soup, soup.facets, width, "facet");
    require_finite(soup);
    return soup;
}

} // namespace slabhull::io
