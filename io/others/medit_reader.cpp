// SPDX-License-Identifier: BSD-3-Clause
// P. Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253, 2001, and the list of keywords
// of libMeshb.
#include "slabhull/io/files.h"

#include "io/files/comments.h"
#include "io/files/file_cursor.h"
#include "io/mesh/cell_groups.h"
#include "io/mesh/corners_only.h"
#include "io/mesh/readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <set>

namespace slabhull::io {

namespace {

/// The layout of a section that is skipped.
struct PassedSection {
    std::string_view name;
    std::size_t numbers; ///< numbers in a row; 0: one per dimension
};

constexpr std::array passed_sections{
    PassedSection{"Corners", 1},
    PassedSection{"Ridges", 1},
    PassedSection{"RequiredVertices", 1},
    PassedSection{"RequiredEdges", 1},
    PassedSection{"RequiredTriangles", 1},
    PassedSection{"RequiredTetrahedra", 1},
    PassedSection{"Normals", 0},
    PassedSection{"NormalAtVertices", 2},
    PassedSection{"NormalAtTriangleVertices", 3},
    PassedSection{"Tangents", 0},
    PassedSection{"TangentAtVertices", 2},
    PassedSection{"TangentAtEdges", 3},
    PassedSection{"SubDomainFromMesh", 4},
};

constexpr std::array<std::string_view, 5> refused_sections{"Quadrilaterals", "Hexahedra", "Hexaedra",
                                                           "Prisms", "Pyramids"};

class MeditReader {
public:
    MeditReader(std::string_view bytes, const std::string& path, const ReadOptions& options)
        : in_{bytes, path}, options_{options} {
        soup_.path = path;
    }

    Soup read() {
        read_head();
        while (read_section()) {
        }
        in_.require(seen_.contains("Vertices"), "there is no section Vertices");
        list_groups_in_use(soup_);
        corners_only_.finish(soup_);
        return std::move(soup_);
    }

private:
    std::string keyword() {
        skip_comments(in_);
        return std::string{in_.word()};
    }

    void read_head() {
        in_.require(keyword() == "MeshVersionFormatted",
                    "this is no Medit file: MeshVersionFormatted was expected");
        skip_comments(in_);
        const int version = in_.parsed<int>("a version from 1 to 4");
        in_.require(version >= 1 && version <= 4, "a version from 1 to 4 was expected");
        in_.require(keyword() == "Dimension", "Dimension was expected");
        skip_comments(in_);
        dimension_ = in_.parsed<std::size_t>("a dimension");
        in_.require(dimension_ >= 2 && dimension_ <= 4, "dimension 2, 3 or 4 was expected");
    }

    /// Reads a section; false at the end.
    bool read_section() {
        const std::string name = keyword();
        constexpr std::size_t shown = 40;
        in_.require(!name.empty(), "the file ends without End");
        if (name == "End") {
            return false;
        }
        in_.require(seen_.insert(name).second, name.substr(0, shown) + " appears twice");
        if (name == "Vertices") {
            read_vertices();
        } else if (const auto dimension = simplex_dimension(name)) {
            read_simplices(*dimension, name, *dimension + 1);
        } else if (const auto curved = name.ends_with("P2")
                                           ? simplex_dimension(name.substr(0, name.size() - 2))
                                           : std::nullopt) {
            read_simplices(*curved, name, (*curved + 1) * (*curved + 2) / 2);
        } else if (std::find(refused_sections.begin(), refused_sections.end(), name) !=
                   refused_sections.end()) {
            in_.require(count_of(name.c_str(), 1) == 0, name + " are not read; only straight simplices are");
        } else {
            pass(name.substr(0, shown));
        }
        return true;
    }

    static std::optional<std::size_t> simplex_dimension(const std::string& name) {
        constexpr std::array<std::string_view, 3> names{"Edges", "Triangles", "Tetrahedra"};
        const auto found = std::find(names.begin(), names.end(), name);
        return found == names.end()
                   ? std::nullopt
                   : std::optional<std::size_t>{static_cast<std::size_t>(found - names.begin()) + 1};
    }

    /// The count at the head of a section, checked for rows of so many numbers.
    std::size_t count_of(const char* what, std::size_t numbers) {
        skip_comments(in_);
        const auto claimed = in_.parsed<std::uint64_t>("a count");
        return in_.plausible(claimed, 2 * numbers - 1, what);
    }

    void pass(const std::string& name) {
        const auto section = std::find_if(passed_sections.begin(), passed_sections.end(),
                                          [&](const PassedSection& one) { return one.name == name; });
        in_.require(section != passed_sections.end(), "\"" + name + "\" is no keyword that is known here");
        const std::size_t width = section->numbers > 0 ? section->numbers : dimension_;
        const std::size_t rows = count_of(name.c_str(), width);
        for (std::size_t i = 0; i < rows * width; ++i) {
            skip_comments(in_);
            in_.parsed<double>("a number");
        }
    }

    void read_vertices() {
        const std::size_t count = count_of("vertices", dimension_ + 1);
        checked_index(count, "vertices");
        soup_.points.assign(count, Point<3>{});
        Array<double> time(dimension_ == 4 ? count : 0);
        Array<std::int64_t> references(count);
        for (std::size_t i = 0; i < count; ++i) {
            const std::array<double, 4> x = read_coordinates(i);
            std::copy_n(x.begin(), 3, soup_.points[i].begin());
            if (dimension_ == 4) {
                time[i] = x[3];
            }
            references[i] = in_.parsed<std::int64_t>("a vertex's reference");
        }
        if (dimension_ == 4) {
            soup_.point_data.push_back({"t", 1, std::move(time)});
        }
        if (std::any_of(references.begin(), references.end(), [](std::int64_t one) { return one != 0; })) {
            soup_.point_data.push_back({"medit:ref", 1, std::move(references)});
        }
    }

    std::array<double, 4> read_coordinates(std::size_t vertex) {
        skip_comments(in_);
        std::array<double, 4> x{};
        in_.numbers(x.data(), dimension_, "a vertex's coordinates");
        for (const double value : x) {
            if (!std::isfinite(value)) {
                in_.fail(fmt::format("vertex {} has a coordinate that is not a finite number", vertex + 1));
            }
        }
        return x;
    }

    /// Corners come first; simplices of second order then have nodes between them.
    void read_simplices(std::size_t dimension, const std::string& name, std::size_t nodes) {
        in_.require(seen_.contains("Vertices"), "Vertices were expected before " + name);
        SimplexBlock& block = soup_.simplices[dimension];
        const std::size_t count = count_of(name.c_str(), nodes + 1);
        const bool curved = nodes > dimension + 1;
        if (curved && count > 0 && !options_.linear) {
            in_.fail(fmt::format("{} are of second order; {}", name, how_to_take_corners));
        }
        checked_index(block.physical.size() + count, name.c_str());
        corners_only_.add_cells(curved ? count : 0);
        block.vertices.reserve(block.vertices.size() + count * (dimension + 1));
        for (std::size_t i = 0; i < count; ++i) {
            skip_comments(in_);
            for (std::size_t k = 0; k < nodes; ++k) {
                const Index vertex = read_vertex_of(name, i);
                if (k <= dimension) {
                    block.vertices.push_back(vertex);
                } else {
                    corners_only_.add_between(vertex, soup_.points.size());
                }
            }
            block.physical.push_back(in_.parsed<std::int32_t>("a reference"));
            if (block.physical.back() < 0) {
                in_.fail(fmt::format("{} number {} has the negative reference {}", name, i + 1,
                                     block.physical.back()));
            }
        }
    }

    Index read_vertex_of(const std::string& name, std::size_t simplex) {
        const auto vertex = in_.parsed<std::uint64_t>("a vertex's number");
        if (vertex == 0 || vertex > soup_.points.size()) {
            in_.fail(fmt::format("{} number {} has the vertex {}, but vertices go from 1 to {}", name,
                                 simplex + 1, vertex, soup_.points.size()));
        }
        return static_cast<Index>(vertex - 1);
    }

    FileCursor in_;
    const ReadOptions& options_;
    CornersOnly corners_only_;
    Soup soup_;
    std::size_t dimension_ = 3; ///< of space
    std::set<std::string> seen_;
};

} // namespace

Soup read_medit(const std::filesystem::path& path) {
    return read_medit(path, ReadOptions{});
}

Soup read_medit(const std::filesystem::path& path, const ReadOptions& options) {
    const Array<char> bytes = read_bytes(path);
    return MeditReader{{bytes.data(), bytes.size()}, path.string(), options}.read();
}

} // namespace slabhull::io
