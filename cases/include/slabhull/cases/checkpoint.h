// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/march.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace slabhull {

/// The files that belong to the state of a march.
struct CheckpointFiles {
    std::string cap;                    ///< name of the cap's file, beside the checkpoint (write_cap())
    std::uint32_t cap_checksum = 0;     ///< of that file
    std::uint64_t journal_size = 0;     ///< bytes of the slabs' journal that belong to slabs accepted
    std::uint32_t journal_checksum = 0; ///< of those bytes
    std::uint32_t case_checksum = 0;    ///< of the case file, and of tables and surfaces that it names
};

/// Writes where a march stands, so that it can go on from there: all but what the cap's file holds. A small
/// file of fixed little-endian fields that ends with its own checksum (docs/formats.md); it replaces the one
/// before in one step. The cap's file must be on disk. Throws OutputError.
template<int D>
void write_checkpoint(const std::filesystem::path& path, const MarchState<D>& state,
                      const CheckpointFiles& files);

template<int D>
struct Checkpoint {
    MarchState<D> state;
    CheckpointFiles files;
};

/// Reads a checkpoint and its cap: the state that was written, bit for bit. Throws InputError naming the
/// file when one of them is damaged, is missing, or does not belong to the other.
template<int D>
Checkpoint<D> read_checkpoint(const std::filesystem::path& path);

} // namespace slabhull
