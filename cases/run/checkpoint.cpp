// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/checkpoint.h"

#include "slabhull/cases/hull_files.h"
#include "slabhull/core/error.h"
#include "slabhull/io/atomic_file.h"
#include "slabhull/io/checksum.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <sstream>
#include <type_traits>

namespace slabhull {

namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are written as they lie in memory");

constexpr std::string_view magic = "slabhull march 3\n";

class Packer {
public:
    template<class T>
    void number(T value) {
        static_assert(std::is_arithmetic_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template<class List>
    void list(const List& values) {
        static_assert(std::is_trivially_copyable_v<typename List::value_type>);
        number(std::uint64_t{values.size()});
        bytes_.append(reinterpret_cast<const char*>(values.data()),
                      values.size() * sizeof(typename List::value_type));
    }
    void raw(std::string_view text) { bytes_.append(text); }

    /// Everything, followed by its checksum.
    std::string sealed() && {
        io::Checksum sum;
        sum.add(bytes_.data(), bytes_.size());
        number(sum.value());
        return std::move(bytes_);
    }

private:
    std::string bytes_;
};

/// Reads what a Packer packed. A right checksum does not prove who wrote the file, so every count is still
/// compared with the bytes that are left.
class Unpacker {
public:
    explicit Unpacker(const std::filesystem::path& path) : path_{path} {
        std::ifstream file{path, std::ios::binary};
        if (!file) {
            throw InputError(fmt::format("{}: cannot be read", path_.string()));
        }
        std::ostringstream all;
        all << file.rdbuf();
        bytes_ = std::move(all).str();
        require_seal();
    }

    template<class T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof value), sizeof value);
        return value;
    }
    template<class List>
    List list() {
        const auto count = number<std::uint64_t>();
        constexpr std::size_t size = sizeof(typename List::value_type);
        if (count > (bytes_.size() - at_) / size) {
            fail("is damaged: a list in it is longer than the file");
        }
        List values;
        values.resize(static_cast<std::size_t>(count));
        if (count > 0) {
            std::memcpy(values.data(), take(values.size() * size), values.size() * size);
        }
        return values;
    }
    [[noreturn]] void fail(const char* what) const {
        throw InputError(fmt::format("{}: {}; start the run anew, without --resume", path_.string(), what));
    }

private:
    void require_seal() {
        if (bytes_.size() < magic.size() + sizeof(std::uint32_t) || !bytes_.starts_with(magic)) {
            fail("is no checkpoint of this version of Slabhull, or is cut short");
        }
        const std::size_t end = bytes_.size() - sizeof(std::uint32_t);
        std::uint32_t written;
        std::memcpy(&written, bytes_.data() + end, sizeof written);
        io::Checksum sum;
        sum.add(bytes_.data(), end);
        if (sum.value() != written) {
            fail("is damaged: its checksum is wrong");
        }
        bytes_.resize(end);
        at_ = magic.size();
    }

    const char* take(std::size_t size) {
        if (size > bytes_.size() - at_) {
            fail("is damaged: it ends too early");
        }
        at_ += size;
        return bytes_.data() + (at_ - size);
    }

    std::filesystem::path path_;
    std::string bytes_;
    std::size_t at_ = 0;
};

void pack_patches(Packer& out, const PatchList& patches) {
    out.number(std::uint64_t{patches.size()});
    for (const Patch& patch : patches) {
        out.number(patch.number);
        out.list(patch.name);
    }
}

PatchList unpack_patches(Unpacker& in) {
    PatchList patches;
    for (auto left = in.number<std::uint64_t>(); left > 0; --left) {
        const auto number = in.number<PatchNumber>();
        patches.push_back({number, in.list<std::string>()});
    }
    return patches;
}

/// The boundary that the march's caps have, at its start; their vertices begin with its.
template<int D>
std::optional<Boundary<D>> boundary_of_caps(const SpatialMesh<D>& cap, Array<Point<D>> start,
                                            Array<double> spacing) {
    const auto known = [&](const Facet<D>& facet) {
        return std::all_of(facet.begin(), facet.end(), [&](Index v) { return v < start.size(); });
    };
    if (cap.boundary_patch.size() != cap.boundary_facets.size() || start.size() > cap.points.size() ||
        (!spacing.empty() && spacing.size() != start.size()) ||
        !std::all_of(cap.boundary_facets.begin(), cap.boundary_facets.end(), known)) {
        return std::nullopt;
    }
    Array<TrackId> tracks(cap.track_ids.begin(),
                          cap.track_ids.begin() + static_cast<std::ptrdiff_t>(start.size()));
    try {
        return Boundary<D>{{std::move(start), cap.boundary_facets, cap.boundary_patch, cap.patches},
                           std::move(tracks),
                           std::move(spacing)}
            .bounding(cap.vertex_ids);
    } catch (const GeometryError&) {
        return std::nullopt;
    }
}

} // namespace

template<int D>
void write_checkpoint(const std::filesystem::path& path, const MarchState<D>& state,
                      const CheckpointFiles& files) {
    Packer out;
    out.raw(magic);
    out.number(std::int32_t{D});
    out.number(std::int32_t{state.slab});
    out.number(state.time);
    out.number(state.ids.next);
    out.list(files.cap);
    out.number(files.cap_checksum);
    out.number(files.journal_size);
    out.number(files.journal_checksum);
    out.number(files.case_checksum);
    pack_patches(out, state.cap.patches);
    out.list(state.cap.boundary_facets);
    out.list(state.cap.boundary_patch);
    out.list(state.boundary.start());
    out.list(state.boundary.spacing());
    io::AtomicFile file{path};
    file.write(std::move(out).sealed());
    file.commit();
}

template<int D>
Checkpoint<D> read_checkpoint(const std::filesystem::path& path) {
    Unpacker in{path};
    if (in.number<std::int32_t>() != D) {
        in.fail("is of a march in another dimension");
    }
    Checkpoint<D> read;
    read.state.slab = in.number<std::int32_t>();
    read.state.time = in.number<double>();
    read.state.ids.next = in.number<PersistentId>();
    read.files.cap = in.list<std::string>();
    read.files.cap_checksum = in.number<std::uint32_t>();
    read.files.journal_size = in.number<std::uint64_t>();
    read.files.journal_checksum = in.number<std::uint32_t>();
    read.files.case_checksum = in.number<std::uint32_t>();
    const auto cap = path.parent_path() / read.files.cap;
    if (io::checksum_of(cap) != read.files.cap_checksum) {
        throw InputError(
            fmt::format("{}: is damaged, or not the cap that {} belongs to: its checksum is wrong",
                        cap.string(), path.string()));
    }
    read.state.cap = read_cap<D>(cap);
    read.state.cap.patches = unpack_patches(in);
    read.state.cap.boundary_facets = in.list<Array<Facet<D>>>();
    read.state.cap.boundary_patch = in.list<std::vector<PatchNumber>>();
    auto start = in.list<Array<Point<D>>>();
    auto boundary = boundary_of_caps<D>(read.state.cap, std::move(start), in.list<Array<double>>());
    if (!boundary) {
        in.fail("does not fit its cap");
    }
    read.state.boundary = *std::move(boundary);
    return read;
}

template void write_checkpoint<2>(const std::filesystem::path&, const MarchState<2>&, const CheckpointFiles&);
template void write_checkpoint<3>(const std::filesystem::path&, const MarchState<3>&, const CheckpointFiles&);
template Checkpoint<2> read_checkpoint<2>(const std::filesystem::path&);
template Checkpoint<3> read_checkpoint<3>(const std::filesystem::path&);

} // namespace slabhull
