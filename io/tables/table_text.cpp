// SPDX-License-Identifier: BSD-3-Clause
#include "io/tables/table_text.h"

#include "slabhull/core/error.h"

#include <cctype>
#include <charconv>
#include <fmt/format.h>

namespace slabhull::io {

void fail_in_line(const std::string& path, std::size_t line, const std::string& text) {
    throw InputError(fmt::format("{}: line {}: {}", path, line, text),
                     {Entity{"line", static_cast<std::int64_t>(line), {}}});
}

bool parse_number(std::string_view text, double& value) {
    if (text.starts_with('+') && !text.starts_with("+-")) { // from_chars accepts no plus sign
        text.remove_prefix(1);
    }
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    return problem == std::errc{} && stop == text.data() + text.size();
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t shown = 40;
    std::string quoted = "\"";
    for (const unsigned char c : text.substr(0, shown)) {
        quoted += std::isprint(c) != 0 ? static_cast<char>(c) : '?';
    }
    return quoted + (text.size() > shown ? "...\"" : "\"");
}

} // namespace slabhull::io
