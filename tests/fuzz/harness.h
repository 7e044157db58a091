// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fuzz/input_file.h"
#include "fuzz/memory_meter.h"
#include "fuzz/readers.h"
#include "slabhull/core/error.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace fuzz {

/// Where this process puts its files.
const InputFolder& folder();

/// Throws std::logic_error if there is a fault.
void require(const std::string& fault, const std::string& when);
/// That memory did not grow beyond what goes with so many bytes of a file.
void require_bounded(const MemoryMeter& meter, std::string_view bytes);
/// That the message names the file and can be shown on a terminal.
void require_message(const slabhull::Error& error, const std::filesystem::path& path);

/// Nothing if it is refused by a Refusal, which must say so in a message.
template<class Refusal, class Read>
auto read_or_refuse(const Read& read, const std::filesystem::path& path, std::string_view bytes)
    -> std::optional<decltype(read(path))> {
    const MemoryMeter meter;
    try {
        auto result = read(path);
        require_bounded(meter, bytes);
        return result;
    } catch (const Refusal& error) {
        require_message(error, path);
        require_bounded(meter, bytes);
        return std::nullopt;
    }
}

/// Case files (case_reader.cpp).
Outcome read_case_file(std::string_view bytes);

} // namespace fuzz
