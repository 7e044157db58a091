// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_formats.h"

#include "slabhull/core/error.h"

#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slabhull::tools {

namespace {

/// The names of the formats that can be read, or written.
template<class Able>
std::string names_of(const Able& able) {
    std::string names;
    for (const io::Format& format : io::formats()) {
        if (able(format)) {
            names += (names.empty() ? "" : ", ") + std::string{format.name};
        }
    }
    return names;
}

template<class Able>
const io::Format& choose(const std::string& file, const std::string& name, const char* option,
                         const char* done, const Able& able) {
    const io::Format* format = name.empty() ? io::format_of_extension(file) : io::format_named(name);
    if (format == nullptr) {
        throw UsageError{
            name.empty() ? fmt::format("{}: no format has this extension; give {} one of {}", file, option,
                                       names_of(able))
                         : fmt::format("{}: expected one of {}, not \"{}\"", option, names_of(able), name)};
    }
    if (!able(*format)) {
        throw UsageError{fmt::format("{}: {} is not {}; {} are", file, format->title, done, names_of(able))};
    }
    return *format;
}

} // namespace

const io::Format& format_to_read(const std::string& file, const std::string& name) {
    return choose(file, name, "--from", "read",
                  [](const io::Format& format) { return format.read != nullptr; });
}

const io::Format& format_to_write(const std::string& file, const std::string& name) {
    return choose(file, name, "--to", "written, or only with --pieces",
                  [](const io::Format& format) { return format.write != nullptr; });
}

const io::Format& format_to_write_in_pieces(const std::string& file, const std::string& name) {
    return choose(file, name, "--to", "written in pieces",
                  [](const io::Format& format) { return format.write_pieces != nullptr; });
}

std::string formats_help() {
    std::string text = "Formats:\n";
    for (const io::Format& format : io::formats()) {
        const char* written = format.write != nullptr          ? "written"
                              : format.write_pieces != nullptr ? "written with --pieces"
                                                               : "";
        text += fmt::format("  {:<8} {} ({}{}{})\n", format.name, fmt::join(format.extensions, " "),
                            format.read != nullptr ? "read" : "",
                            format.read != nullptr && *written != '\0' ? ", " : "", written);
    }
    return text;
}

const char* simplices_called(int dimension) {
    constexpr std::array<const char*, 4> names{"vertices", "lines", "triangles", "tetrahedra"};
    return names.at(static_cast<std::size_t>(dimension));
}

} // namespace slabhull::tools
