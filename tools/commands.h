// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace slabhull::tools {

/// Each adds a subcommand to the program. What it does goes to its callback; its exit code to `exit_code`.
void add_build(CLI::App& program, int& exit_code);
void add_check(CLI::App& program, int& exit_code);
void add_convert(CLI::App& program, int& exit_code);
void add_fill(CLI::App& program, int& exit_code);
void add_info(CLI::App& program, int& exit_code);
void add_new(CLI::App& program, int& exit_code);
void add_slice(CLI::App& program, int& exit_code);
void add_study(CLI::App& program, int& exit_code);
void add_view(CLI::App& program, int& exit_code);

/// Does work that returns its exit code. Where it throws, says so on standard error and returns that of the
/// error.
int exit_code_of(const std::function<int()>& work);

/// What is wrong with a command line, with the command or option that may have been meant.
std::string usage_fault(const CLI::App& program, const CLI::ParseError& error);

/// For numbers above 0: its message names the number alone.
CLI::Validator positive_number();

} // namespace slabhull::tools
