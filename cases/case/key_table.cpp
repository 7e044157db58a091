// SPDX-License-Identifier: BSD-3-Clause
#include "cases/case/key_table.h"

#include "slabhull/core/error.h"
#include "slabhull/core/missing_file.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iterator>
#include <set>
#include <toml++/toml.h>

namespace slabhull {

struct KeyTable::Node {
    std::shared_ptr<const toml::table> root; ///< keeps the document alive
    const toml::table* table;
    std::string file;
    std::string name; ///< "motion.flange", empty for the document
    std::set<std::string> known{};

    const toml::node* find(const std::string& key) {
        known.insert(key);
        return table->get(key);
    }
    std::string full_name(const std::string& key) const { return name.empty() ? key : name + "." + key; }
};

namespace {

/// The nearest double to a number, whole ones beyond 2^53, too; nothing if it is not finite, or no number.
std::optional<double> as_double(const toml::node& node) {
    if (const toml::value<std::int64_t>* const whole = node.as_integer()) {
        return static_cast<double>(whole->get());
    }
    const toml::value<double>* const number = node.as_floating_point();
    return number != nullptr && std::isfinite(number->get()) ? std::optional{number->get()} : std::nullopt;
}

std::string read_all(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    if (std::filesystem::is_directory(path)) {
        throw InputError(fmt::format("{}: is a folder; give the case file in it", path.string()));
    }
    if (!file) {
        const int why = errno;
        throw InputError(fmt::format("{}: cannot be read: {}{}", path.string(), std::strerror(why),
                                     look_again(path, why)));
    }
    return {std::istreambuf_iterator<char>{file}, {}};
}

/// What toml++ says, and what to do about the mistakes that are made most often.
std::string toml_fault(const std::string& said) {
    struct Advice {
        const char* words;
        const char* advice;
    };
    constexpr std::array<Advice, 5> advices{{
        {"could not determine value type", "texts stand in quotation marks, numbers have a decimal point"},
        {"cannot redefine existing table",
         "a table stands once in a file: put all its keys under one heading"},
        {"cannot redefine existing", "a key stands once in a table: remove one of the two"},
        {"saw ','", "numbers have a decimal point, not a comma; lists stand in brackets, as in [1.0, 2.5]"},
        {"", "write key = value, a line each, under [table] headings, as docs/case-file.md has them"},
    }};
    const std::size_t colon = said.find(": "); // behind "Error while parsing ..."
    const auto* found = std::find_if(advices.begin(), advices.end(), [&said](const Advice& each) {
        return said.find(each.words) != std::string::npos;
    });
    return fmt::format("no TOML: {}; {}",
                       readable(colon == std::string::npos ? said : said.substr(colon + 2)), found->advice);
}

/// toml++ takes tables of tables apart recursively: dotted keys of very many parts would exhaust the stack.
void require_shallow(const std::string& text, const std::string& file) {
    constexpr int most_parts = 1000;
    int parts = 0;
    std::size_t line = 1;
    char before = '.';
    for (const char c : text) {
        line += c == '\n' ? 1 : 0;
        if (c == '.') {
            parts = before == '.' ? 0 : parts + 1; // dots in a row are no key
        } else if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-' && c != '"' &&
                   c != '\'') {
            parts = 0;
        }
        before = c;
        if (parts == most_parts) {
            throw UsageError(
                fmt::format("{}: line {}: no TOML: a key of more than {} parts; write key = value, a line "
                            "each, under [table] headings",
                            file, line, most_parts));
        }
    }
}

} // namespace

KeyTable::KeyTable(std::shared_ptr<Node> node) : node_{std::move(node)} {}

KeyTable KeyTable::parse_file(const std::filesystem::path& path) {
    return parse(read_all(path), path.string());
}

KeyTable KeyTable::parse(const std::string& text, const std::string& name) {
    require_shallow(text, name);
    try {
        auto root = std::make_shared<const toml::table>(toml::parse(text));
        const toml::table* table = root.get();
        return KeyTable{std::make_shared<Node>(Node{std::move(root), table, name, ""})};
    } catch (const toml::parse_error& error) {
        throw UsageError(fmt::format("{}: line {}: {}", name, error.source().begin.line,
                                     toml_fault(std::string{error.description()})));
    }
}

bool KeyTable::has(const std::string& key) const {
    return node_->find(key) != nullptr;
}

std::vector<std::string> KeyTable::keys() const {
    std::vector<std::string> names;
    for (const auto& [key, value] : *node_->table) {
        names.emplace_back(key.str());
    }
    return names;
}

std::vector<std::string> KeyTable::table_names() const {
    std::vector<std::string> names = keys();
    std::erase_if(names, [this](const std::string& key) { return !node_->table->get(key)->is_table(); });
    return names;
}

void KeyTable::fail(const std::string& key, const std::string& expected) const {
    const toml::node* at = node_->table->get(key);
    const auto line = at != nullptr ? at->source().begin.line : node_->table->source().begin.line;
    throw UsageError(fmt::format("{}: line {}: {}: {}expected {}", node_->file, line,
                                 readable(node_->full_name(key)), at == nullptr ? "missing; " : "",
                                 readable(expected)));
}

void KeyTable::refuse(const std::string& key, const std::string& fault) const {
    throw UsageError(fmt::format("{}: line {}: {}: {}", node_->file,
                                 node_->table->get(key)->source().begin.line, readable(node_->full_name(key)),
                                 readable(fault)));
}

void KeyTable::require_all_known() const {
    for (const auto& [key, value] : *node_->table) {
        const std::string name{key.str()};
        if (node_->known.contains(name)) {
            continue;
        }
        const std::vector<std::string> known(node_->known.begin(), node_->known.end());
        const std::string nearest = nearest_name(name, known);
        const std::string advice =
            nearest.empty()
                ? fmt::format("the keys {} are {}", node_->name.empty() ? "here" : "of " + node_->name,
                              fmt::join(known, ", "))
                : fmt::format("did you mean \"{}\"?", node_->full_name(nearest));
        throw UsageError(fmt::format("{}: line {}: unknown key \"{}\"; {}", node_->file,
                                     key.source().begin.line, readable(node_->full_name(name)),
                                     readable(advice)));
    }
}

std::string KeyTable::text(const std::string& key) {
    const toml::node* node = node_->find(key);
    if (node == nullptr || !node->is_string()) {
        fail(key, "a text");
    }
    return node->as_string()->get();
}

std::optional<std::string> KeyTable::optional_text(const std::string& key) {
    return has(key) ? std::optional{text(key)} : std::nullopt;
}

bool KeyTable::boolean(const std::string& key) {
    const toml::node* node = node_->find(key);
    if (node == nullptr || !node->is_boolean()) {
        fail(key, "true or false");
    }
    return node->as_boolean()->get();
}

int KeyTable::integer(const std::string& key, int smallest, int largest) {
    const toml::node* node = node_->find(key);
    const std::string expected = smallest == largest
                                     ? fmt::format("{}", smallest)
                                     : fmt::format("a whole number from {} to {}", smallest, largest);
    if (node == nullptr || !node->is_integer()) {
        const bool quoted = node != nullptr && node->is_string();
        fail(key, quoted ? expected + ", without quotation marks" : expected);
    }
    const std::int64_t value = node->as_integer()->get();
    if (value < smallest || value > largest) {
        fail(key, fmt::format("{}, not {}", expected, value));
    }
    return static_cast<int>(value);
}

double KeyTable::number(const std::string& key) {
    const toml::node* node = node_->find(key);
    if (node == nullptr || !node->is_number()) {
        fail(key, "a number");
    }
    const std::optional<double> value = as_double(*node);
    if (!value) {
        fail(key, "a finite number");
    }
    return *value;
}

double KeyTable::number_or(const std::string& key, double otherwise) {
    return has(key) ? number(key) : otherwise;
}

double KeyTable::positive(const std::string& key) {
    const double value = number(key);
    if (!(value > 0)) {
        fail(key, fmt::format("a positive number, not {}", value));
    }
    return value;
}

std::vector<double> KeyTable::numbers(const std::string& key, int count) {
    const std::string expected =
        count < 0 ? "a list of finite numbers" : fmt::format("a list of {} finite numbers", count);
    const toml::node* node = node_->find(key);
    if (node == nullptr || !node->is_array() ||
        (count >= 0 && node->as_array()->size() != static_cast<std::size_t>(count))) {
        fail(key, expected);
    }
    std::vector<double> values;
    for (const toml::node& entry : *node->as_array()) {
        const std::optional<double> value = as_double(entry);
        if (!value) {
            fail(key, expected);
        }
        values.push_back(*value);
    }
    return values;
}

std::vector<double> KeyTable::positives(const std::string& key, int count) {
    std::vector<double> values = numbers(key, count);
    if (std::any_of(values.begin(), values.end(), [](double value) { return !(value > 0); })) {
        fail(key, "positive numbers");
    }
    return values;
}

std::vector<double> KeyTable::direction(const std::string& key, int count) {
    std::vector<double> values = numbers(key, count);
    if (std::all_of(values.begin(), values.end(), [](double value) { return value == 0; })) {
        fail(key, "a direction, not the zero vector");
    }
    return values;
}

std::vector<std::string> KeyTable::texts(const std::string& key, int count) {
    const std::string expected = count < 0 ? "a list of texts" : fmt::format("a list of {} texts", count);
    const toml::node* node = node_->find(key);
    if (node == nullptr || !node->is_array() ||
        (count >= 0 && node->as_array()->size() != static_cast<std::size_t>(count))) {
        fail(key, expected);
    }
    std::vector<std::string> values;
    for (const toml::node& entry : *node->as_array()) {
        if (!entry.is_string()) {
            fail(key, expected);
        }
        values.push_back(entry.as_string()->get());
    }
    return values;
}

std::map<std::string, double> KeyTable::optional_constants(const std::string& key) {
    std::map<std::string, double> constants;
    KeyTable inner = optional_table(key);
    for (const std::string& name : inner.keys()) {
        constants[name] = inner.number(name);
    }
    return constants;
}

KeyTable KeyTable::table(const std::string& key) {
    const toml::node* node = node_->find(key);
    if (node == nullptr || !node->is_table()) {
        fail(key, "a table");
    }
    return KeyTable{
        std::make_shared<Node>(Node{node_->root, node->as_table(), node_->file, node_->full_name(key)})};
}

KeyTable KeyTable::optional_table(const std::string& key) {
    if (has(key)) {
        return table(key);
    }
    auto empty = std::make_shared<const toml::table>();
    const toml::table* inside = empty.get();
    return KeyTable{
        std::make_shared<Node>(Node{std::move(empty), inside, node_->file, node_->full_name(key)})};
}

std::vector<KeyTable> KeyTable::optional_tables(const std::string& key) {
    std::vector<KeyTable> tables;
    const toml::node* node = node_->find(key);
    if (node == nullptr) {
        return tables;
    }
    if (!node->is_array()) {
        fail(key, "a list of tables");
    }
    for (const toml::node& entry : *node->as_array()) {
        if (!entry.is_table()) {
            fail(key, "a list of tables");
        }
        const std::string name = fmt::format("{}[{}]", node_->full_name(key), tables.size());
        tables.push_back(
            KeyTable{std::make_shared<Node>(Node{node_->root, entry.as_table(), node_->file, name})});
    }
    return tables;
}

} // namespace slabhull
