// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_formats.h"

#include "slabhull/core/error.h"

#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slabhull::tools {

namespace {

std::string names_of_formats() {
    std::string names;
    for (const io::Format& format : io::formats()) {
        names += (names.empty() ? "" : ", ") + std::string{format.name};
    }
    return names;
}

const io::Format& choose(const std::string& file, const std::string& name, const char* option) {
    const io::Format* format = name.empty() ? io::format_of_extension(file) : io::format_named(name);
    if (format == nullptr) {
        throw UsageError{name.empty() ? fmt::format("{}: no format has this extension; give {} one of {}",
                                                    file, option, names_of_formats())
                                      : fmt::format("{}: expected one of {}, not \"{}\"", option,
                                                    names_of_formats(), name)};
    }
    io::require_built(*format);
    return *format;
}

} // namespace

const io::Format& format_to_read(const std::string& file, const std::string& name) {
    return choose(file, name, "--from");
}

const io::Format& format_to_write(const std::string& file, const std::string& name) {
    return choose(file, name, "--to");
}

io::Soup read_named(const std::string& file, const std::string& name) {
    io::Soup soup = name.empty() ? io::read_mesh(file) : io::read_as(format_to_read(file, name), file);
    print_remarks(soup);
    return soup;
}

void print_remarks(const io::Soup& soup) {
    for (const std::string& remark : soup.remarks) {
        fmt::print(stderr, "slabhull: {}\n", remark);
    }
}

std::string formats_help() {
    std::string text = "Formats, all of them read and written:\n";
    for (const io::Format& format : io::formats()) {
        text += fmt::format("  {:<8} {}\n", format.name, fmt::join(format.extensions, " "));
    }
    for (const io::Format& format : io::formats_left_out()) {
        text +=
            fmt::format("  {:<8} {} (not in this build)\n", format.name, fmt::join(format.extensions, " "));
    }
    return text;
}

const char* simplices_called(int dimension) {
    constexpr std::array<const char*, 4> names{"vertices", "lines", "triangles", "tetrahedra"};
    return names.at(static_cast<std::size_t>(dimension));
}

} // namespace slabhull::tools
