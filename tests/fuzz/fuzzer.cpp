// SPDX-License-Identifier: BSD-3-Clause
// The entry of libFuzzer for the reader SLABHULL_READER.
#include "fuzz/readers.h"
#include "slabhull/core/parallel.h"

#include <cstdint>
#include <ctime>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::Reader* const reader = [] {
        slabhull::set_thread_count(1);
        return fuzz::reader_named(SLABHULL_READER);
    }();
    const std::clock_t start = std::clock(); // of the processor: libFuzzer's own limit is one of wall time
    reader->read({reinterpret_cast<const char*>(data), size});
    if (std::clock() - start > 2 * CLOCKS_PER_SEC) {
        throw std::logic_error{"a small file takes more than two seconds"};
    }
    return 0;
}
