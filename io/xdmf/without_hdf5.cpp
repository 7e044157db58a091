// SPDX-License-Identifier: BSD-3-Clause
#include "io/xdmf/hdf5_file.h"

#include "slabhull/core/error.h"
#include "slabhull/io/files.h"

#include <fmt/format.h>

namespace slabhull::io {

struct Hdf5Writer::Impl {};
struct Hdf5Reader::Impl {};
struct Hdf5Dataset::Impl {};

namespace {

[[noreturn]] void refuse(const std::string& name) {
    throw UsageError{fmt::format("{}: this build neither reads nor writes HDF5, where XDMF has its data, "
                                 "since it was made without it. "
                                 "Install Debian's libhdf5-dev and build with -DSLABHULL_HDF5=ON, or use VTU",
                                 name)};
}

} // namespace

bool has_hdf5() {
    return false;
}

Hdf5Writer::Hdf5Writer(const std::filesystem::path&, std::string name) {
    refuse(name);
}
Hdf5Writer::~Hdf5Writer() = default;
void Hdf5Writer::write(const std::string&, Hdf5Type, std::size_t, int, const RowFill&) {}
void Hdf5Writer::close() {}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) {
    refuse(path.string());
}
Hdf5Reader::~Hdf5Reader() = default;
Hdf5Reader::Hdf5Reader(Hdf5Reader&&) noexcept = default;
Hdf5Dataset Hdf5Reader::open(const std::string& dataset) {
    refuse(dataset);
}

Hdf5Dataset::Hdf5Dataset(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Hdf5Dataset::~Hdf5Dataset() = default;
Hdf5Dataset::Hdf5Dataset(Hdf5Dataset&&) noexcept = default;
const std::vector<std::uint64_t>& Hdf5Dataset::extents() const {
    refuse("");
}
bool Hdf5Dataset::has_reals() const {
    return false;
}
void Hdf5Dataset::read(double*, std::size_t, std::size_t, std::size_t) const {}
void Hdf5Dataset::read(std::int64_t*, std::size_t, std::size_t, std::size_t) const {}
void Hdf5Dataset::read(Index*, std::size_t, std::size_t, std::size_t) const {}

} // namespace slabhull::io
