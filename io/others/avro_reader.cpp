// SPDX-License-Identifier: BSD-3-Clause
// The layout is that of test/library/meshes/giraffe.avro in avro's repository (P. C. Caplan,
// github.com/philipclaude/avro).
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace slabhull::io {

namespace {

/// Reads JSON: one object of numbers, texts and flat arrays; other values are skipped.
class JsonCursor : public FileCursor {
public:
    using FileCursor::FileCursor;

    /// Whether the next character is `wanted`, which is then skipped.
    bool accept(char wanted) {
        skip_blanks();
        const bool found = remaining() > 0 && rest().front() == wanted;
        seek(offset() + (found ? 1 : 0));
        return found;
    }
    void expect(char wanted, const char* where) {
        if (!accept(wanted)) {
            fail(fmt::format("'{}' was expected {}", wanted, where));
        }
    }

    /// A text in double quotes, without resolving escapes.
    std::string text(const char* what) {
        expect('"', what);
        const std::string_view all = rest();
        std::size_t end = 0;
        while (end < all.size() && all[end] != '"') {
            end += all[end] == '\\' ? 2 : 1;
        }
        if (end >= all.size()) {
            fail(fmt::format("the file ends within {}", what));
        }
        seek(offset() + end + 1);
        return std::string{all.substr(0, end)};
    }

    template<class T>
    T value(const char* what) {
        skip_blanks();
        const std::string_view all = rest();
        T result{};
        const auto [stop, problem] = std::from_chars(all.data(), all.data() + all.size(), result);
        const bool ends = stop == all.data() + all.size() || is_blank(*stop) || *stop == ',' ||
                          *stop == ']' || *stop == '}';
        if (problem != std::errc{} || !ends) {
            fail(fmt::format("{} was expected, not \"{}\"", what,
                             all.substr(0, all.find_first_of(" ,]}\r\n")).substr(0, 40)));
        }
        seek(offset() + static_cast<std::size_t>(stop - all.data()));
        return result;
    }

    /// An array of numbers. Memory grows with the numbers in the file.
    template<class T>
    Array<T> values(const char* what) {
        expect('[', what);
        Array<T> result;
        if (accept(']')) {
            return result;
        }
        do {
            result.push_back(value<T>(what));
        } while (accept(','));
        expect(']', what);
        return result;
    }

    /// Skips a value of any kind and depth.
    void pass() {
        std::size_t depth = 0;
        do {
            skip_blanks();
            if (remaining() == 0) {
                fail("the file ends within a value");
            }
            const char next = rest().front();
            if (next == '"') {
                text("a text");
                continue;
            }
            depth += next == '[' || next == '{' ? 1 : 0;
            if (depth == 0) { // a number or a word
                const std::size_t end = std::min(rest().find_first_of(",]}\" \t\r\n"), remaining());
                if (end == 0) {
                    fail("a value was expected");
                }
                seek(offset() + end);
                return;
            }
            depth -= next == ']' || next == '}' ? 1 : 0;
            seek(offset() + 1);
        } while (depth > 0);
    }
};

class AvroReader {
public:
    AvroReader(std::string_view bytes, const std::string& path) : in_{bytes, path} { soup_.path = path; }

    Soup read() {
        in_.expect('{', "at the start of an avro mesh");
        do {
            read_entry();
        } while (in_.accept(','));
        in_.expect('}', "after a value");
        require(in_.at_end(), "the end of the file was expected");
        for (const char* key : {"dim", "number", "type", "vertices", "elements"}) {
            require(seen_.contains(key), fmt::format("there is no \"{}\"", key));
        }
        take_vertices();
        take_elements();
        return std::move(soup_);
    }

private:
    void require(bool condition, const std::string& text) const {
        if (!condition) {
            in_.fail(text);
        }
    }

    void read_entry() {
        const std::string key = in_.text("before a key");
        require(seen_.insert(key).second, fmt::format("\"{}\" appears twice", key.substr(0, 40)));
        in_.expect(':', "after a key");
        in_.skip_blanks();
        if (key == "dim") {
            dimension_ = in_.value<std::size_t>("a dimension");
            require(dimension_ >= 2 && dimension_ <= 4, "dimension 2, 3 or 4 was expected");
        } else if (key == "number") {
            number_ = in_.value<std::size_t>("the dimension of simplices");
            require(number_ >= 1 && number_ <= 3, "simplices of dimension 1, 2 or 3 were expected");
        } else if (key == "nb_ghost") {
            require(in_.value<std::uint64_t>("a count") == 0, "ghost vertices are not read");
        } else if (key == "type") {
            require(in_.text("for a type") == "simplex", "only the type \"simplex\" is read");
        } else if (key == "vertices") {
            vertices_at_ = in_.offset();
            coordinates_ = in_.values<double>("a list of coordinates");
        } else if (key == "elements") {
            elements_at_ = in_.offset();
            elements_ = in_.values<Index>("a list of vertices' numbers");
        } else {
            in_.pass();
        }
    }

    /// Keys come in any order, so numbers are divided into points only at the end.
    void take_vertices() {
        if (coordinates_.size() % dimension_ != 0) {
            in_.fail_at(vertices_at_, fmt::format("{} coordinates are not {} for each vertex",
                                                  coordinates_.size(), dimension_));
        }
        const std::size_t count = coordinates_.size() / dimension_;
        checked_index(count, "vertices");
        soup_.points.assign(count, Point<3>{});
        Array<double> time(dimension_ == 4 ? count : 0);
        for (std::size_t i = 0; i < count; ++i) {
            const double* x = coordinates_.data() + i * dimension_;
            if (!std::all_of(x, x + dimension_, [](double value) { return std::isfinite(value); })) {
                in_.fail_at(vertices_at_,
                            fmt::format("vertex {} has a coordinate that is not a finite number", i));
            }
            std::copy_n(x, std::min<std::size_t>(3, dimension_), soup_.points[i].begin());
            if (dimension_ == 4) {
                time[i] = x[3];
            }
        }
        if (dimension_ == 4) {
            soup_.point_data.push_back({"t", 1, std::move(time)});
        }
    }

    void take_elements() {
        const std::size_t corners = number_ + 1;
        if (elements_.size() % corners != 0) {
            in_.fail_at(elements_at_, fmt::format("{} vertices' numbers are not {} for each element",
                                                  elements_.size(), corners));
        }
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            if (elements_[i] >= soup_.points.size()) {
                in_.fail_at(elements_at_, fmt::format("element {} has the vertex {}, but there are {}",
                                                      i / corners, elements_[i], soup_.points.size()));
            }
        }
        soup_.simplices[number_].vertices = std::move(elements_);
    }

    JsonCursor in_;
    Soup soup_;
    std::set<std::string> seen_;
    std::size_t dimension_ = 0; ///< of space
    std::size_t number_ = 0;    ///< dimension of the simplices
    Array<double> coordinates_;
    Array<Index> elements_;
    std::size_t vertices_at_ = 0;
    std::size_t elements_at_ = 0;
};

} // namespace

Soup read_avro(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    return AvroReader{{bytes.data(), bytes.size()}, path.string()}.read();
}

} // namespace slabhull::io
