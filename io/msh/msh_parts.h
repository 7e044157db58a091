// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/core/point_set.h"
#include "slabhull/io/atomic_file.h"
#include "slabhull/io/files.h"
#include "slabhull/io/soup.h"

#include <cstddef>
#include <memory>
#include <unordered_map>
#include <vector>

namespace slabhull::io {

struct Box {
    Point<3> min;
    Point<3> max;
};

Box box_of(const Column<double>& points);

/// The discrete entities of one dimension: one for each group number, in the order of first occurrence.
class MshEntities {
public:
    explicit MshEntities(const std::vector<MeshColumns::Group>& groups);

    std::size_t size() const { return groups_.size(); }
    /// The physical group's number of entity `i`, counted from 0.
    PatchNumber group(std::size_t i) const { return groups_[i]; }
    /// The entity, counted from 1, of groups with a number.
    std::size_t of(PatchNumber group) const { return numbers_.at(group); }

private:
    std::vector<PatchNumber> groups_;
    std::unordered_map<PatchNumber, std::size_t> numbers_;
};

/// The tags of the rows of a list: consecutive or, for a part of a list, those in the whole list.
struct MshTags {
    std::size_t before = 0;            ///< tags used before those of the list
    const PointSet* members = nullptr; ///< nullptr: all

    std::size_t operator()(std::size_t row) const {
        return before + (members != nullptr ? members->member(row) : row) + 1;
    }
};

/// The simplices of one dimension.
struct MshPart {
    int dimension;
    const Column<std::int64_t>& cells;
    std::vector<MeshColumns::Group> groups;
    std::shared_ptr<const MshEntities> entities; ///< of the whole mesh
    MshTags tags;
};

/// The cells first, so that their tags are their numbers from 1; then lower simplices.
std::vector<MshPart> msh_parts(const MeshColumns& mesh);

/// The content of one MSH file: a mesh, or a piece of one.
struct MshContent {
    const MeshColumns& mesh;           ///< the points and the data
    std::vector<MshPart> parts;        ///< the cells and lower simplices; none is empty
    MshTags nodes;                     ///< of the points
    const std::vector<MshPart>& model; ///< the simplices of the whole mesh
    Box box;                           ///< of the whole mesh
    std::size_t pieces = 0;            ///< number of pieces; 0: not cut
    std::size_t piece = 0;             ///< number of this piece, from 0
};

void write_msh(AtomicFile& file, const MshContent& content, const MshOptions& options);

/// Throws FormatLimit if data have more rows than MSH can count.
void require_msh_rows(const MeshColumns& mesh);

} // namespace slabhull::io
