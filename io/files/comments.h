// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/file_cursor.h"

#include <fmt/format.h>
#include <string>

namespace slabhull::io {

/// Skips blanks, line ends and comments from '#' to the end of the line.
inline void skip_comments(FileCursor& in) {
    in.skip_blanks();
    while (in.remaining() > 0 && in.rest().front() == '#') {
        in.line();
        in.skip_blanks();
    }
}

/// Reads a keyword and skips the comments around it; another word is an error.
inline void expect_keyword(FileCursor& in, const std::string& keyword) {
    skip_comments(in);
    in.require(in.word() == keyword, fmt::format("\"{}\" was expected", keyword));
    skip_comments(in);
}

} // namespace slabhull::io
