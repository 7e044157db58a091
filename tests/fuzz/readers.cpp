// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/readers.h"

#include "fuzz/harness.h"
#include "fuzz/soup_faults.h"
#include "slabhull/io/files.h"
#include "slabhull/io/formats.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace fuzz {

using namespace slabhull;

const InputFolder& folder() {
    static const InputFolder one;
    return one;
}

void require(const std::string& fault, const std::string& when) {
    if (!fault.empty()) {
        throw std::logic_error{when + ": " + fault};
    }
}

/// What is packed may unpack to 1032 times as much, of values that then take eight bytes for one.
void require_bounded(const MemoryMeter& meter, std::string_view bytes) {
    constexpr std::size_t fixed = std::size_t{4} << 20;
    const bool packed = bytes.find("vtkZLib") != bytes.npos || bytes.find("vtkLZ4") != bytes.npos;
    const std::size_t most = fixed + (packed ? 10000 : 100) * bytes.size();
    if (meter.peak() > most) {
        throw std::logic_error{
            fmt::format("reading {} bytes took {} bytes of memory", bytes.size(), meter.peak())};
    }
}

void require_message(const Error& error, const std::filesystem::path& path) {
    const std::string_view message{error.what()};
    require(message.starts_with(path.parent_path().string()) ? "" : "the file is not named", "message");
    const bool printable =
        std::none_of(message.begin(), message.end(), [](unsigned char c) { return std::iscntrl(c) != 0; });
    require(printable && message.size() < 2000 ? "" : "it is too long or not fit for a terminal", "message");
}

namespace {

// --- round trips ---

bool can_hold(const io::Format& format, const io::Soup& soup) {
    const int dimension = soup.top_dimension();
    return dimension >= format.features.min_dimension && dimension <= format.features.max_dimension;
}

/// Writers refuse what the format cannot hold, by an Error; true if it is written.
bool write(const io::Format& format, const std::filesystem::path& path, const io::Soup& soup) {
    try {
        io::AtomicFiles files;
        format.write(files, path, io::columns_of(soup), {});
        files.commit();
        return true;
    } catch (const InputError&) {
        throw;
    } catch (const Error&) {
        return false;
    }
}

void write_and_read_again(const io::Format& format, const io::Soup& soup) {
    const std::filesystem::path path = folder() / fmt::format("again{}", format.extensions.front());
    if (!can_hold(format, soup) || !write(format, path, soup)) {
        return;
    }
    try {
        const io::Soup again = format.read(path);
        require(fault_of(again), "read again");
        if (format.name != "stl") { // which is in single precision, and welded
            const auto& groups = soup.simplices[static_cast<std::size_t>(soup.top_dimension())].physical;
            const bool all_grouped =
                !groups.empty() && std::find(groups.begin(), groups.end(), 0) == groups.end();
            const bool exact = format.features.wide_integers;
            require(difference(soup, again,
                               {.groups = format.features.groups && all_grouped,
                                .point_data = format.features.point_data && exact,
                                .cell_data = format.features.cell_data && exact,
                                .field_data = format.features.field_data && exact}),
                    "read again");
        }
    } catch (const InputError& error) {
        throw std::logic_error{std::string{"what we write is refused: "} + error.what()};
    }
}

// --- readers ---

/// What is refused is perhaps curved, and read by its corners.
Outcome read_mesh(const io::Format& format, const std::filesystem::path& path, std::string_view bytes) {
    const auto read = [&format](bool linear) {
        return [&format, linear](const std::filesystem::path& file) {
            return format.read(file, {.linear = linear, .patch_array = {}});
        };
    };
    auto soup = read_or_refuse<InputError>(read(false), path, bytes);
    if (!soup) {
        soup = read_or_refuse<InputError>(read(true), path, bytes);
        if (!soup) {
            return Outcome::refused;
        }
    }
    require(fault_of(*soup), "soup");
    write_and_read_again(format, *soup);
    return Outcome::read;
}

template<std::size_t n>
struct Name {
    char text[n]{};
    constexpr Name(const char (&name)[n]) { std::copy_n(name, n, text); }
};

template<Name name>
Outcome read_format(std::string_view bytes) {
    static const io::Format& format = *io::format_named(name.text);
    static const std::string file = fmt::format("a{}", format.extensions.front());
    return read_mesh(format, folder().put(file, bytes), bytes);
}

/// Files of one stem behind each other, each after a line such as "%% .node". The path of the first, empty
/// where there is none.
std::filesystem::path put_files(std::string_view bytes, std::span<const char* const> extensions) {
    constexpr std::string_view mark = "%% ";
    for (const char* extension : extensions) {
        folder().remove(std::string{"a"} + extension);
    }
    std::filesystem::path first;
    std::string_view rest = bytes;
    while (rest.starts_with(mark)) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string extension{rest.substr(mark.size(), end - mark.size())};
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const std::size_t next = std::min(rest.find(mark), rest.size());
        if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
            const auto path = folder().put("a" + extension, rest.substr(0, next));
            first = first.empty() ? path : first;
        }
        rest.remove_prefix(next);
    }
    return first;
}

/// The first of the files is read.
Outcome read_tetgen(std::string_view bytes) {
    constexpr std::array extensions{".node", ".ele", ".neigh", ".face", ".poly", ".smesh"};
    const std::filesystem::path first = put_files(bytes, extensions);
    return read_mesh(*io::format_named("tetgen"), first.empty() ? folder().put("a.node", bytes) : first,
                     bytes);
}

/// A .pvtu and its pieces.
Outcome read_pieces(std::string_view bytes) {
    constexpr std::array extensions{".pvtu", "_0.vtu", "_1.vtu"};
    const std::filesystem::path first = put_files(bytes, extensions);
    const auto whole = first.extension() == ".pvtu" ? first : folder().put("a.pvtu", bytes);
    const auto soup = read_or_refuse<InputError>(io::read_pvtu, whole, bytes);
    require(soup ? fault_of(*soup) : "", "pieces");
    return soup ? Outcome::read : Outcome::refused;
}

/// Space-time meshes of MFEM; HDF5's are left out, as below.
Outcome read_filling(std::string_view bytes) {
    if (bytes.find("HDF") != bytes.npos) {
        return Outcome::refused;
    }
    const auto soup = read_or_refuse<InputError>(io::read_space_time, folder().put("a.mfem", bytes), bytes);
    require(soup ? fault_of(*soup) : "", "filling");
    return soup ? Outcome::read : Outcome::refused;
}

/// With its values as text: HDF5's are tried in processes of their own (tests/io/xdmf.cpp damages them).
Outcome read_xdmf(std::string_view bytes) {
    if (bytes.find("HDF") != bytes.npos) {
        return Outcome::refused;
    }
    const auto soup = read_or_refuse<InputError>(io::read_xdmf, folder().put("a.xdmf", bytes), bytes);
    require(soup ? fault_of(*soup) : "", "xdmf");
    return soup ? Outcome::read : Outcome::refused;
}

Outcome read_curve(std::string_view bytes) {
    const auto soup = read_or_refuse<InputError>(io::read_curve, folder().put("a.dat", bytes), bytes);
    require(soup ? fault_of(*soup) : "", "curve");
    return soup ? Outcome::read : Outcome::refused;
}

Outcome read_table(std::string_view bytes) {
    const auto table = read_or_refuse<InputError>(io::read_motion_table, folder().put("a.csv", bytes), bytes);
    require(table ? fault_of(*table) : "", "table");
    return table ? Outcome::read : Outcome::refused;
}

constexpr std::array all{
    Reader{"msh", read_format<"msh">},
    Reader{"vtu", read_format<"vtu">},
    Reader{"pvtu", read_pieces},
    Reader{"vtk", read_format<"vtk">},
    Reader{"xdmf", read_xdmf},
    Reader{"tetgen", read_tetgen},
    Reader{"medit", read_format<"medit">},
    Reader{"mfem", read_format<"mfem">},
    Reader{"avro", read_format<"avro">},
    Reader{"stl", read_format<"stl">},
    Reader{"off", read_format<"off">},
    Reader{"obj", read_format<"obj">},
    Reader{"ply", read_format<"ply">},
    Reader{"curve", read_curve},
    Reader{"filling", read_filling},
    Reader{"csv", read_table},
    Reader{"case", read_case_file},
};

} // namespace

std::span<const Reader> readers() {
    static const std::vector<Reader> built = [] {
        std::vector<Reader> some;
        std::copy_if(all.begin(), all.end(), std::back_inserter(some), [](const Reader& reader) {
            const io::Format* format = io::format_named(reader.name);
            return format == nullptr || format->built;
        });
        return some;
    }();
    return built;
}

const Reader* reader_named(std::string_view name) {
    const auto found = std::find_if(readers().begin(), readers().end(),
                                    [&](const Reader& reader) { return reader.name == name; });
    return found == readers().end() ? nullptr : &*found;
}

} // namespace fuzz
