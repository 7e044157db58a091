// SPDX-License-Identifier: BSD-3-Clause
#include "python/write_options.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::python {

namespace {

const io::Format& known_format(const std::filesystem::path& path, const std::string& name) {
    const io::Format* format = name.empty() ? io::format_of_extension(path) : io::format_named(name);
    if (format == nullptr) {
        std::vector<std::string_view> known;
        for (const io::Format& each : io::formats()) {
            known.push_back(each.name);
        }
        throw UsageError{fmt::format("{}: no format {}; there are {}", path.string(),
                                     name.empty() ? "has this extension" : "is called \"" + name + "\"",
                                     fmt::join(known, ", "))};
    }
    io::require_built(*format);
    return *format;
}

} // namespace

NamedFormat format_from(const std::filesystem::path& path, const pybind11::kwargs& named) {
    NamedFormat chosen{nullptr, {}};
    std::string name;
    for (const auto& [key, value] : named) {
        const auto option = key.cast<std::string>();
        if (option == "format") {
            name = value.cast<std::string>();
        } else if (option == "encoding") {
            chosen.options.encoding = value.cast<std::string>();
        } else if (option == "version") {
            chosen.options.version = value.cast<std::string>();
        } else if (option == "four_dimensional") {
            chosen.options.four_dimensional = value.cast<bool>();
        } else if (option == "pieces") {
            chosen.options.pieces = value.cast<std::size_t>();
        } else {
            throw UsageError{fmt::format("there is no option \"{}\"; there are format, encoding, version, "
                                         "four_dimensional, pieces",
                                         option)};
        }
    }
    chosen.format = &known_format(path, name);
    return chosen;
}

} // namespace slabhull::python
