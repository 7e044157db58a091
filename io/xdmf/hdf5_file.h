// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/mesh/column_stream.h"
#include "slabhull/core/index.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace slabhull::io {

// HDF5 files, from one thread at a time. All of it throws UsageError in a build without HDF5 (has_hdf5()).

/// The numbers of a dataset, in the file little-endian.
enum class Hdf5Type { float64, int64, int32, uint8 };

/// Makes a file with datasets. Throws OutputError.
class Hdf5Writer {
public:
    /// Writes over `path`; messages call it `name`.
    Hdf5Writer(const std::filesystem::path& path, std::string name);
    ~Hdf5Writer();
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;

    /// A dataset of rows x components, or of rows where there is one component; a few megabytes at a time,
    /// made by several threads. "/group/name": the group is made where it is missing.
    void write(const std::string& dataset, Hdf5Type type, std::size_t rows, int components,
               const RowFill& fill);
    /// What was written is in the file only after it.
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

class Hdf5Dataset;

/// A file to be read. Throws InputError naming the file and the dataset. Damaged files are not trusted: a
/// dataset must have its bytes in the file, packed at most as deflate can, and no byte is read twice. Refused
/// are links to other files, data elsewhere, filters other than deflate, shuffle and checksums, and numbers
/// other than integers and reals.
class Hdf5Reader {
public:
    explicit Hdf5Reader(const std::filesystem::path& path);
    ~Hdf5Reader();
    Hdf5Reader(Hdf5Reader&&) noexcept;

    Hdf5Dataset open(const std::string& dataset);

private:
    friend class Hdf5Dataset;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// A dataset of a reader, which must outlive it.
class Hdf5Dataset {
public:
    ~Hdf5Dataset();
    Hdf5Dataset(Hdf5Dataset&&) noexcept;

    const std::vector<std::uint64_t>& extents() const;
    bool has_reals() const;
    /// All values, row by row, straight to `out`: rows of `width` numbers there, of which the first `used`
    /// are set. Integers that do not fit are refused.
    void read(double* out, std::size_t rows, std::size_t used, std::size_t width) const;
    void read(std::int64_t* out, std::size_t rows, std::size_t used, std::size_t width) const;
    void read(Index* out, std::size_t rows, std::size_t used, std::size_t width) const;

private:
    friend class Hdf5Reader;
    struct Impl;
    explicit Hdf5Dataset(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace slabhull::io
