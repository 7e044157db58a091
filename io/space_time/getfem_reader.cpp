// SPDX-License-Identifier: BSD-3-Clause
// GetFEM's own reader and writer: getfem_mesh.cc, read_from_file() and write_to_file().
#include "io/space_time/getfem_reader.h"

#include "io/files/file_cursor.h"
#include "io/mesh/tag_index.h"
#include "slabhull/core/text.h"
#include "slabhull/topology/spatial_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

namespace slabhull::io {

namespace {

constexpr std::string_view getfem_head{"% GETFEM MESH FILE"};

/// How many words there are before the end of the line.
std::size_t words_on_line(std::string_view text) {
    std::size_t words = 0;
    bool blank = true;
    for (const char c : text.substr(0, text.find('\n'))) {
        words += blank && !is_blank(c) ? 1 : 0;
        blank = is_blank(c);
    }
    return words;
}

std::string told(std::string_view word) {
    return word.empty() ? "the end of the file" : readable(word);
}

class GetfemReader {
public:
    GetfemReader(std::string_view bytes, const std::string& path) : in_{bytes, path} { soup_.path = path; }

    SpaceTimeSoup read() {
        while (next_section()) {
            const std::string_view name = in_.word();
            if (name == "POINTS") {
                read_points();
            } else if (name == "MESH") {
                read_convexes();
            } else if (name == "REGION") {
                read_region();
            } else {
                pass_over(name);
            }
        }
        in_.require(corners_ > 0, "there is no BEGIN MESH STRUCTURE DESCRIPTION: a mesh without cells");
        return std::move(soup_);
    }

private:
    /// Goes behind the next BEGIN; false at the end of the file.
    bool next_section() {
        skip_remarks();
        if (in_.at_end()) {
            return false;
        }
        expect("BEGIN");
        return true;
    }

    void skip_remarks() {
        in_.skip_blanks();
        while (in_.remaining() > 0 && in_.rest().front() == '%') {
            in_.line();
            in_.skip_blanks();
        }
    }

    void expect(std::string_view keyword) {
        const std::size_t place = in_.offset();
        if (const std::string_view word = in_.word(); word != keyword) {
            in_.fail_at(place, fmt::format("{} was expected, not {}", keyword, told(word)));
        }
    }

    /// "COUNT n" of a section, which it may be without.
    std::optional<std::size_t> count(std::size_t least_size, const char* what) {
        const std::size_t place = in_.offset();
        if (in_.word() != "COUNT") {
            in_.seek(place);
            return std::nullopt;
        }
        const auto claimed = in_.parsed<std::uint64_t>("a count");
        return checked_index(in_.plausible(claimed, least_size, what), what);
    }

    /// Whether another row of the section begins: `keyword`, or END.
    bool next_row(std::string_view keyword) {
        in_.skip_blanks();
        const std::size_t place = in_.offset();
        const std::string_view word = in_.word();
        if (word == keyword) {
            return true;
        }
        if (word != "END") {
            in_.fail_at(place, fmt::format("{} or END was expected, not {}", keyword, told(word)));
        }
        return false;
    }

    struct Rows {
        std::optional<std::size_t> claimed;
        std::vector<std::int64_t> numbers;
    };

    /// Reads the rows of a section: read_row() what stands behind the keyword, which returns the row's
    /// number. The count that the section may begin with goes to reserve().
    template<class Reserve, class ReadRow>
    Rows read_rows(std::string_view keyword, std::size_t least_size, const char* what, const Reserve& reserve,
                   const ReadRow& read_row) {
        Rows rows;
        while (next_row(keyword)) {
            if (rows.numbers.empty() && !rows.claimed) {
                rows.claimed = count(least_size, what);
                if (rows.claimed) {
                    reserve(*rows.claimed);
                    rows.numbers.reserve(*rows.claimed);
                    continue;
                }
            }
            rows.numbers.push_back(read_row());
        }
        return rows;
    }

    /// The numbers of all rows, each different.
    TagIndex numbered(const Rows& rows, const char* what) {
        const auto& [claimed, numbers] = rows;
        if (claimed && *claimed != numbers.size()) {
            in_.fail(fmt::format("{} {} were announced, but there are {}", *claimed, what, numbers.size()));
        }
        checked_index(numbers.size(), what);
        TagIndex index{numbers};
        if (index.repeated()) {
            in_.fail(fmt::format("two {} have the number {}", what, *index.repeated()));
        }
        return index;
    }

    void read_points() {
        in_.require(soup_.points.empty(), "a second list of points");
        expect("LIST");
        const auto reserve = [&](std::size_t points) { soup_.points.reserve(points * 4); };
        const Rows rows = read_rows("POINT", 13, "points", reserve, [&] { return read_point(); });
        expect("POINTS");
        expect("LIST");
        in_.require(!rows.numbers.empty(), "there are no points");
        points_ = numbered(rows, "points");
    }

    std::int64_t read_point() {
        if (soup_.dimension == 0) {
            find_dimension();
        }
        const auto number = in_.parsed<std::uint32_t>("a point's number");
        const std::size_t at = soup_.points.size();
        const auto size = static_cast<std::size_t>(soup_.dimension);
        soup_.points.resize(at + size);
        in_.numbers(soup_.points.data() + at, size, "a point's coordinates");
        return number;
    }

    void find_dimension() {
        const std::size_t words = words_on_line(in_.rest());
        if (words != 4 && words != 5) {
            in_.fail(fmt::format("a point of {} coordinates; 3 or 4 of space-time were expected",
                                 words == 0 ? 0 : words - 1));
        }
        soup_.dimension = static_cast<int>(words) - 1;
    }

    void read_convexes() {
        expect("STRUCTURE");
        expect("DESCRIPTION");
        in_.require(soup_.dimension > 0, "BEGIN POINTS LIST was expected before the convexes");
        in_.require(corners_ == 0, "a second list of convexes");
        corners_ = static_cast<std::size_t>(soup_.dimension) + 1;
        const std::string kind = fmt::format("'GT_PK({},1)'", soup_.dimension);
        const auto reserve = [&](std::size_t convexes) { soup_.cells.reserve(convexes * corners_); };
        const Rows rows = read_rows("CONVEX", 29, "convexes", reserve, [&] { return read_convex(kind); });
        expect("MESH");
        expect("STRUCTURE");
        expect("DESCRIPTION");
        convexes_ = numbered(rows, "convexes");
        region_of_face_.assign(soup_.cells.size(), -1);
    }

    std::int64_t read_convex(std::string_view kind) {
        const auto number = in_.parsed<std::uint32_t>("a convex's number");
        if (const std::string_view found = in_.word(); found != kind) {
            in_.fail(fmt::format("convex {} is of the kind {}; only simplices of the points' dimension, "
                                 "{}, are read",
                                 number, told(found), kind));
        }
        for (std::size_t i = 0; i < corners_; ++i) {
            soup_.cells.push_back(read_corner(number));
        }
        return number;
    }

    Index read_corner(std::int64_t convex) {
        const auto number = in_.parsed<std::uint32_t>("a vertex's number");
        const Index vertex = points_.find(number);
        if (vertex == no_index) {
            in_.fail(fmt::format("convex {} has the point {}, which does not exist", convex, number));
        }
        return vertex;
    }

    /// Of entries "convex/face", and "convex" for all of one, which are no facets.
    void read_region() {
        in_.require(corners_ > 0, "BEGIN MESH STRUCTURE DESCRIPTION was expected before the regions");
        const auto region = in_.parsed<std::int32_t>("a region's number");
        while (true) {
            in_.skip_blanks();
            const std::size_t place = in_.offset();
            const std::string_view entry = in_.word();
            if (entry == "END") {
                break;
            }
            std::uint32_t convex = 0;
            const char* end = entry.data() + entry.size();
            const auto [stop, problem] = std::from_chars(entry.data(), end, convex);
            std::uint32_t face = 0;
            const bool whole = problem == std::errc{} && stop == end;
            if (!whole && (problem != std::errc{} || *stop != '/' ||
                           std::from_chars(stop + 1, end, face).ptr != end || stop + 1 == end)) {
                in_.fail_at(place,
                            fmt::format("a face \"convex/face\" of region {} or END was expected, not {}",
                                        region, told(entry)));
            }
            const Index cell = convexes_.find(convex);
            if (cell == no_index || face >= corners_) {
                in_.fail_at(place,
                            fmt::format("region {} has {}, which is in no convex", region, told(entry)));
            }
            if (!whole) {
                add_facet(region, cell, face, place);
            }
        }
        expect("REGION");
        in_.require(in_.parsed<std::int32_t>("a region's number") == region,
                    fmt::format("END REGION {} was expected", region));
    }

    void add_facet(std::int32_t region, Index cell, std::uint32_t face, std::size_t place) {
        std::int64_t& known = region_of_face_[cell * corners_ + face];
        if (known >= 0) {
            in_.fail_at(place,
                        fmt::format("a face is in region {} and again in region {}; a facet of a filling "
                                    "has one attribute, so leave out one of the regions",
                                    known, region));
        }
        known = region;
        soup_.dimension == 4 ? add_corners<4>(cell, face) : add_corners<3>(cell, face);
        soup_.facet_attribute.push_back(region);
    }

    template<int N>
    void add_corners(Index cell, std::uint32_t face) {
        Simplex<N> corners;
        std::copy_n(soup_.cells.begin() + static_cast<std::ptrdiff_t>(cell * corners_), N + 1,
                    corners.begin());
        const Facet<N> facet = outward_facet<N>(corners, static_cast<int>(face));
        soup_.facets.insert(soup_.facets.end(), facet.begin(), facet.end());
    }

    void pass_over(std::string_view name) {
        const std::string end = fmt::format("END {}", name);
        in_.require(!name.empty() && in_.seek_text(end), fmt::format("\"{}\" is missing", told(end)));
        in_.take(end.size(), "a section");
    }

    FileCursor in_;
    SpaceTimeSoup soup_;
    std::size_t corners_ = 0; ///< of a convex; 0 until there are any
    TagIndex points_;
    TagIndex convexes_;
    Array<std::int64_t> region_of_face_; ///< cell * corners + face; -1 for none
};

} // namespace

bool starts_like_getfem(std::string_view bytes) {
    return bytes.starts_with(getfem_head);
}

SpaceTimeSoup read_getfem(std::string_view bytes, const std::string& path) {
    return GetfemReader{bytes, path}.read();
}

} // namespace slabhull::io
