// SPDX-License-Identifier: BSD-3-Clause
#include "io/xdmf/hdf5_file.h"

#include "io/files/compression.h"
#include "io/xdmf/rehearsal.h"
#include "slabhull/core/error.h"
#include "slabhull/core/text.h"
#include "slabhull/io/files.h"
#include "slabhull/io/files_read.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <hdf5.h>
#include <limits>
#include <utility>

namespace slabhull::io {

namespace {

/// Keeps HDF5 from printing errors while it exists.
class Silence {
public:
    Silence() {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Silence() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

/// An HDF5 handle that must be closed; negative if it could not be opened.
class Handle {
public:
    using Close = herr_t (*)(hid_t);
    Handle(hid_t id, Close closer) : id_{id}, close_{closer} {}
    ~Handle() { close(); }
    Handle(Handle&& other) noexcept : id_{std::exchange(other.id_, H5I_INVALID_HID)}, close_{other.close_} {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    operator hid_t() const { return id_; }
    bool close() {
        const Silence silence;
        const hid_t id = std::exchange(id_, H5I_INVALID_HID);
        return id < 0 || close_(id) >= 0;
    }

private:
    hid_t id_;
    Close close_;
};

herr_t keep_first(unsigned number, const H5E_error2_t* error, void* text) {
    if (number == 0 && error->desc != nullptr) {
        *static_cast<std::string*>(text) = error->desc;
    }
    return 0;
}

/// HDF5's text for its last error, cut to the system's message if there is one.
std::string cause() {
    std::string text;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &text);
    const std::string mark = "error message = '";
    if (const std::size_t begin = text.find(mark); begin != std::string::npos) {
        text = text.substr(begin + mark.size());
        text = text.substr(0, text.find('\''));
    }
    return text.empty() ? "HDF5 does not say why" : text;
}

/// File access that also works on disks without locks.
Handle file_access() {
    Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
#if H5_VERSION_GE(1, 10, 7)
    H5Pset_file_locking(access, false, true);
#endif
    return access;
}

hid_t stored_type(Hdf5Type type) {
    switch (type) {
    case Hdf5Type::int64:
        return H5T_STD_I64LE;
    case Hdf5Type::int32:
        return H5T_STD_I32LE;
    case Hdf5Type::uint8:
        return H5T_STD_U8LE;
    case Hdf5Type::float64:
        break;
    }
    return H5T_IEEE_F64LE;
}

std::size_t size_of(Hdf5Type type) {
    return type == Hdf5Type::uint8   ? 1
           : type == Hdf5Type::int32 ? sizeof(std::int32_t)
                                     : sizeof(std::int64_t);
}

} // namespace

bool has_hdf5() {
    return true;
}

// --- writing

struct Hdf5Writer::Impl {
    std::string name;
    Handle file;

    [[noreturn]] void fail(const std::string& what) const {
        throw OutputError(fmt::format("{}: {}: {}", name, what, cause()));
    }
    hid_t sound(hid_t id, const std::string& dataset) const {
        if (id < 0) {
            fail(fmt::format("dataset {} cannot be written", dataset));
        }
        return id;
    }
};

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path, std::string name) {
    const Silence silence;
    impl_.reset(new Impl{std::move(name),
                         {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, file_access()), H5Fclose}});
    if (impl_->file < 0) {
        impl_->fail("cannot be created");
    }
}
Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::write(const std::string& dataset, Hdf5Type type, std::size_t rows, int components,
                       const RowFill& fill) {
    const Silence silence;
    const auto width = static_cast<std::size_t>(components);
    const std::array<hsize_t, 2> extents{rows, width};
    const int rank = components > 1 ? 2 : 1;
    const Handle space{H5Screate_simple(rank, extents.data(), nullptr), H5Sclose};
    const Handle links{H5Pcreate(H5P_LINK_CREATE), H5Pclose};
    H5Pset_create_intermediate_group(links, 1);
    const Handle creation{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    H5Pset_obj_track_times(creation, false); // same mesh, same bytes
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    const Handle data{impl_->sound(H5Dcreate2(impl_->file, dataset.c_str(), stored_type(type), space, links,
                                              creation, H5P_DEFAULT),
                                   dataset),
                      H5Dclose};
    const std::size_t row_bytes = size_of(type) * width;
    stream_rows(rows, row_bytes, fill, [&](std::size_t first, std::size_t count, const char* bytes) {
        const std::array<hsize_t, 2> begin{first, 0};
        const std::array<hsize_t, 2> size{count, width};
        H5Sselect_hyperslab(space, H5S_SELECT_SET, begin.data(), nullptr, size.data(), nullptr);
        const Handle memory{H5Screate_simple(rank, size.data(), nullptr), H5Sclose};
        impl_->sound(H5Dwrite(data, stored_type(type), memory, space, H5P_DEFAULT, bytes), dataset);
    });
}

void Hdf5Writer::close() {
    const Silence silence;
    if (!impl_->file.close()) {
        impl_->fail("cannot be written");
    }
}

// --- reading

struct Hdf5Reader::Impl {
    std::string name;
    std::uint64_t bytes; ///< size of the file
    Handle file;
    std::uint64_t consumed = 0; ///< bytes of the file that datasets were read from
};

namespace {

herr_t refuse_link(const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) {
    return -1;
}

/// Called for numbers that do not fit their new type.
H5T_conv_ret_t note_range(H5T_conv_except_t kind, hid_t, hid_t, void*, void*, void* out_of_range) {
    if (kind == H5T_CONV_EXCEPT_RANGE_HI || kind == H5T_CONV_EXCEPT_RANGE_LOW) {
        *static_cast<bool*>(out_of_range) = true;
        return H5T_CONV_ABORT;
    }
    return H5T_CONV_UNHANDLED;
}

template<class T>
hid_t native_type() {
    if constexpr (std::is_same_v<T, double>) {
        return H5T_NATIVE_DOUBLE;
    } else if constexpr (std::is_same_v<T, Index>) {
        return H5T_NATIVE_UINT32;
    } else {
        return H5T_NATIVE_INT64;
    }
}

std::uint64_t size_of_file(const std::filesystem::path& path) {
    std::error_code failure;
    const bool is_file = std::filesystem::is_regular_file(path, failure);
    const std::uint64_t bytes = is_file ? std::filesystem::file_size(path, failure) : 0;
    if (failure || !is_file) {
        throw InputError(fmt::format("{}: cannot be read: {}", path.string(),
                                     failure ? failure.message() : "it is not a regular file"));
    }
    return bytes;
}

} // namespace

struct Hdf5Dataset::Impl {
    Hdf5Reader::Impl& file;
    std::string name;
    Handle data;
    std::vector<std::uint64_t> extents{};
    std::uint64_t count = 1; ///< number of values
    bool reals = false;
    bool chunked = false;

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: dataset {}: {}", file.name, readable(name), what));
    }
    void require(bool condition, const char* what) const {
        if (!condition) {
            fail(what);
        }
    }

    void find_extents() {
        const Handle space{H5Dget_space(data), H5Sclose};
        const int rank = H5Sget_simple_extent_ndims(space);
        require(rank >= 0 && rank <= H5S_MAX_RANK, "its extents are damaged");
        std::array<hsize_t, H5S_MAX_RANK> sides{};
        H5Sget_simple_extent_dims(space, sides.data(), nullptr);
        extents.assign(sides.begin(), sides.begin() + rank);
        for (const std::uint64_t extent : extents) {
            require(extent == 0 || count <= std::numeric_limits<std::uint64_t>::max() / extent,
                    "its extents are too large");
            count *= extent;
        }
    }

    /// Checks the type; returns the bytes of a value in the file.
    std::uint64_t find_type() {
        const Handle type{H5Dget_type(data), H5Tclose};
        const H5T_class_t kind = H5Tget_class(type);
        require(kind == H5T_FLOAT || kind == H5T_INTEGER, "it holds neither integers nor reals");
        reals = kind == H5T_FLOAT;
        const std::size_t size = H5Tget_size(type);
        require(size > 0 && size <= sizeof(std::int64_t), "its numbers have more than 64 bits");
        return size;
    }

    /// Checks storage and filters; returns whether the values are packed.
    bool check_layout(const Handle& creation) const {
        const H5D_layout_t layout = H5Pget_layout(creation);
        require(layout == H5D_CONTIGUOUS || layout == H5D_CHUNKED || layout == H5D_COMPACT,
                "its data stand elsewhere");
        require(H5Pget_external_count(creation) == 0, "its data stand in other files");
        const int filters = H5Pget_nfilters(creation);
        require(filters >= 0, "its filters are damaged");
        bool packed = false;
        for (unsigned i = 0; i < static_cast<unsigned>(filters); ++i) {
            unsigned flags = 0;
            std::size_t values = 0;
            const H5Z_filter_t filter =
                H5Pget_filter2(creation, i, &flags, &values, nullptr, 0, nullptr, nullptr);
            require(filter == H5Z_FILTER_DEFLATE || filter == H5Z_FILTER_SHUFFLE ||
                        filter == H5Z_FILTER_FLETCHER32,
                    "it is packed otherwise than by deflate");
            require(!packed || filter != H5Z_FILTER_DEFLATE, "it is packed twice");
            packed = packed || filter == H5Z_FILTER_DEFLATE;
        }
        return packed;
    }

    /// Checks the size of chunks, as each is held in memory whole.
    void check_chunk(const Handle& creation, std::uint64_t value_bytes, std::uint64_t most) {
        chunked = H5Pget_layout(creation) == H5D_CHUNKED;
        if (!chunked) {
            return;
        }
        std::array<hsize_t, H5S_MAX_RANK> sides{};
        const int rank = H5Pget_chunk(creation, H5S_MAX_RANK, sides.data());
        require(rank > 0 && rank <= H5S_MAX_RANK, "its chunks are damaged");
        constexpr std::uint64_t harmless = std::uint64_t{16} << 20;
        std::uint64_t left = std::max(harmless, most) / value_bytes;
        for (int i = 0; i < rank; ++i) {
            const hsize_t side = std::max<hsize_t>(1, sides[static_cast<std::size_t>(i)]);
            left /= side;
        }
        require(left > 0, "its chunks are larger than the file allows");
    }

    void check_storage() {
        const std::uint64_t value_bytes = find_type();
        const Handle creation{H5Dget_create_plist(data), H5Pclose};
        const bool packed = check_layout(creation);
        const std::uint64_t stored = H5Dget_storage_size(data);
        require(stored <= file.bytes - file.consumed,
                "its data reach beyond the end of the file or were read");
        file.consumed += stored;
        const std::uint64_t most = packed ? most_unpacked(Compressor::zlib, stored) : stored;
        if (count > most / value_bytes) {
            fail(fmt::format("its {} bytes claim to hold {} values of {}", stored, count, value_bytes));
        }
        check_chunk(creation, value_bytes, most_unpacked(Compressor::zlib, file.bytes));
    }

    template<class T>
    void read(T* out, std::size_t rows, std::size_t used, std::size_t width) const {
        if (count != static_cast<std::uint64_t>(rows) * used) {
            fail(fmt::format("{} values are no {} rows of {}", count, rows, used));
        }
        if (count == 0) {
            return;
        }
        const auto transfer = [&] { transfer_to(out, rows, used, width); };
        if (chunked) { // HDF5 must decode chunks, unlike plain bytes
            rehearse(fmt::format("{}: dataset {}", file.name, name), 2 * count * sizeof(T) + file.bytes,
                     transfer);
        }
        transfer();
    }

    template<class T>
    void transfer_to(T* out, std::size_t rows, std::size_t used, std::size_t width) const {
        const Silence silence;
        const std::array<hsize_t, 2> all{rows, width};
        const std::array<hsize_t, 2> set{rows, used};
        const std::array<hsize_t, 2> begin{0, 0};
        const Handle memory{H5Screate_simple(2, all.data(), nullptr), H5Sclose};
        if (used != width) {
            H5Sselect_hyperslab(memory, H5S_SELECT_SET, begin.data(), nullptr, set.data(), nullptr);
        }
        bool out_of_range = false;
        const Handle settings{H5Pcreate(H5P_DATASET_XFER), H5Pclose};
        H5Pset_type_conv_cb(settings, note_range, &out_of_range);
        if (H5Dread(data, native_type<T>(), memory, H5S_ALL, settings, out) < 0) {
            fail(out_of_range ? std::string{"it has a number that is negative or too large"}
                              : fmt::format("it cannot be read: {}", cause()));
        }
    }
};

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) {
    FilesRead::note(path);
    const std::uint64_t bytes = size_of_file(path);
    const auto open = [&] {
        const Silence silence;
        impl_.reset(
            new Impl{path.string(), bytes, {H5Fopen(path.c_str(), H5F_ACC_RDONLY, file_access()), H5Fclose}});
        if (impl_->file < 0) {
            throw InputError(fmt::format("{}: it cannot be read as HDF5: {}", impl_->name, cause()));
        }
    };
    rehearse(path.string(), bytes, open);
    open();
}
Hdf5Reader::~Hdf5Reader() = default;
Hdf5Reader::Hdf5Reader(Hdf5Reader&&) noexcept = default;

Hdf5Dataset Hdf5Reader::open(const std::string& dataset) {
    std::unique_ptr<Hdf5Dataset::Impl> opened;
    const auto open = [&] {
        const Silence silence;
        const Handle access{H5Pcreate(H5P_DATASET_ACCESS), H5Pclose};
        H5Pset_elink_cb(access, refuse_link, nullptr);
        opened.reset(new Hdf5Dataset::Impl{
            *impl_, dataset, {H5Dopen2(impl_->file, dataset.c_str(), access), H5Dclose}});
        if (opened->data < 0) {
            opened->fail(fmt::format("it cannot be opened: {}", cause()));
        }
        opened->find_extents();
        opened->check_storage();
    };
    rehearse(fmt::format("{}: dataset {}", impl_->name, dataset), impl_->bytes, open);
    open();
    return Hdf5Dataset{std::move(opened)};
}

Hdf5Dataset::Hdf5Dataset(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Hdf5Dataset::~Hdf5Dataset() = default;
Hdf5Dataset::Hdf5Dataset(Hdf5Dataset&&) noexcept = default;

const std::vector<std::uint64_t>& Hdf5Dataset::extents() const {
    return impl_->extents;
}
bool Hdf5Dataset::has_reals() const {
    return impl_->reals;
}
void Hdf5Dataset::read(double* out, std::size_t rows, std::size_t used, std::size_t width) const {
    impl_->read(out, rows, used, width);
}
void Hdf5Dataset::read(std::int64_t* out, std::size_t rows, std::size_t used, std::size_t width) const {
    impl_->read(out, rows, used, width);
}
void Hdf5Dataset::read(Index* out, std::size_t rows, std::size_t used, std::size_t width) const {
    impl_->read(out, rows, used, width);
}

} // namespace slabhull::io
