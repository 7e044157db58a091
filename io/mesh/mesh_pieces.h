// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point_set.h"
#include "slabhull/io/piece.h"
#include "slabhull/io/soup.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace slabhull::io {

/// Arrays of a piece with the numbers in the whole mesh, under VTK's own names.
inline constexpr const char* global_points = "GlobalPointIds";
inline constexpr const char* global_cells = "GlobalCellIds";

/// The XML attribute, after a blank, that marks such an array for VTK; empty if none of the arrays is one.
std::string global_ids_attribute(const std::vector<DataColumn>& data);

/// A range of a mesh's cells, as a mesh of its own.
struct MeshPiece {
    MeshColumns mesh; ///< points and cells numbered within the piece, data of both, field data, groups
    std::size_t first_cell = 0;
    std::shared_ptr<const PointSet> points;             ///< its points in the whole mesh
    std::vector<std::shared_ptr<const PointSet>> lower; ///< its lower simplices in each Part
};

/// The same of a piece that was made elsewhere.
MeshPiece mesh_piece(const PieceColumns& piece);

/// The pieces of a mesh: ranges of cells of nearly equal length, in order, and the points that each uses, in
/// their order in the mesh. A simplex of a lower dimension belongs to the first piece that has its points, or
/// to the last if none has. Points that no cell uses belong to the last. Columns of a piece refer to those of
/// the mesh, which must outlive them. Memory: less than three bits per point of the mesh, for any number of
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
    PointSet used_;               ///< points used by earlier pieces
    std::vector<PointSet> taken_; ///< lower simplices taken by earlier pieces, by Part
};

/// "room_3.vtu" for piece 3 of room.pvtu.
std::filesystem::path piece_path(const std::filesystem::path& whole, std::size_t piece,
                                 const char* extension);

} // namespace slabhull::io
