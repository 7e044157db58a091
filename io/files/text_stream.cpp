// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/text_stream.h"

namespace slabhull::io {

void TextStream::put(std::string_view text) {
    reserve(text.size());
    if (text.size() > buffer_bytes) {
        file_.write(text);
        return;
    }
    text.copy(buffer_.get() + used_, text.size());
    used_ += text.size();
}

void TextStream::flush() {
    file_.write(buffer_.get(), used_);
    used_ = 0;
}

} // namespace slabhull::io
