// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "file_cursor.h"

#include <fmt/format.h>
#include <fstream>

namespace slabhull::io {

namespace {

enum class MeshFormat { msh, vtu, unknown };

/// By the first bytes, for a file whose name does not tell.
MeshFormat sniff(const std::filesystem::path& path) {
    constexpr std::size_t shown = 4096;
    std::string start(shown, '\0');
    std::ifstream file{path, std::ios::binary};
    file.read(start.data(), static_cast<std::streamsize>(shown));
    start.resize(static_cast<std::size_t>(file.gcount()));
    if (start.starts_with("$MeshFormat") || start.starts_with("$Comments")) {
        return MeshFormat::msh;
    }
    return start.find("<VTKFile") != std::string::npos ? MeshFormat::vtu : MeshFormat::unknown;
}

MeshFormat format_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".msh") {
        return MeshFormat::msh;
    }
    return extension == ".vtu" ? MeshFormat::vtu : sniff(path);
}

} // namespace

Soup read_mesh(const std::filesystem::path& path) {
    switch (format_of(path)) {
    case MeshFormat::msh:
        return read_msh(path);
    case MeshFormat::vtu:
        return read_vtu(path);
    case MeshFormat::unknown:
        break;
    }
    read_bytes(path); // a file that cannot be read at all is reported as that
    throw InputError(
        fmt::format("{}: neither the name nor the content is that of an MSH or VTU file", path.string()));
}

} // namespace slabhull::io
