// SPDX-License-Identifier: BSD-3-Clause
// The format is described at https://mfem.org/mesh-format-v1.0, "Straight meshes".
#include "slabhull/io/files.h"

#include "io/files/comments.h"
#include "io/files/file_cursor.h"
#include "io/mesh/cell_groups.h"
#include "io/others/mfem_types.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

namespace slabhull::io {

namespace {

class MfemReader {
public:
    MfemReader(std::string_view bytes, const std::string& path) : in_{bytes, path} { soup_.path = path; }

    Soup read() {
        const std::string_view head = in_.line();
        in_.require(head.starts_with("MFEM "), "this is no MFEM mesh: \"MFEM mesh v1.0\" was expected");
        in_.require(head.substr(0, head.find_last_not_of(" \t") + 1) == "MFEM mesh v1.0",
                    "only \"MFEM mesh v1.0\" is read; save the mesh without curves, refinement and NURBS");
        read_dimension();
        read_elements("elements", dimension_);
        read_elements("boundary", dimension_ - 1);
        read_vertices();
        check_vertices("element", dimension_);
        check_vertices("boundary element", dimension_ - 1);
        list_groups_in_use(soup_);
        return std::move(soup_);
    }

private:
    void read_dimension() {
        expect_keyword(in_, "dimension");
        dimension_ = in_.parsed<int>("a dimension");
        in_.require(dimension_ >= 1 && dimension_ <= 3, "dimension 1, 2 or 3 was expected");
    }

    void read_elements(const std::string& section, int dimension) {
        expect_keyword(in_, section);
        SimplexBlock& block = soup_.simplices[static_cast<std::size_t>(dimension)];
        const auto corners = static_cast<std::size_t>(dimension) + 1;
        const auto claimed = in_.parsed<std::uint64_t>("a count");
        const std::size_t count = in_.plausible(claimed, 2 * (corners + 2) - 1, section.c_str());
        checked_index(count, section.c_str());
        starts_[static_cast<std::size_t>(dimension)] = in_.offset();
        block.vertices.resize(count * corners);
        block.physical.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            skip_comments(in_);
            block.physical[i] = in_.parsed<std::int32_t>("an attribute");
            if (!(block.physical[i] > 0)) {
                in_.fail(fmt::format("{} number {} has the attribute {}, which is not positive", section, i,
                                     block.physical[i]));
            }
            const int type = in_.parsed<int>("a geometry type");
            if (type != mfem_simplex_type(dimension)) {
                in_.fail(
                    fmt::format("{} number {} has the geometry type {}; in dimension {} only type {} is read",
                                section, i, type, dimension, mfem_simplex_type(dimension)));
            }
            in_.numbers(block.vertices.data() + i * corners, corners, "a vertex's number");
        }
    }

    void read_vertices() {
        expect_keyword(in_, "vertices");
        const auto claimed = in_.parsed<std::uint64_t>("a count");
        skip_comments(in_);
        in_.require(!in_.rest().starts_with("nodes"), "curved meshes (\"nodes\") are not read");
        const auto width = in_.parsed<std::size_t>("the number of coordinates");
        in_.require(width >= static_cast<std::size_t>(dimension_) && width <= 3,
                    fmt::format("{} to 3 coordinates were expected", dimension_));
        const std::size_t count = in_.plausible(claimed, 2 * width - 1, "vertices");
        checked_index(count, "vertices");
        soup_.points.assign(count, Point<3>{});
        for (std::size_t i = 0; i < count; ++i) {
            skip_comments(in_);
            in_.numbers(soup_.points[i].data(), width, "a vertex's coordinates");
            for (const double x : soup_.points[i]) {
                if (!std::isfinite(x)) {
                    in_.fail(fmt::format("vertex {} has a coordinate that is not a finite number", i));
                }
            }
        }
        in_.require(in_.remaining() > 0, "the last line does not end; the file seems to be cut short");
        skip_comments(in_);
        in_.require(in_.at_end(), "the end of the file was expected");
    }

    /// Vertices come last in the file, so indices can be checked only after them.
    void check_vertices(const char* what, int dimension) const {
        const auto place = static_cast<std::size_t>(dimension);
        const Array<Index>& vertices = soup_.simplices[place].vertices;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            if (vertices[i] >= soup_.points.size()) {
                in_.fail_at(starts_[place], fmt::format("{} {} has the vertex {}, but there are {}", what,
                                                        i / (place + 1), vertices[i], soup_.points.size()));
            }
        }
    }

    FileCursor in_;
    Soup soup_;
    int dimension_ = 0;
    std::array<std::size_t, 4> starts_{}; ///< starts of the lists of simplices, by dimension
};

} // namespace

Soup read_mfem(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    return MfemReader{{bytes.data(), bytes.size()}, path.string()}.read();
}

} // namespace slabhull::io
