// SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_guard.h"

#include "io/files/coordinate.h"
#include "io/files/file_cursor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <optional>
#include <vector>

namespace slabhull::io {

namespace {

struct Property {
    std::string name;
    std::string type;
    std::string count_type; ///< of a list; empty for a scalar
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

/// Calls use(T{}) with the type of that name; false if there is none.
template<class Use>
bool with_ply_type(std::string_view name, const Use& use) {
    const auto is = [&](std::string_view a, std::string_view b) { return name == a || name == b; };
    if (is("float", "float32"))
        return use(float{}), true;
    if (is("double", "float64"))
        return use(double{}), true;
    if (is("int", "int32"))
        return use(std::int32_t{}), true;
    if (is("uint", "uint32"))
        return use(std::uint32_t{}), true;
    if (is("short", "int16"))
        return use(std::int16_t{}), true;
    if (is("ushort", "uint16"))
        return use(std::uint16_t{}), true;
    if (is("char", "int8"))
        return use(std::int8_t{}), true;
    if (is("uchar", "uint8"))
        return use(std::uint8_t{}), true;
    return false;
}

template<class T>
T swapped(T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

class PlyGuard {
public:
    PlyGuard(std::string_view bytes, const std::string& path) : in_{bytes, path} {}

    GuardedSurface guard() {
        read_head();
        in_.set_binary(guarded_.binary);
        for (const Element& element : elements_) {
            read_element(element);
        }
        write();
        return std::move(guarded_);
    }

private:
    void require(bool condition, const char* text) const {
        if (!condition) {
            in_.fail(text);
        }
    }

    void read_head() {
        require(in_.line() == "ply", "this is no PLY file: \"ply\" was expected");
        std::string word;
        while ((word = in_.word()) != "end_header") {
            if (word == "format") {
                read_format();
            } else if (word == "element") {
                const std::string name{in_.word()};
                elements_.push_back({name, in_.parsed<std::uint64_t>("a count"), {}});
            } else if (word == "property") {
                read_property();
            } else {
                require(word == "comment" || word == "obj_info", "a line of the PLY header was expected");
            }
            in_.line();
        }
        in_.line();
    }

    void read_format() {
        const std::string_view format = in_.word();
        guarded_.binary = format != "ascii";
        swap_ = format == "binary_big_endian";
        require(!guarded_.binary || swap_ || format == "binary_little_endian",
                "this PLY format is not known");
    }

    void read_property() {
        require(!elements_.empty(), "a property without an element");
        Property property;
        property.type = in_.word();
        if (property.type == "list") {
            property.count_type = in_.word();
            property.type = in_.word();
        }
        property.name = in_.word();
        const auto known = [](const std::string& type) { return with_ply_type(type, [](auto) {}); };
        require(known(property.type) && (property.count_type.empty() || known(property.count_type)),
                "the type of a property is not known");
        elements_.back().properties.push_back(std::move(property));
    }

    double value(const std::string& type) {
        double result = 0;
        with_ply_type(type, [&](auto zero) {
            using T = decltype(zero);
            if (!guarded_.binary) {
                result = in_.parsed<double>("a number");
            } else {
                const T stored = in_.raw<T>("a value");
                result = static_cast<double>(swap_ ? swapped(stored) : stored);
            }
        });
        return result;
    }

    /// A count or index: a whole number below the limit.
    std::optional<std::uint64_t> whole(const std::string& type, std::uint64_t limit) {
        const double number = value(type);
        const bool fits = number >= 0 && number < static_cast<double>(limit) && number == std::floor(number);
        return fits ? std::optional{static_cast<std::uint64_t>(number)} : std::nullopt;
    }

    void read_element(const Element& element) {
        if (!element.properties.empty()) {
            in_.plausible(element.count, 1, element.name.c_str());
        }
        const std::uint64_t rows = element.properties.empty() ? 0 : element.count;
        for (std::uint64_t i = 0; i < rows; ++i) {
            if (element.name == "vertex") {
                read_vertex(element);
            } else {
                read_row(element);
            }
        }
    }

    void read_vertex(const Element& element) {
        Point<3> point{};
        int found = 0;
        const std::string whose = fmt::format("vertex {}", guarded_.points.size());
        for (const Property& property : element.properties) {
            require(property.count_type.empty(), "a vertex has a list, which is not read");
            const double number = value(property.type);
            const bool is_coordinate =
                property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
            if (is_coordinate) {
                require_coordinate(in_, number, whose);
                point[static_cast<std::size_t>(property.name[0] - 'x')] = number;
                ++found;
            }
        }
        require(found == 3, "a vertex lacks the properties x, y, z");
        guarded_.points.push_back(point);
    }

    void read_row(const Element& element) {
        bool has_corners = false;
        for (const Property& property : element.properties) {
            const bool corners = element.name == "face" && !property.count_type.empty() &&
                                 (property.name == "vertex_indices" || property.name == "vertex_index");
            if (corners) {
                read_corners(property);
                has_corners = true;
            } else {
                skip(property);
            }
        }
        require(has_corners || element.name != "face", "a face lacks the property vertex_indices");
    }

    void skip(const Property& property) {
        std::uint64_t count = 1;
        if (!property.count_type.empty()) {
            const auto length = whole(property.count_type, in_.remaining() + 1);
            require(length.has_value(), "a list is longer than the file");
            count = *length;
        }
        for (std::uint64_t i = 0; i < count; ++i) {
            value(property.type);
        }
    }

    void read_corners(const Property& property) {
        const std::size_t face = corners_.size() / 3;
        const auto count = whole(property.count_type, in_.remaining() + 1);
        if (count != 3) {
            in_.fail(fmt::format("face {} is no triangle; only triangles are read", face));
        }
        for (int k = 0; k < 3; ++k) {
            const auto index = whole(property.type, guarded_.points.size());
            if (!index) {
                in_.fail(fmt::format("face {} names a vertex that does not exist; there are {}", face,
                                     guarded_.points.size()));
            }
            corners_.push_back(static_cast<std::int32_t>(*index));
        }
    }

    /// The same surface with nothing else in it.
    void write() {
        guarded_.faces = corners_.size() / 3;
        guarded_.binary = true;
        std::string& text = guarded_.text;
        text = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
                           "property double y\nproperty double z\nelement face {}\n"
                           "property list uchar int vertex_indices\nend_header\n",
                           guarded_.points.size(), guarded_.faces);
        text.append(reinterpret_cast<const char*>(guarded_.points.data()),
                    guarded_.points.size() * sizeof(Point<3>));
        for (std::size_t face = 0; face < guarded_.faces; ++face) {
            text += '\3';
            text.append(reinterpret_cast<const char*>(corners_.data() + 3 * face), 3 * sizeof(std::int32_t));
        }
    }

    FileCursor in_;
    GuardedSurface guarded_;
    std::vector<Element> elements_;
    Array<std::int32_t> corners_;
    bool swap_ = false;
};

} // namespace

GuardedSurface guard_ply(std::string_view bytes, const std::string& path) {
    return PlyGuard{bytes, path}.guard();
}

} // namespace slabhull::io
