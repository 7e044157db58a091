// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace slabhull {

/// Why a job was refused; the value is the program's exit code.
enum class Failure : int { usage = 2, input = 3, geometry = 4, output = 5, interrupted = 130 };

/// A thing at fault, in the numbering of the user's own file (or of the boundary, for moved facets).
struct Entity {
    std::string kind; ///< "vertex", "edge", "facet", "cell", "line", "byte"
    std::int64_t number = -1;
    std::string patch; ///< empty where there is none
};

/// Refused work. What went wrong, where, and what to do about it are in what(); `entities` names the
/// culprits.
class Error : public std::runtime_error {
public:
    Error(Failure failure, const std::string& message, std::vector<Entity> at_fault = {})
        : std::runtime_error{message}, entities{std::move(at_fault)}, failure_{failure} {}

    Failure failure() const { return failure_; }

    std::vector<Entity> entities;

private:
    Failure failure_;
};

/// Wrong usage or case file: names the key, the line and what was expected.
class UsageError : public Error {
public:
    explicit UsageError(const std::string& message, std::vector<Entity> at_fault = {})
        : Error{Failure::usage, message, std::move(at_fault)} {}
};

/// An input file is unreadable or invalid: names the file, the place and the entity.
class InputError : public Error {
public:
    explicit InputError(const std::string& message, std::vector<Entity> at_fault = {})
        : Error{Failure::input, message, std::move(at_fault)} {}
};

/// The geometry or the meshing failed.
class GeometryError : public Error {
public:
    explicit GeometryError(const std::string& message, std::vector<Entity> at_fault = {})
        : Error{Failure::geometry, message, std::move(at_fault)} {}
};

/// Writing failed; whatever stood under the final name is untouched.
class OutputError : public Error {
public:
    explicit OutputError(const std::string& message) : Error{Failure::output, message} {}
};

/// A file format cannot hold what is to be written; nothing is written.
class FormatLimit : public OutputError {
public:
    using OutputError::OutputError;
};

/// A count does not fit the index type.
class LimitError : public GeometryError {
public:
    using GeometryError::GeometryError;
};

} // namespace slabhull
