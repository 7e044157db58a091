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

/// Names of faces; each holds from one face of a file until the next name.
class FaceLabels {
public:
    /// Labels faces from `face` on; an empty name ends the label. Names are stored fit for messages and
    /// files.
    void set(std::size_t face, std::string_view name);
    /// Number of names in use among the first `faces` faces.
    std::size_t in_use(std::size_t faces) const;
    /// Makes groups of the names in use, numbered from 1 in order; none if there are no names.
    void give(std::size_t faces, SimplexBlock& block, PatchList& groups) const;

private:
    std::size_t end_of(std::size_t run, std::size_t faces) const {
        return run + 1 < runs_.size() ? std::min(faces, runs_[run + 1].first) : faces;
    }

    std::map<std::string, std::size_t, std::less<>> numbers_; ///< of the names, from 0
    std::vector<std::string> names_;
    std::vector<std::pair<std::size_t, std::size_t>> runs_; ///< first face, name; no_name for none
};

/// Collects the faces that a reader of surfaces finds: triangles, or polygons, which are cut. Labels are
/// placed by numbers of triangles.
class SurfaceBuilder {
public:
    Array<Point<3>> points;
    std::vector<FaceLabels> labels;   ///< the most specific first
    std::vector<std::string> remarks; ///< of the reader, without the path

    std::size_t triangles() const { return corners_.size() / 3; }
    /// The number of faces in the file, polygons counted once.
    std::size_t faces() const { return faces_; }

    void add_triangle(Index a, Index b, Index c) {
        corners_.push_back(a);
        corners_.push_back(b);
        corners_.push_back(c);
        count_face(1);
    }
    /// Adds a face with at least 3 corners. Needs: vertices in range.
    PolygonFault add_face(std::span<const Index> corners);
    /// Counts a face of the file that is left out because its corners coincide.
    void skip_face();

    /// The soup. The first labels that divide the surface, else the first that name it, become its groups.
    Soup finish(const std::string& path);

private:
    void count_face(std::size_t triangles) {
        if (numbers_faces_) {
            tags_.insert(tags_.end(), triangles, static_cast<std::int64_t>(faces_));
        }
        ++faces_;
    }
    /// Starts storing face numbers, as triangles no longer correspond to faces.
    void start_tags();
    void remark(Soup& soup) const;
    void label(Soup& soup) const;

    Array<Index> corners_;
    bool numbers_faces_ = false; ///< whether triangles have numbers of faces
    Array<std::int64_t> tags_;   ///< the file's numbers, from 0
    std::size_t faces_ = 0;
    std::size_t polygons_ = 0;
    std::size_t pieces_ = 0; ///< triangles cut from polygons
    std::size_t skipped_ = 0;
    std::vector<Point<3>> polygon_;
    std::vector<PolygonTriangle> cut_;
};

} // namespace slabhull::io
