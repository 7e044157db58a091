// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/communicator.h"

#include "slabhull/core/error.h"
#include "slabhull/core/progress.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <string>

namespace slabhull {

namespace {

/// What each rank brings to a meeting.
struct Meeting {
    std::int32_t failed; ///< whether it has an error
    std::int32_t depth;  ///< of its scopes
    std::int32_t call;
    std::int32_t unused = 0;
    std::uint64_t bytes;
};

/// Classes of errors that are the same on all ranks.
enum class ErrorKind : std::int32_t { other, memory, error, limit, format_limit };

ErrorKind kind_of_error(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
        return ErrorKind::memory;
    }
    if (dynamic_cast<const LimitError*>(&error) != nullptr) {
        return ErrorKind::limit;
    }
    if (dynamic_cast<const FormatLimit*>(&error) != nullptr) {
        return ErrorKind::format_limit;
    }
    return dynamic_cast<const Error*>(&error) != nullptr ? ErrorKind::error : ErrorKind::other;
}

/// An error as bytes, and back.
class ErrorText {
public:
    void put(std::int64_t number) { put_bytes(&number, sizeof number); }
    void put(const std::string& text) {
        put(static_cast<std::int64_t>(text.size()));
        put_bytes(text.data(), text.size());
    }
    std::int64_t number() {
        std::int64_t value = 0;
        std::memcpy(&value, bytes.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::string text() {
        const auto size = static_cast<std::size_t>(number());
        at_ += size;
        return {bytes.data() + at_ - size, size};
    }

    Array<char> bytes;

private:
    void put_bytes(const void* from, std::size_t size) {
        const auto* begin = static_cast<const char*>(from);
        bytes.insert(bytes.end(), begin, begin + size);
    }
    std::size_t at_ = 0;
};

ErrorText as_text(const std::exception_ptr& thrown) {
    ErrorText text;
    try {
        std::rethrow_exception(thrown);
    } catch (const std::exception& error) {
        const auto* ours = dynamic_cast<const Error*>(&error);
        text.put(static_cast<std::int64_t>(kind_of_error(error)));
        text.put(ours != nullptr ? static_cast<std::int64_t>(ours->failure()) : 0);
        text.put(std::string{error.what()});
        text.put(static_cast<std::int64_t>(ours != nullptr ? ours->entities.size() : 0));
        if (ours != nullptr) {
            for (const Entity& entity : ours->entities) {
                text.put(entity.kind);
                text.put(entity.number);
                text.put(entity.patch);
            }
        }
    } catch (...) {
        text.put(static_cast<std::int64_t>(ErrorKind::other));
        text.put(0);
        text.put(std::string{"something that is no exception of the standard library was thrown"});
        text.put(0);
    }
    return text;
}

std::exception_ptr error_of(Failure failure, const std::string& message, std::vector<Entity> entities) {
    switch (failure) {
    case Failure::usage:
        return std::make_exception_ptr(UsageError{message, std::move(entities)});
    case Failure::input:
        return std::make_exception_ptr(InputError{message, std::move(entities)});
    case Failure::output:
        return std::make_exception_ptr(OutputError{message});
    case Failure::interrupted:
        return std::make_exception_ptr(Interrupted{});
    case Failure::geometry:
        break;
    }
    return std::make_exception_ptr(GeometryError{message, std::move(entities)});
}

std::exception_ptr error_of(ErrorText&& text) {
    const auto kind = static_cast<ErrorKind>(text.number());
    const auto failure = static_cast<Failure>(text.number());
    const std::string message = text.text();
    std::vector<Entity> entities(static_cast<std::size_t>(text.number()));
    for (Entity& entity : entities) {
        entity.kind = text.text();
        entity.number = text.number();
        entity.patch = text.text();
    }
    switch (kind) {
    case ErrorKind::memory:
        return std::make_exception_ptr(std::bad_alloc{});
    case ErrorKind::limit:
        return std::make_exception_ptr(LimitError{message, std::move(entities)});
    case ErrorKind::format_limit:
        return std::make_exception_ptr(FormatLimit{message});
    case ErrorKind::error:
        return error_of(failure, message, std::move(entities));
    case ErrorKind::other:
        break;
    }
    return std::make_exception_ptr(std::runtime_error{message});
}

/// The lowest rank that has an error; -1: none.
int lowest_failed(std::span<const Meeting> all) {
    const auto found =
        std::find_if(all.begin(), all.end(), [](const Meeting& each) { return each.failed != 0; });
    return found != all.end() ? static_cast<int>(found - all.begin()) : -1;
}

/// The outermost scope that a rank is in: down to it, all ranks unwind.
std::int32_t outermost(std::span<const Meeting> all) {
    return std::min_element(all.begin(), all.end(),
                            [](const Meeting& a, const Meeting& b) { return a.depth < b.depth; })
        ->depth;
}

} // namespace

Communicator::Scope::~Scope() {
    if (ranks_.failure_ && ranks_.failed_depth_ >= ranks_.depth_) {
        ranks_.failure_ = nullptr; // all ranks are out of the scope that the error came from
    }
    --ranks_.depth_;
}

void Communicator::agree(Call call, std::uint64_t bytes) {
    if (failure_) {
        std::rethrow_exception(failure_);
    }
    go_on();
    ++meetings_;
    const Meeting mine{0, depth_, static_cast<std::int32_t>(call), 0, bytes};
    std::vector<Meeting> all(static_cast<std::size_t>(size_));
    exchange(&mine, sizeof mine, all.data());
    if (const int failed = lowest_failed(all); failed >= 0) {
        failed_depth_ = outermost(all);
        throw_failure(failed, nullptr);
    }
    for (const Meeting& other : all) {
        if (other.call != mine.call || other.bytes != mine.bytes || other.depth != mine.depth) {
            throw std::logic_error{"ranks have got out of step"};
        }
    }
}

void Communicator::fail(const std::exception_ptr& error) {
    if (failure_) {
        std::rethrow_exception(failure_); // all know of it
    }
    const Meeting mine{1, depth_, 0, 0, 0};
    std::vector<Meeting> all(static_cast<std::size_t>(size_));
    exchange(&mine, sizeof mine, all.data());
    failed_depth_ = outermost(all);
    throw_failure(lowest_failed(all), error);
}

void Communicator::throw_failure(int of, const std::exception_ptr& own) {
    ErrorText text;
    if (of == rank_) {
        text = as_text(own);
    }
    std::uint64_t length = text.bytes.size();
    std::vector<std::uint64_t> lengths(static_cast<std::size_t>(size_));
    exchange(&length, sizeof length, lengths.data());
    const auto from = static_cast<std::size_t>(of);
    Array<char> received(lengths[from]);
    std::vector<std::span<const std::byte>> out(lengths.size());
    std::vector<std::span<std::byte>> in(lengths.size());
    if (of == rank_) {
        std::fill(out.begin(), out.end(), std::as_bytes(std::span<const char>{text.bytes}));
    }
    in[from] = std::as_writable_bytes(std::span<char>{received});
    pass(out, in);
    text.bytes = std::move(received);
    failure_ = of == rank_ ? own : error_of(std::move(text));
    std::rethrow_exception(failure_);
}

void SoleRank::exchange(const void* mine, std::size_t bytes, void* all) {
    std::memcpy(all, mine, bytes);
}

void SoleRank::pass(std::span<const std::span<const std::byte>> to,
                    std::span<const std::span<std::byte>> from) {
    std::copy(to[0].begin(), to[0].end(), from[0].begin());
}

} // namespace slabhull
