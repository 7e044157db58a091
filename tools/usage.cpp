// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "slabhull/core/text.h"

#include <cmath>
#include <fmt/format.h>

namespace slabhull::tools {

namespace {

std::vector<std::string> names_of_commands(const CLI::App& program) {
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(command->get_name());
    }
    return names;
}

std::vector<std::string> names_of_options(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

/// The word that no command or option takes, the first that looks like an option; empty if there is none.
std::string unknown_word(const CLI::App& program) {
    const std::vector<std::string> rest = program.remaining(true);
    for (const std::string& word : rest) {
        if (word.starts_with("-")) {
            return word;
        }
    }
    return rest.empty() ? "" : rest.front();
}

/// The name that was meant or, where none is near, `help`.
std::string hint(const std::string& word, const std::vector<std::string>& known, const std::string& help) {
    const std::string nearest = did_you_mean(word, known);
    return nearest.empty() ? "; " + help : nearest;
}

} // namespace

CLI::Validator positive_number() {
    return {[](const std::string& text) {
                double value = 0;
                return CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value)
                           ? std::string{}
                           : fmt::format("expected a positive number, not {}", text);
            },
            "POSITIVE"};
}

std::string usage_fault(const CLI::App& program, const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = program.get_subcommands();
    const std::string word = unknown_word(program);
    if (chosen.empty()) {
        const std::string fault = word.empty()            ? "a command is missing"
                                  : word.starts_with("-") ? fmt::format("there is no option {}", word)
                                                          : fmt::format("there is no command \"{}\"", word);
        return fault + hint(word, names_of_commands(program), "slabhull --help lists the commands");
    }
    const CLI::App& command = *chosen.front();
    const std::string help = fmt::format("slabhull {} --help says how it is called", command.get_name());
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || word.empty()) {
        return fmt::format("{}: {}; {}", command.get_name(), error.what(), help);
    }
    return word.starts_with("-")
               ? fmt::format("{}: there is no option {}{}", command.get_name(), word,
                             hint(word, names_of_options(command), help))
               : fmt::format("{}: one argument too many, \"{}\"; {}", command.get_name(), word, help);
}

} // namespace slabhull::tools
