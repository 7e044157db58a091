// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "fillings.h"
#include "mesh_formats.h"
#include "slabhull/edit/soup_info.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace slabhull::tools {

namespace {

using Json = nlohmann::ordered_json;

struct InfoCommand {
    std::string file;
    std::string from;
    bool json = false;
};

constexpr std::size_t values_shown = 8;
constexpr int bin_width = 180 / static_cast<int>(angle_bins);

/// An array as the file has it.
struct ArrayInfo {
    std::string name;
    std::string type;
    int components;
    Json values; ///< of field data, a list
};

ArrayInfo info_of(const io::DataArray& array, bool with_values) {
    constexpr std::array<const char*, 3> types{"real", "integer", "text"};
    ArrayInfo info{array.name, types.at(array.values.index()), array.components, Json::array()};
    if (with_values) {
        std::visit(
            [&info](const auto& values) {
                for (const auto& value : values) {
                    info.values.push_back(value);
                }
            },
            array.values);
    }
    return info;
}

struct Arrays {
    const char* name;
    std::vector<ArrayInfo> arrays;
};

std::vector<Arrays> arrays_of(const io::Soup& soup) {
    std::vector<Arrays> all{{"point", {}}, {"cell", {}}, {"field", {}}};
    const std::array sources{&soup.point_data, &soup.cell_data, &soup.field_data};
    for (std::size_t k = 0; k < sources.size(); ++k) {
        for (const io::DataArray& array : *sources[k]) {
            all[k].arrays.push_back(info_of(array, k == 2));
        }
    }
    return all;
}

// --- for people

std::string described(const ArrayInfo& array) {
    if (array.values.empty()) {
        return array.components == 1 ? fmt::format("{} ({})", array.name, array.type)
                                     : fmt::format("{} ({} {})", array.name, array.components, array.type);
    }
    std::vector<std::string> words;
    for (const Json& value : array.values) {
        words.push_back(value.is_string() ? value.get<std::string>() : value.dump());
    }
    const bool all = words.size() <= values_shown;
    words.resize(std::min(words.size(), values_shown));
    return fmt::format("{} = {}{}", array.name, fmt::join(words, ", "), all ? "" : ", ...");
}

void print_arrays(const std::vector<Arrays>& all) {
    for (const auto& [name, arrays] : all) {
        std::vector<std::string> words;
        std::transform(arrays.begin(), arrays.end(), std::back_inserter(words), described);
        if (!words.empty()) {
            fmt::print("  {} data: {}\n", name, fmt::join(words, "; "));
        }
    }
}

void print_counts(const SoupInfo& info) {
    fmt::print("  {} points", info.points);
    for (int d = 3; d >= 0; --d) {
        if (const std::size_t count = info.simplices[static_cast<std::size_t>(d)]; count > 0) {
            fmt::print(", {} {}", count, simplices_called(d));
        }
    }
    fmt::print("\n");
    for (std::size_t k = 0; k < info.bounds.size(); ++k) {
        const auto& [axis, smallest, largest] = info.bounds[k];
        fmt::print("{}{} from {:.10g} to {:.10g}{}", k == 0 ? "  " : ", ", axis, smallest, largest,
                   k + 1 == info.bounds.size() ? "\n" : "");
    }
}

void print_parts(const SoupInfo& info) {
    fmt::print("  measure {:.10g}\n", info.measure);
    for (const SoupInfo::Region& region : info.regions) {
        fmt::print("  region {}: {} {}, measure {:.10g}\n", region.name, region.cells,
                   simplices_called(info.dimension), region.measure);
    }
    for (const SoupInfo::Group& group : info.groups) {
        fmt::print("  group {} \"{}\": {} {}, measure {:.10g}\n", group.patch.number, group.patch.name,
                   group.cells, simplices_called(group.dimension), group.measure);
    }
}

void print_angles(const SoupInfo& info) {
    const std::size_t most = *std::max_element(info.angles.begin(), info.angles.end());
    if (most == 0) {
        return;
    }
    constexpr std::size_t longest = 50;
    fmt::print("  {} {:.1f} to {:.1f} degrees\n", info.dimension == 3 ? "dihedral angles" : "angles",
               info.angle.smallest, info.angle.largest);
    for (std::size_t k = 0; k < info.angles.size(); ++k) {
        const int from = static_cast<int>(k) * bin_width;
        const std::string bar((info.angles[k] * longest + most - 1) / most, '#');
        fmt::print("  {:>5} - {:<3} {:>10} {}\n", from, from + bin_width, info.angles[k], bar);
    }
}

void print_text(const InfoCommand& command, const io::Format& format, const SoupInfo& info,
                const std::vector<Arrays>& arrays) {
    fmt::print("{}: {}, {}\n", command.file, format.title,
               info.hull ? fmt::format("hull of a slab in {}D+t", info.dimension)
                         : fmt::format("mesh of dimension {}", info.dimension));
    print_counts(info);
    print_arrays(arrays);
    print_parts(info);
    print_angles(info);
}

// --- for programs

Json as_json(const std::vector<Arrays>& all) {
    Json json = Json::object();
    for (const auto& [name, arrays] : all) {
        Json list = Json::array();
        for (const ArrayInfo& array : arrays) {
            list.push_back({{"name", array.name}, {"type", array.type}, {"components", array.components}});
            if (!array.values.empty()) {
                list.back()["values"] = array.values;
            }
        }
        json[name] = std::move(list);
    }
    return json;
}

Json bounds_as_json(const SoupInfo& info) {
    Json json = Json::object();
    for (const auto& [axis, smallest, largest] : info.bounds) {
        json[std::string(1, axis)] = {smallest, largest};
    }
    return json;
}

Json parts_as_json(const SoupInfo& info) {
    Json regions = Json::object();
    for (const SoupInfo::Region& region : info.regions) {
        regions[region.name] = {{"cells", region.cells}, {"measure", region.measure}};
    }
    Json groups = Json::array();
    for (const SoupInfo::Group& group : info.groups) {
        groups.push_back({{"dimension", group.dimension},
                          {"number", group.patch.number},
                          {"name", group.patch.name},
                          {"cells", group.cells},
                          {"measure", group.measure}});
    }
    return {{"regions", std::move(regions)}, {"groups", std::move(groups)}};
}

void print_json(const InfoCommand& command, const io::Format& format, const SoupInfo& info,
                const std::vector<Arrays>& arrays) {
    Json counts{{"points", info.points}};
    for (int d = 0; d <= 3; ++d) {
        counts[simplices_called(d)] = info.simplices[static_cast<std::size_t>(d)];
    }
    Json json{
        {"file", command.file},        {"format", format.name},       {"kind", info.hull ? "hull" : "mesh"},
        {"dimension", info.dimension}, {"counts", std::move(counts)}, {"bounds", bounds_as_json(info)},
        {"arrays", as_json(arrays)},   {"measure", info.measure}};
    json.update(parts_as_json(info));
    if (info.dimension >= 2) {
        json["angle"] = {
            {"smallest", info.angle.smallest}, {"largest", info.angle.largest}, {"histogram", info.angles}};
    }
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

int info(const InfoCommand& command) {
    if (command.from.empty() && tell_filling(command.file, command.json)) {
        return 0;
    }
    const io::Format& format = format_to_read(command.file, command.from);
    io::Soup soup = io::read_as(format, command.file);
    print_remarks(soup);
    const std::vector<Arrays> arrays = arrays_of(soup);
    const SoupInfo seen = soup_info(std::move(soup));
    command.json ? print_json(command, format, seen, arrays) : print_text(command, format, seen, arrays);
    return 0;
}

} // namespace

void add_info(CLI::App& program, int& exit_code) {
    auto command = std::make_shared<InfoCommand>();
    CLI::App* app = program.add_subcommand("info", "Tell what is in a mesh or hull");
    app->add_option("FILE", command->file, "The mesh to read")->required();
    app->add_option("--from", command->from, "Format of FILE, whatever its extension");
    app->add_flag("--json", command->json, "One JSON document on stdout");
    app->footer(formats_help() + "Example: slabhull info out/room/slab_0000.vtu");
    app->callback([command, &exit_code] { exit_code = info(*command); });
}

} // namespace slabhull::tools
