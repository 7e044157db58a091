// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/checksum.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>
#include <fstream>
#include <vector>
#include <zlib.h>

namespace slabhull::io {

void Checksum::add(const void* bytes, std::size_t size) {
    value_ = static_cast<std::uint32_t>(::crc32_z(value_, static_cast<const Bytef*>(bytes), size));
}

std::uint32_t checksum_of(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    Checksum sum;
    std::vector<char> block(1 << 20);
    while (file) {
        file.read(block.data(), static_cast<std::streamsize>(block.size()));
        sum.add(block.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (!file.eof()) {
        throw InputError(fmt::format("{}: cannot be read", path.string()));
    }
    return sum.value();
}

} // namespace slabhull::io
