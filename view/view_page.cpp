// SPDX-License-Identifier: BSD-3-Clause
// The page is page.html with the style, the data, three.js and the scripts put where it names them. Data are
// base64 of numbers in the machine's byte order, which is little-endian here and in every browser, or of what
// packing.h makes of them.
#include "slabhull/view/view_page.h"

#include "slabhull/core/error.h"
#include "view/base64_writer.h"
#include "view/packing.h"
#include "view/page_parts.h"
#include "view/scene_builder.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

namespace slabhull {

namespace {

using Json = nlohmann::ordered_json;

/// JSON that a script element may hold: no end tag can be in it.
std::string as_script(const Json& json) {
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
        text.replace(at, 1, "\\u003c");
    }
    return text;
}

/// Bytes in script elements of a size that browsers read fast.
void write_bytes(io::AtomicFile& file, const char* name, std::span<const std::byte> bytes) {
    constexpr std::size_t piece = 3 << 18; // no padding but in the last
    do {
        const auto part = bytes.first(std::min(bytes.size(), piece));
        file.write(fmt::format("<script type=\"text/plain\" data-of=\"{}\">", name));
        write_base64(file, part);
        file.write("</script>\n");
        bytes = bytes.subspan(part.size());
    } while (!bytes.empty());
}

template<class T>
void write_array(io::AtomicFile& file, const char* name, const Array<T>& values) {
    write_bytes(file, name, std::as_bytes(std::span{values}));
}

void write_cells(io::AtomicFile& file, const std::string& name, const Array<Index>& vertices) {
    const PackedCells packed = pack_cells(vertices);
    write_array(file, (name + "_codes").c_str(), packed.codes);
    write_array(file, (name + "_far").c_str(), packed.far);
}

/// The times that there are, and for each vertex the number of its own: equal ones are the same number.
void write_times(io::AtomicFile& file, const Scene& scene) {
    Array<double> times = scene.times;
    std::sort(times.begin(), times.end());
    times.erase(
        std::unique(times.begin(), times.end(), [&](double a, double b) { return b - a <= scene.tolerance; }),
        times.end());
    Array<std::int64_t> number(scene.times.size());
    std::transform(scene.times.begin(), scene.times.end(), number.begin(), [&](double time) {
        return std::upper_bound(times.begin(), times.end(), time) - times.begin() - 1;
    });
    write_array(file, "times", times);
    write_array(file, "time_of_vertex", pack_differences(number));
}

/// The places of the cells' patches in the list.
void write_patches(io::AtomicFile& file, const Scene& scene, const PatchList& patches) {
    Array<std::int64_t> place(scene.side_patch.size());
    std::transform(scene.side_patch.begin(), scene.side_patch.end(), place.begin(), [&](PatchNumber number) {
        const auto at = std::lower_bound(patches.begin(), patches.end(), number,
                                         [](const Patch& patch, PatchNumber n) { return patch.number < n; });
        return at - patches.begin();
    });
    write_array(file, "side_patch", pack_runs(place));
}

/// The patches that the side has, by number, with the names that files gave.
PatchList patches_shown(const Scene& scene) {
    std::vector<PatchNumber> numbers{scene.side_patch.begin(), scene.side_patch.end()};
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    if (numbers.size() > std::numeric_limits<std::uint16_t>::max()) {
        throw InputError{fmt::format("{} patches are more than a page can colour", numbers.size())};
    }
    PatchList shown;
    for (const PatchNumber number : numbers) {
        shown.push_back({number, patch_name(scene.patches, number)});
    }
    return shown;
}

Json range_as_json(const CellRange& range) {
    return {range.begin, range.end};
}

Json slabs_as_json(const Scene& scene) {
    Json slabs = Json::array();
    for (const SceneSlab& slab : scene.slabs) {
        slabs.push_back({{"name", slab.name},
                         {"first", slab.first},
                         {"last", slab.last},
                         {"side", range_as_json(slab.side)},
                         {"inside", range_as_json(slab.inside)}});
    }
    return slabs;
}

Json head_of(const std::string& title, const Scene& scene, const PatchList& patches,
             const std::vector<std::string>& notes) {
    Json list = Json::array();
    for (const Patch& patch : patches) {
        list.push_back({{"number", patch.number}, {"name", patch.name}});
    }
    return {{"title", title},
            {"dimension", scene.dimension},
            {"filled", scene.filled},
            {"centre", scene.centre},
            {"tolerance", scene.tolerance},
            {"vertices", scene.times.size()},
            {"patches", std::move(list)},
            {"slabs", slabs_as_json(scene)},
            {"angles", scene.angles},
            {"notes", notes}};
}

void write_data(io::AtomicFile& file, const std::string& title, const Scene& scene,
                const std::vector<std::string>& notes) {
    const PatchList patches = patches_shown(scene);
    file.write("<script type=\"application/json\" id=\"data-head\">" +
               as_script(head_of(title, scene, patches, notes)) + "</script>\n");
    write_array(file, "points", scene.points);
    write_times(file, scene);
    write_array(file, "ids", pack_differences(scene.ids));
    write_array(file, "tracks", pack_differences(scene.tracks));
    write_cells(file, "side", scene.side);
    write_patches(file, scene, patches);
    write_cells(file, "inside", scene.inside);
}

} // namespace

struct ViewPage::Content {
    std::string title;
    SceneLimits limits;
    Scene data;
    std::vector<std::string> notes;
};

void require_page_library() {
    page_library();
}

ViewPage::ViewPage(std::string title, const ViewOptions& options) : content_{std::make_unique<Content>()} {
    const std::size_t slabs = std::max<std::size_t>(1, options.slabs);
    content_->title = std::move(title);
    content_->limits = {options.most_side_cells / slabs, options.most_inside_cells / slabs};
}
ViewPage::~ViewPage() = default;

template<int D>
void ViewPage::add(const std::string& name, const HullColumns<D>& hull) {
    add_slab(content_->data, name, hull, content_->limits, content_->notes);
}
template<int D>
void ViewPage::add(const std::string& name, const Filling<D>& filling) {
    add_slab(content_->data, name, filling, content_->limits, content_->notes);
}
template void ViewPage::add<2>(const std::string&, const HullColumns<2>&);
template void ViewPage::add<3>(const std::string&, const HullColumns<3>&);
template void ViewPage::add<2>(const std::string&, const Filling<2>&);
template void ViewPage::add<3>(const std::string&, const Filling<3>&);

std::size_t ViewPage::side_cells() const {
    return content_->data.side_patch.size();
}
const std::vector<std::string>& ViewPage::notes() const {
    return content_->notes;
}

void ViewPage::write(io::AtomicFile& file) const {
    const PageParts& parts = page_parts();
    std::string_view rest = parts.frame;
    const auto write_up_to = [&](std::string_view mark) {
        const std::size_t at = rest.find(mark);
        file.write(rest.substr(0, at));
        rest.remove_prefix(at + mark.size());
    };
    write_up_to("<!-- style -->");
    file.write(parts.style);
    write_up_to("<!-- data -->");
    write_data(file, content_->title, content_->data, content_->notes);
    write_up_to("<!-- library -->");
    file.write(page_library());
    write_up_to("<!-- script -->");
    file.write(parts.script);
    file.write(rest);
}

} // namespace slabhull
