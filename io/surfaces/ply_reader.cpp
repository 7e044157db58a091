// SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_readers.h"

#include "io/files/coordinate.h"
#include "io/files/file_cursor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace slabhull::io {

namespace {

enum class PlyType { none, f32, f64, i8, u8, i16, u16, i32, u32 };

PlyType type_named(std::string_view name) {
    struct Name {
        std::string_view old_name;
        std::string_view new_name;
        PlyType type;
    };
    constexpr std::array<Name, 8> names{{{"float", "float32", PlyType::f32},
                                         {"double", "float64", PlyType::f64},
                                         {"char", "int8", PlyType::i8},
                                         {"uchar", "uint8", PlyType::u8},
                                         {"short", "int16", PlyType::i16},
                                         {"ushort", "uint16", PlyType::u16},
                                         {"int", "int32", PlyType::i32},
                                         {"uint", "uint32", PlyType::u32}}};
    const auto* found = std::find_if(names.begin(), names.end(), [name](const Name& each) {
        return name == each.old_name || name == each.new_name;
    });
    return found == names.end() ? PlyType::none : found->type;
}

struct Property {
    std::string name;
    PlyType type = PlyType::none;
    PlyType count_type = PlyType::none; ///< type of a list's count; none for a scalar

    bool is_list() const { return count_type != PlyType::none; }
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

/// Whether a property has a usual name for the number of the part that a face belongs to.
bool names_a_part(const Property& property) {
    constexpr std::array<std::string_view, 6> names{"patch", "group", "region",
                                                    "zone",  "part",  "material_index"};
    return !property.is_list() && property.type != PlyType::f32 && property.type != PlyType::f64 &&
           std::find(names.begin(), names.end(), property.name) != names.end();
}

class PlyReader {
public:
    PlyReader(FileBytes& file, SurfaceBuilder& surface) : in_{file}, surface_{surface} {
        surface_.labels.resize(1);
    }

    void run() {
        read_head();
        in_.set_binary(binary_);
        for (const Element& element : elements_) {
            read_element(element);
        }
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
        binary_ = format != "ascii";
        in_.set_swapped(format == "binary_big_endian");
        require(!binary_ || in_.swapped() || format == "binary_little_endian",
                "this PLY format is not known");
    }

    void read_property() {
        require(!elements_.empty(), "a property without an element");
        Property property;
        std::string_view type = in_.word();
        if (type == "list") {
            property.count_type = type_named(in_.word());
            require(property.is_list(), "the type of a property is not known");
            type = in_.word();
        }
        property.type = type_named(type);
        require(property.type != PlyType::none, "the type of a property is not known");
        property.name = in_.word();
        elements_.back().properties.push_back(std::move(property));
    }

    double value(PlyType type) {
        if (!binary_) {
            return in_.parsed<double>("a number");
        }
        constexpr const char* what = "a value";
        switch (type) {
        case PlyType::f32:
            return static_cast<double>(in_.raw<float>(what));
        case PlyType::f64:
            return in_.raw<double>(what);
        case PlyType::i8:
            return in_.raw<std::int8_t>(what);
        case PlyType::u8:
            return in_.raw<std::uint8_t>(what);
        case PlyType::i16:
            return in_.raw<std::int16_t>(what);
        case PlyType::u16:
            return in_.raw<std::uint16_t>(what);
        case PlyType::i32:
            return in_.raw<std::int32_t>(what);
        default:
            return in_.raw<std::uint32_t>(what);
        }
    }

    /// A count or index: a whole number below the limit.
    std::optional<std::uint64_t> whole(PlyType type, std::uint64_t limit) {
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
        for (const Property& property : element.properties) {
            require(!property.is_list(), "a vertex has a list, which is not read");
            const double number = value(property.type);
            const bool has_axis =
                property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
            if (has_axis) {
                if (!is_coordinate(number)) {
                    in_.fail(why_no_coordinate(number, fmt::format("vertex {}", surface_.points.size())));
                }
                point[static_cast<std::size_t>(property.name[0] - 'x')] = number;
                ++found;
            }
        }
        require(found == 3, "a vertex has not the properties x, y, z");
        surface_.points.push_back(point);
    }

    void read_row(const Element& element) {
        const bool is_face = element.name == "face";
        std::optional<std::int64_t> part;
        corners_.clear();
        for (const Property& property : element.properties) {
            if (is_face && property.is_list() && property.name.starts_with("vertex_ind")) {
                read_corners(property);
            } else if (is_face && !part && names_a_part(property)) {
                part = static_cast<std::int64_t>(value(property.type));
            } else {
                skip(property);
            }
        }
        if (is_face) {
            add_face(part);
        }
    }

    void skip(const Property& property) {
        std::uint64_t count = 1;
        if (property.is_list()) {
            const auto length = whole(property.count_type, in_.remaining() + 1);
            require(length.has_value(), "a list is longer than the file");
            count = *length;
        }
        for (std::uint64_t i = 0; i < count; ++i) {
            value(property.type);
        }
    }

    void read_corners(const Property& property) {
        const auto count = whole(property.count_type, in_.remaining() + 1);
        if (!count || *count < 3) {
            in_.fail(fmt::format("face {} has a number of vertices that makes no polygon", surface_.faces()));
        }
        for (std::uint64_t k = 0; k < *count; ++k) {
            const auto index = whole(property.type, surface_.points.size());
            if (!index) {
                in_.fail(fmt::format("face {} names a vertex that does not exist; there are {}",
                                     surface_.faces(), surface_.points.size()));
            }
            corners_.push_back(static_cast<Index>(*index));
        }
    }

    void add_face(const std::optional<std::int64_t>& part) {
        require(!corners_.empty(), "a face has not the property vertex_indices");
        if (part && part != part_) {
            surface_.labels[0].set(surface_.triangles(), fmt::format("{}", *part));
            part_ = part;
        }
        const PolygonFault fault = surface_.add_face(corners_);
        if (fault != PolygonFault::none) {
            in_.fail(fmt::format("face {} has {} vertices{}", surface_.faces(), corners_.size(),
                                 explained(fault)));
        }
    }

    FileCursor in_;
    SurfaceBuilder& surface_;
    std::vector<Element> elements_;
    std::vector<Index> corners_;
    std::optional<std::int64_t> part_; ///< part of the last face
    bool binary_ = false;
};

} // namespace

void read_ply(FileBytes& file, SurfaceBuilder& surface) {
    PlyReader{file, surface}.run();
}

} // namespace slabhull::io
