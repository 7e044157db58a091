// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/file_cursor.h"

namespace slabhull::io {

/// Passes blanks, line ends and comments from '#' to the end of the line.
inline void skip_comments(FileCursor& in) {
    in.skip_blanks();
    while (in.remaining() > 0 && in.rest().front() == '#') {
        in.line();
        in.skip_blanks();
    }
}

} // namespace slabhull::io
