// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/surfaces/polygon.h"
#include "slabhull/core/array.h"
#include "slabhull/io/soup.h"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace slabhull::io {

/// Names that hold from one face of a file on until the next name.
class FaceLabels {
public:
    /// An empty name is no label. Names are stored as messages and files can show them.
    void set(std::size_t face, std::string_view name);
    /// How many names some of so many faces have.
    std::size_t in_use(std::size_t faces) const;
    /// Groups of the names that are in use, numbered from 1 as they come; nothing where there are none.
    void give(std::size_t faces, SimplexBlock& block, PatchList& groups) const;

private:
    std::size_t end_of(std::size_t run, std::size_t faces) const {
        return run + 1 < runs_.size() ? std::min(faces, runs_[run + 1].first) : faces;
    }

    std::map<std::string, std::size_t, std::less<>> numbers_; ///< of the names, from 0
    std::vector<std::string> names_;
    std::vector<std::pair<std::size_t, std::size_t>> runs_; ///< first face, name; no_name for none
};

/// Collects what a reader of surfaces finds. Faces are triangles or polygons, which are cut; places of labels
/// are counts of triangles.
class SurfaceBuilder {
public:
    Array<Point<3>> points;
    std::vector<FaceLabels> labels; ///< the most telling first

    std::size_t triangles() const { return corners_.size() / 3; }
    /// As the file counts, polygons once.
    std::size_t faces() const { return faces_; }

    void add_triangle(Index a, Index b, Index c) {
        corners_.push_back(a);
        corners_.push_back(b);
        corners_.push_back(c);
        count_face(1);
    }
    /// A face of any length from 3 on, with vertices that exist.
    PolygonFault add_face(std::span<const Index> corners);
    /// A face of the file that is left out, for its corners fell together.
    void skip_face();

    /// The first labels that part the surface, else the first that name it, become its groups.
    Soup finish(const std::string& path);

private:
    void count_face(std::size_t triangles) {
        if (!tags_.empty()) {
            tags_.insert(tags_.end(), triangles, static_cast<std::int64_t>(faces_));
        }
        ++faces_;
    }
    /// From now on, triangles are not counted as the file's faces are.
    void start_tags();
    void remark(Soup& soup) const;
    void label(Soup& soup) const;

    Array<Index> corners_;
    Array<std::int64_t> tags_; ///< the file's numbers, from 0; empty while each face is a triangle
    std::size_t faces_ = 0;
    std::size_t polygons_ = 0;
    std::size_t pieces_ = 0; ///< triangles of the polygons
    std::size_t skipped_ = 0;
    std::vector<Point<3>> polygon_;
    std::vector<PolygonTriangle> cut_;
};

} // namespace slabhull::io
