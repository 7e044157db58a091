// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/mesh/point_set.h"
#include "slabhull/io/soup.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace slabhull::io {

/// The arrays that tell the whole mesh's numbers in a piece: VTK's own names for them.
inline constexpr const char* global_points = "GlobalPointIds";
inline constexpr const char* global_cells = "GlobalCellIds";

/// What tells VTK that one of the arrays is that: an attribute with a blank in front, or nothing.
std::string global_ids_attribute(const std::vector<DataColumn>& data);

/// A range of a mesh's cells, as a mesh of its own.
struct MeshPiece {
    MeshColumns mesh; ///< points and cells numbered within the piece, data of both, field data, groups
    std::size_t first_cell = 0;
    std::shared_ptr<const PointSet> points;             ///< which of the whole mesh's
    std::vector<std::shared_ptr<const PointSet>> lower; ///< which of each Part in mesh.lower
};

/// The pieces of a mesh: ranges of cells of nearly equal length, in order, and the points that each uses, in
/// their order in the mesh. Simplices of a lower dimension belong to the first piece that has their points;
/// those that none has, and points that no cell uses, belong to the last. Columns of a piece ask those
/// of the mesh, which must outlive them. Memory: less than three bits per point of the mesh, whatever the
/// pieces.
class MeshPieces {
public:
    /// Throws UsageError unless each piece gets a cell.
    MeshPieces(const MeshColumns& mesh, std::size_t pieces);
    bool at_end() const { return next_ == pieces_; }
    /// The next piece.
    MeshPiece next();

private:
    std::size_t first_cell(std::size_t piece) const;
    std::shared_ptr<const PointSet> choose_lower(std::size_t part, PointSet& points);

    const MeshColumns& mesh_;
    std::size_t pieces_;
    std::size_t next_ = 0;
    PointSet used_;               ///< by the pieces before
    std::vector<PointSet> taken_; ///< of each Part of lower simplices
};

/// "room_3.vtu" for the piece 3 of room.pvtu.
std::filesystem::path piece_path(const std::filesystem::path& whole, std::size_t piece,
                                 const char* extension);

} // namespace slabhull::io
