// SPDX-License-Identifier: BSD-3-Clause
// The entry of libFuzzer for the reader SLABHULL_READER.
#include "fuzz/readers.h"
#include "slabhull/core/parallel.h"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::Reader* const reader = [] {
        slabhull::set_thread_count(1);
        return fuzz::reader_named(SLABHULL_READER);
    }();
    reader->read({reinterpret_cast<const char*>(data), size});
    return 0;
}
