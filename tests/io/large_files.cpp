// SPDX-License-Identifier: BSD-3-Clause
// Memory of writers and readers, measured in child processes, and files beyond 4 GiB and 2^31 entries, of
// which only what matters is stored: files with holes, and a write() that counts.
#include "io/scratch.h"
#include "io/vtk/vtu_payload.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <cstdint>
#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace slabhull;

// --- a disk without end ---

namespace disk {

/// While there is one, write() keeps only the bytes of these places of the file; it counts all.
struct Counting {
    std::map<std::uint64_t, std::string> kept; ///< by place; as many as the string has room for
    std::uint64_t size = 0;
};
Counting* counting = nullptr;

void count(const char* bytes, std::size_t size) {
    for (auto& [place, text] : counting->kept) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (place + i >= counting->size && place + i < counting->size + size) {
                text[i] = bytes[place + i - counting->size];
            }
        }
    }
    counting->size += size;
}

template<class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

} // namespace disk

/// Takes the C library's place in this program.
extern "C" ssize_t write(int descriptor, const void* bytes, size_t size) {
    if (disk::counting == nullptr || descriptor <= 2) {
        static auto* const real = disk::real<ssize_t(int, const void*, size_t)>("write");
        return real(descriptor, bytes, size);
    }
    disk::count(static_cast<const char*>(bytes), size);
    return static_cast<ssize_t>(size);
}

namespace {

// --- memory ---

constexpr std::size_t mebibyte = std::size_t{1} << 20;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool memory_counts = false; // the sanitizer keeps what is freed
#else
constexpr bool memory_counts = true;
#endif

/// The most memory of a child process that does the job and is content with what it finds.
std::size_t peak_of(const std::function<bool()>& job) {
    const pid_t child = ::fork();
    if (child == 0) {
        bool content = false;
        try {
            content = job();
        } catch (const std::exception& problem) {
            fmt::print(stderr, "{}\n", problem.what());
        }
        ::_exit(content ? 0 : 1);
    }
    int status = 0;
    rusage usage{};
    ::wait4(child, &status, 0, &usage);
    REQUIRE(status == 0);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

/// That beyond what the child has from us.
std::size_t extra_of(const std::function<bool()>& job) {
    const std::size_t before = peak_of([] { return true; });
    const std::size_t peak = peak_of(job);
    return peak - std::min(peak, before);
}

// --- a mesh that is computed ---

constexpr std::size_t point_count = 800'000;
constexpr std::size_t cell_count = 4'000'000;

double coordinate(std::size_t point, std::size_t axis) {
    return static_cast<double>(point * 7919 % 1000003 + axis) / 1009;
}
std::int64_t corner(std::size_t cell, std::size_t k) {
    return static_cast<std::int64_t>((cell * 31 + k * 7) % point_count);
}
std::int64_t neighbor(std::size_t cell, std::size_t k) {
    return static_cast<std::int64_t>(cell * 13 + k) - 5;
}

template<class T, class Value>
Column<T> computed(std::size_t rows, std::size_t components, const Value& value) {
    return {rows, static_cast<int>(components), [=](std::size_t begin, std::size_t end, T* out) {
                for (std::size_t row = begin; row < end; ++row) {
                    for (std::size_t k = 0; k < components; ++k) {
                        *out++ = value(row, k);
                    }
                }
            }};
}

io::MeshColumns computed_mesh() {
    io::MeshColumns mesh;
    mesh.points = computed<double>(point_count, 3, coordinate);
    mesh.cells = computed<std::int64_t>(cell_count, 4, corner);
    mesh.point_data = {{"t", io::Scalar::float64, computed<double>(point_count, 1, coordinate)}};
    mesh.cell_data = {{"neighbors", io::Scalar::int64, computed<std::int64_t>(cell_count, 4, neighbor)}};
    mesh.groups = {{0, cell_count / 3, 1, "a"}, {cell_count / 3, cell_count, 2, "b"}};
    return mesh;
}

template<class T>
std::size_t bytes_of(const T& values) {
    return values.size() * sizeof(values[0]);
}

/// All of them fit into 32 bits.
std::size_t bytes_of(const IntegerList& list) {
    return list.narrow().size_bytes();
}

std::size_t bytes_of(const io::Soup& soup) {
    std::size_t bytes = bytes_of(soup.points) + bytes_of(soup.point_tags);
    for (const io::SimplexBlock& block : soup.simplices) {
        bytes += bytes_of(block.vertices) + bytes_of(block.physical) + bytes_of(block.entity) +
                 bytes_of(block.tags);
    }
    for (const auto* arrays : {&soup.point_data, &soup.cell_data}) {
        for (const io::DataArray& array : *arrays) {
            std::visit([&](const auto& values) { bytes += bytes_of(values); }, array.values);
        }
    }
    return bytes;
}

/// Every value of the computed mesh, so that nothing is lost where one portion of a file ends.
bool is_computed_mesh(const io::Soup& soup) {
    bool same = soup.points.size() == point_count && soup.simplices[3].vertices.size() == 4 * cell_count;
    for (std::size_t i = 0; same && i < 3 * point_count; ++i) {
        same = soup.points[i / 3][i % 3] == coordinate(i / 3, i % 3);
    }
    for (std::size_t i = 0; same && i < 4 * cell_count; ++i) {
        same = soup.simplices[3].vertices[i] == corner(i / 4, i % 4);
    }
    return same;
}

bool has_value(const io::DataArray* array, std::size_t i, std::int64_t value) {
    return array != nullptr &&
           std::visit(
               [&](const auto& values) {
                   if constexpr (std::is_arithmetic_v<std::decay_t<decltype(values[0])>>) {
                       return static_cast<std::int64_t>(values[i]) == value;
                   }
                   return false;
               },
               array->values);
}

bool has_neighbors(const io::Soup& soup) {
    const io::DataArray* together = soup.find_cell_data("neighbors");
    bool same = true;
    for (std::size_t i = 0; same && i < 4 * cell_count; ++i) {
        same = together != nullptr ? has_value(together, i, neighbor(i / 4, i % 4))
                                   : has_value(soup.find_cell_data(fmt::format("neighbors_{}", i % 4)), i / 4,
                                               neighbor(i / 4, i % 4));
    }
    return same;
}

using Write = std::function<void(const std::filesystem::path&, const io::MeshColumns&)>;

Write vtu_writer(io::VtuEncoding encoding) {
    return [=](const auto& path, const auto& mesh) { io::write_vtu(path, mesh, encoding); };
}

/// Writes and reads the mesh, each in a child, and checks what they take beside the mesh itself.
void check_memory(const Write& write, io::Soup (*read)(const std::filesystem::path&)) {
    const scratch::Folder folder;
    const auto path = folder / "mesh";
    const std::size_t to_write = extra_of([&] {
        write(path, computed_mesh());
        return true;
    });
    std::size_t arrays = 0;
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    const std::size_t to_read = extra_of([&] {
        const io::Soup soup = read(path);
        const std::size_t bytes = bytes_of(soup);
        return ::write(ends[1], &bytes, sizeof bytes) == sizeof bytes && is_computed_mesh(soup) &&
               has_neighbors(soup);
    });
    REQUIRE(::read(ends[0], &arrays, sizeof arrays) == sizeof arrays);
    ::close(ends[0]);
    ::close(ends[1]);
    INFO("MiB to write: " << to_write / mebibyte << ", to read: " << to_read / mebibyte
                          << ", of the arrays: " << arrays / mebibyte);
    CHECK(arrays > 2 * 64 * mebibyte);
    CHECK(to_read > arrays * 3 / 4); // or we measure something else
    if (memory_counts) {
        CHECK(to_write < 64 * mebibyte);
        CHECK(to_read < arrays + 64 * mebibyte);
    }
}

} // namespace

TEST_CASE("Memory that a child takes is seen", "[io]") {
    CHECK(extra_of([] {
              Array<char> bytes;
              bytes.assign(100 * mebibyte, 1);
              return bytes[bytes.size() / 2] == 1;
          }) >= 100 * mebibyte);
    CHECK(extra_of([] { return true; }) < 4 * mebibyte);
}

TEST_CASE("MSH is written and read in less than 64 MiB beside the mesh", "[io][long]") {
    check_memory([](const auto& path, const auto& mesh) { io::write_msh(path, mesh); }, io::read_msh);
}

TEST_CASE("Raw VTU is written and read in less than 64 MiB beside the mesh", "[io][long]") {
    check_memory(vtu_writer(io::VtuEncoding::raw), io::read_vtu);
}

TEST_CASE("Packed VTU and VTU as text are written and read in less than 64 MiB beside the mesh", "[.large]") {
    const auto encoding = GENERATE(io::VtuEncoding::zlib, io::VtuEncoding::lz4, io::VtuEncoding::ascii);
    INFO("encoding " << static_cast<int>(encoding));
    check_memory(vtu_writer(encoding), io::read_vtu);
}

TEST_CASE("Pieces are written in less than 64 MiB", "[io]") {
    const scratch::Folder folder;
    const std::size_t extra = extra_of([&] {
        io::AtomicFiles files;
        io::write_pvtu(files, folder / "mesh.pvtu", computed_mesh(), 3);
        files.commit();
        return true;
    });
    INFO("MiB: " << extra / mebibyte);
    CHECK((!memory_counts || extra < 64 * mebibyte));
}

namespace {

// --- beyond 4 GiB and 2^31 entries ---

constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30;

/// A file of text, a hole up to `offset`, and more bytes.
class FileWithHole {
public:
    explicit FileWithHole(const std::filesystem::path& path)
        : descriptor_{::open(path.c_str(), O_WRONLY | O_CREAT, 0600)} {}
    ~FileWithHole() { ::close(descriptor_); }
    void put(std::uint64_t offset, const std::string& bytes) {
        REQUIRE(::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset)) ==
                static_cast<ssize_t>(bytes.size()));
    }
    std::uint64_t size() const {
        struct stat status {};
        ::fstat(descriptor_, &status);
        return static_cast<std::uint64_t>(status.st_size);
    }
    std::uint64_t stored() const {
        struct stat status {};
        ::fstat(descriptor_, &status);
        return static_cast<std::uint64_t>(status.st_blocks) * 512;
    }

private:
    int descriptor_;
};

template<class T>
std::string appended(const std::vector<T>& values) {
    std::string bytes = scratch::binary(std::uint64_t{values.size() * sizeof(T)});
    for (const T value : values) {
        bytes += scratch::binary(value);
    }
    return bytes;
}

std::string array_at(const char* type, const char* name, int components, std::uint64_t offset) {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
                       "offset=\"{}\"/>",
                       type, name, components, offset);
}

/// All that has zeros in [0, 0xFF..] stays a hole: corners are the point 0.
io::MeshColumns endless_mesh(std::size_t points, std::size_t cells) {
    io::MeshColumns mesh;
    mesh.points = Column<double>{points, 3, [](std::size_t begin, std::size_t end, double* out) {
                                     std::fill(out, out + 3 * (end - begin), 0.5);
                                 }};
    mesh.cells = Column<std::int64_t>{cells, 4, [](std::size_t begin, std::size_t end, std::int64_t* out) {
                                          std::fill(out, out + 4 * (end - begin), 3);
                                      }};
    return mesh;
}

/// The offset of an array in a VTU file's XML.
std::uint64_t offset_of(const std::string& xml, const std::string& name) {
    const std::size_t at = xml.find("offset=\"", xml.find("Name=\"" + name + "\""));
    REQUIRE(at != std::string::npos);
    return std::stoull(xml.substr(at + 8));
}

template<class T>
T value_in(const std::string& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

} // namespace

TEST_CASE("A VTU file with arrays behind 4 GiB is read", "[io]") {
    const scratch::Folder folder;
    const std::uint64_t far = 5 * gibibyte;
    const std::string head =
        "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\"><UnstructuredGrid>"
        "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><PointData>" +
        array_at("Int32", "n", 1, far) + "</PointData><Points>" + array_at("Float64", "p", 3, far + 1000) +
        "</Points><Cells>" + array_at("Int32", "connectivity", 1, 0) +
        array_at("Int64", "offsets", 1, far + 3000) + array_at("UInt8", "types", 1, far + 2000) +
        "</Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_";
    FileWithHole file{folder / "a.vtu"};
    file.put(0, head);
    file.put(head.size(), appended<std::int32_t>({3, 1, 2, 0}));
    file.put(head.size() + far, appended<std::int32_t>({5, 6, 7, 8}));
    file.put(head.size() + far + 1000, appended<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 9}));
    file.put(head.size() + far + 2000, appended<std::uint8_t>({10}));
    file.put(head.size() + far + 3000, appended<std::int64_t>({4}));
    REQUIRE(file.size() > far);
    REQUIRE(file.stored() < mebibyte);

    const io::Soup soup = io::read_vtu(folder / "a.vtu");
    CHECK(soup.simplices[3].vertices == Array<Index>{3, 1, 2, 0});
    CHECK(soup.points.at(3) == Point<3>{0, 0, 9});
    CHECK(std::get<IntegerList>(soup.point_data.at(0).values) == Array<std::int64_t>{5, 6, 7, 8});
}

TEST_CASE("An MSH file with its mesh behind 4 GiB is read", "[io]") {
    const scratch::Folder folder;
    const std::string mesh = scratch::bytes_of(scratch::fixture("cube_41_binary.msh"));
    const std::size_t nodes = mesh.find("$Nodes");
    REQUIRE(nodes != std::string::npos);
    const std::uint64_t hole = 4 * gibibyte + 4321;
    FileWithHole file{folder / "a.msh"};
    file.put(0, mesh.substr(0, nodes) + "$Unknown\n");
    file.put(nodes + hole, "\n$EndUnknown\n" + mesh.substr(nodes));
    REQUIRE(file.stored() < 16 * mebibyte);

    const io::Soup expected = io::read_msh(scratch::fixture("cube_41_binary.msh"));
    const io::Soup soup = io::read_msh(folder / "a.msh");
    CHECK(soup.points == expected.points);
    CHECK(soup.simplices[3].vertices == expected.simplices[3].vertices);
}

TEST_CASE("An array of more than 2^32 bytes and 2^31 entries comes whole", "[.large]") {
    const scratch::Folder folder;
    const std::uint64_t entries = (std::uint64_t{1} << 31) + 5;
    FileWithHole file{folder / "a"};
    file.put(0, scratch::binary(2 * entries));
    file.put(8 + 2 * (entries - 1), scratch::binary(std::uint16_t{77}));
    io::FileBytes bytes{folder / "a"};
    std::uint64_t announced = 0;
    std::uint64_t seen = 0;
    std::uint64_t sum = 0;
    const io::PayloadTaker taker{[&](std::uint64_t size) { announced = size; },
                                 [&](std::string_view portion) {
                                     seen += portion.size() / 2;
                                     std::uint16_t last = 0;
                                     std::memcpy(&last, portion.data() + portion.size() - 2, 2);
                                     sum += last;
                                 }};
    const std::size_t extra = extra_of([&] { // a child's, too, to see its memory
        io::read_payload({false, 8, io::Compressor::none}, bytes, {0, bytes.size()}, false, 0, taker);
        return seen == entries;
    });
    CHECK((!memory_counts || extra < 64 * mebibyte));
    CHECK(io::read_payload({false, 8, io::Compressor::none}, bytes, {0, bytes.size()}, false, 0, taker) ==
          8 + 2 * entries);
    CHECK(announced == 2 * entries);
    CHECK(seen == entries);
    CHECK(sum == 77);
}

TEST_CASE("A VTU file of more than 2^31 entries is written with the right offsets", "[.large]") {
    const std::size_t cells = (std::size_t{1} << 29) + 3; // four entries each
    const std::size_t points = 200'000'000;               // 4.8 GB
    const scratch::Folder folder;
    const io::MeshColumns mesh = endless_mesh(points, cells);
    disk::Counting count;
    count.kept[0].resize(4096);
    // What stands where follows from the format; 8 bytes in front of each array tell its size.
    const auto write = [&] {
        count.size = 0;
        disk::counting = &count;
        io::write_vtu(folder / "a.vtu", mesh);
        disk::counting = nullptr;
    };
    write();
    const std::string& xml = count.kept[0];
    const std::uint64_t data = xml.find("\n_") + 2;
    const std::uint64_t connectivity = 8 + 24 * std::uint64_t{points};
    CHECK(offset_of(xml, "connectivity") == connectivity);
    CHECK(offset_of(xml, "offsets") == connectivity + 8 + 16 * std::uint64_t{cells});
    CHECK(offset_of(xml, "types") == connectivity + 16 + 24 * std::uint64_t{cells});
    CHECK(xml.find("type=\"Int64\" Name=\"offsets\"") != std::string::npos);
    const std::uint64_t end = data + connectivity + 24 + 25 * std::uint64_t{cells};
    CHECK(count.size == end + std::string{"\n</AppendedData>\n</VTKFile>\n"}.size());

    const std::uint64_t offsets = data + offset_of(xml, "offsets");
    for (const std::uint64_t place : {offsets, offsets + 8 * cells, end - 1}) {
        count.kept[place].resize(8);
    }
    write();
    CHECK(value_in<std::uint64_t>(count.kept[offsets]) == 8 * cells);
    CHECK(value_in<std::int64_t>(count.kept[offsets + 8 * cells]) == static_cast<std::int64_t>(4 * cells));
    CHECK(count.kept[end - 1].front() == 10);
}

TEST_CASE("An MSH file of more than 4 GiB is written whole", "[.large]") {
    const std::size_t cells = 150'000'000; // 40 bytes each
    const scratch::Folder folder;
    disk::Counting count;
    const std::uint64_t tail = std::string{"\n$EndElements\n"}.size();
    const auto write = [&] {
        count.size = 0;
        disk::counting = &count;
        io::write_msh(folder / "a.msh", endless_mesh(10, cells));
        disk::counting = nullptr;
    };
    write();
    const std::uint64_t size = count.size;
    CHECK(size > 40 * cells);
    CHECK(size < 40 * cells + 2000);
    count.kept[size - tail - 40].resize(40 + tail);
    write();
    CHECK(count.size == size);
    const std::string& last = count.kept[size - tail - 40];
    CHECK(value_in<std::uint64_t>(last) == cells);
    CHECK(value_in<std::uint64_t>(last.substr(8)) == 4);
    CHECK(last.substr(40) == "\n$EndElements\n");
}

TEST_CASE("Data of more rows than MSH can count are refused before anything is written", "[io][long]") {
    const std::size_t rows = std::size_t{1} << 31;
    io::MeshColumns mesh = endless_mesh(rows, rows);
    mesh.cell_data = {{"many", io::Scalar::int32, Column<std::int64_t>::constant(rows, 1)}};
    const scratch::Folder folder;
    CHECK_THROWS_AS(io::write_msh(folder / "a.msh", mesh), FormatLimit);
    CHECK(folder.file_count() == 0);
}
