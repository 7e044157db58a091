// SPDX-License-Identifier: BSD-3-Clause
#include "io/xdmf/rehearsal.h"

#include "core/no_more_files.h"

#include "slabhull/core/error.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

using namespace slabhull;

namespace {

std::string refusal(std::uint64_t bytes, const std::function<void()>& work) {
    try {
        io::rehearse("a.h5", bytes, work);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

} // namespace

TEST_CASE("What is rehearsed well leaves nothing behind", "[rehearsal]") {
    int mine = 1;
    CHECK(refusal(0, [&] { mine = 2; }).empty());
    CHECK(mine == 1);
}

TEST_CASE("What the work throws is refused in its own words, long ones too", "[rehearsal]") {
    CHECK(refusal(0, [] { throw InputError{"a.h5: no such dataset"}; }) == "a.h5: no such dataset");
    CHECK(refusal(0, [] { throw std::runtime_error{"neither"}; }) == "neither");
    const std::string words(10'000, 'w');
    CHECK(refusal(0, [&] { throw InputError{words}; }) == words);
}

TEST_CASE("A crash is refused with its signal's name", "[rehearsal]") {
    CHECK(refusal(0, [] { std::raise(SIGSEGV); }) ==
          "a.h5: it is damaged: the library that reads it ends with \"Segmentation fault\"");
}

TEST_CASE("Work that ends the process without a word is refused", "[rehearsal]") {
    CHECK(refusal(0, [] { ::_exit(1); }) == "a.h5: it cannot be read");
}

TEST_CASE("The work has as many seconds as the file's size is worth", "[rehearsal]") {
    rlimit seconds{};
    constexpr std::uint64_t megabyte = std::uint64_t{1} << 20;
    CHECK(refusal(5 * megabyte, [&] {
              ::getrlimit(RLIMIT_CPU, &seconds);
              throw std::runtime_error{std::to_string(seconds.rlim_cur)};
          }) == "25");
}

#ifndef __SANITIZE_ADDRESS__
TEST_CASE("Memory beyond what the file is worth is refused", "[rehearsal]") {
    constexpr std::size_t plenty = std::size_t{300} << 20;
    const auto take = [] { std::vector<char>(plenty).at(plenty - 1) = 1; };
    CHECK(refusal(0, take) == "std::bad_alloc");
    CHECK(refusal(plenty, take).empty());
}

// Not with sanitizers, which look at objects through pipes of their own.
TEST_CASE("A system that gives no pipe is named as the cause", "[rehearsal]") {
    const testing::NoMoreFiles shortage;
    CHECK(refusal(0, [] {}) == "a.h5: cannot be read: Too many open files");
}
#endif
