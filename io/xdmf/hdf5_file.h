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

// HDF5 files, for one thread at a time. Everything throws UsageError in a build without HDF5 (has_hdf5()).

/// The number type of a dataset, little-endian in the file.
enum class Hdf5Type { float64, int64, int32, uint8 };

/// Makes a file with datasets. Throws OutputError.
class Hdf5Writer {
public:
    /// Overwrites `path`; messages call it `name`.
    Hdf5Writer(const std::filesystem::path& path, std::string name);
    ~Hdf5Writer();
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;

    /// Writes a dataset of rows x components, or of rows if there is one component; several threads make a
    /// few megabytes at a time. "/group/name": the group is made if it is missing.
    void write(const std::string& dataset, Hdf5Type type, std::size_t rows, int components,
               const RowFill& fill);
    /// Closes the file; data are complete only after it.
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

class Hdf5Dataset;

/// A file to be read. Throws InputError naming the file and the dataset. Files may be damaged: a dataset must
/// have its bytes in the file, packed no denser than deflate can, and no byte is read twice. Links to other
/// files, external data, filters other than deflate, shuffle and checksums, and numbers other than integers
/// and reals are refused.
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
    /// Reads all values, row by row, to `out`, where rows have `width` numbers, of which the first `used` are
    /// set. Integers that do not fit are refused.
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
