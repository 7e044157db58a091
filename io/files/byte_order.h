// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstring>

namespace slabhull::io {

/// The value stored at `place`, in the machine's byte order or in the opposite one.
template<class T>
T load(const char* place, bool swapped) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), place, sizeof(T));
    if (swapped) {
        std::reverse(bytes.begin(), bytes.end());
    }
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
}

} // namespace slabhull::io
