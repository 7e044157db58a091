// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/text.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace slabhull {

/// A table of a TOML file. It remembers which keys were asked for, to report the others as unknown,
/// and turns every mismatch into a UsageError naming the file, the line, the key and what was expected.
class KeyTable {
public:
    /// Throws InputError when the file cannot be read, UsageError when it is not TOML.
    static KeyTable parse_file(const std::filesystem::path& path);
    /// The same of a text; `name` is what messages call it.
    static KeyTable parse(const std::string& text, const std::string& name);

    bool has(const std::string& key) const;
    std::vector<std::string> keys() const;
    /// The keys of tables.
    std::vector<std::string> table_names() const;

    std::string text(const std::string& key);
    std::optional<std::string> optional_text(const std::string& key);
    bool boolean(const std::string& key);
    int integer(const std::string& key, int smallest, int largest);
    double number(const std::string& key);
    double number_or(const std::string& key, double otherwise);
    double positive(const std::string& key);
    /// `count` numbers, any number when it is negative; all of them finite.
    std::vector<double> numbers(const std::string& key, int count);
    std::vector<double> positives(const std::string& key, int count);
    /// `count` numbers that are not all zero.
    std::vector<double> direction(const std::string& key, int count);
    /// `count` texts; any number when it is negative.
    std::vector<std::string> texts(const std::string& key, int count);
    std::map<std::string, double> optional_constants(const std::string& key);

    KeyTable table(const std::string& key);
    /// An empty table where there is none.
    KeyTable optional_table(const std::string& key);
    std::vector<KeyTable> optional_tables(const std::string& key);

    template<class T>
    T choice(const std::string& key, const std::map<std::string, T>& choices) {
        const std::string name = text(key);
        const auto found = choices.find(name);
        if (found == choices.end()) {
            std::string known;
            std::vector<std::string> names;
            for (const auto& [each, value] : choices) {
                names.push_back(each);
                known += (known.empty() ? "\"" : ", \"") + each + "\"";
            }
            fail(key, (choices.size() > 1 ? "one of " : "") + known + ", not \"" + name + "\"" +
                          did_you_mean(name, names));
        }
        return found->second;
    }

    /// Throws UsageError: at `key` of this table, `expected` was expected.
    [[noreturn]] void fail(const std::string& key, const std::string& expected) const;
    /// Throws UsageError: the `fault` at `key`, which there is.
    [[noreturn]] void refuse(const std::string& key, const std::string& fault) const;
    /// Throws UsageError for the first unknown key; names the nearest known one, or all of them.
    void require_all_known() const;

private:
    struct Node; // keeps toml++ out of this header
    explicit KeyTable(std::shared_ptr<Node> node);
    std::shared_ptr<Node> node_;
};

} // namespace slabhull
