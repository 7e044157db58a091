// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace fuzz {

enum class Outcome { refused, read };

/// A reader, and what is to be made of bytes that may be anything.
struct Reader {
    std::string_view name;
    /// Reads the bytes as a file. Throws std::logic_error when that comes to neither an InputError (of case
    /// files also a UsageError) nor to something consistent that can be written and read again; whatever else
    /// gets out is an error as well.
    Outcome (*read)(std::string_view bytes);
};

/// One for each format of this build, by the format's name, and `curve`, `csv`, `case`.
std::span<const Reader> readers();
/// nullptr: none of that name in this build.
const Reader* reader_named(std::string_view name);

} // namespace fuzz
