// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/findings.h"

#include <fmt/format.h>

#include <iterator>
#include <numeric>

namespace slabhull {

namespace {

/// Most entities that a finding names: more do not help, and the star of an apex may have millions.
constexpr std::size_t most_names = 16;

constexpr std::array<std::string_view, defect_kinds> defect_names{
    "no-cells",
    "column-length",
    "index-out-of-range",
    "non-finite-coordinate",
    "repeated-vertex",
    "duplicate-cell",
    "unused-vertex",
    "open-facet",
    "overfull-facet",
    "disoriented-facet",
    "singular-edge",
    "singular-vertex",
    "euler-mismatch",
    "coincident-vertices",
    "degenerate-cell",
    "not-closed",
    "inward-orientation",
    "inverted-cell",
    "self-crossing",
    "no-duration",
    "wrong-slab-time",
    "time-outside-slab",
    "missing-cap",
    "cap-not-flat",
    "wrong-region",
    "flat-side-cell",
    "untracked-boundary",
    "stray-track",
    "track-repeats-time",
    "track-incomplete",
    "boundary-facet-lost",
    "boundary-facet-added",
    "boundary-facet-reversed",
    "negative-vertex-id",
    "duplicate-vertex-id",
    "wrong-patch",
    "unknown-patch",
    "patch-mismatch",
    "wrong-layer",
    "layer-gap",
    "wrong-neighbor",
    "wrong-vertex-cell",
    "folded-facet",
    "singular-boundary-ridge",
    "singular-boundary-vertex",
    "hull-facet-lost",
    "hull-facet-added",
    "hull-facet-reversed",
    "hull-vertex-moved",
    "wrong-attribute",
    "volume-mismatch",
};

std::string list(std::span<const Entity> entities) {
    std::string text;
    for (const Entity& entity : entities) {
        text += fmt::format("{}{}", text.empty() ? "" : ", ", entity.number);
    }
    return entities.size() == most_names ? text + ", ..." : text;
}

std::string simplex_name(std::span<const Entity> vertices) {
    if (vertices.size() == 1) {
        return fmt::format("vertex {}", vertices[0].number);
    }
    return fmt::format("{} ({})", vertices.size() == 2 ? "edge" : "facet", list(vertices));
}

} // namespace

std::string_view defect_name(Defect what) {
    return defect_names[static_cast<std::size_t>(what)];
}

std::size_t CheckResult::total() const {
    return std::accumulate(found.begin(), found.end(), std::size_t{0});
}

bool Findings::keep(Defect what) {
    return result_.found[static_cast<std::size_t>(what)]++ < options_.most_findings;
}

std::vector<Entity> Findings::name(const char* kind, std::span<const Index> numbers) const {
    const auto& number = kind == std::string_view{"cell"} ? options_.cell_number : options_.vertex_number;
    std::vector<Entity> entities;
    for (const Index k : numbers.first(std::min(numbers.size(), most_names))) {
        entities.push_back({kind, number ? number(k) : std::int64_t{k}, {}});
    }
    return entities;
}

void Findings::vertices(Defect what, std::span<const Index> vertices, std::span<const Index> cells,
                        const std::string& detail) {
    if (!keep(what)) {
        return;
    }
    std::vector<Entity> entities = name("vertex", vertices);
    std::string text = fmt::format("{}: {}", simplex_name(entities), detail);
    const std::vector<Entity> in = name("cell", cells);
    if (!in.empty()) {
        text += fmt::format(" ({} {})", in.size() == 1 ? "cell" : "cells", list(in));
    }
    entities.insert(entities.end(), in.begin(), in.end());
    result_.findings.push_back({what, std::move(entities), std::move(text)});
}

void Findings::cells(Defect what, std::span<const Index> cells, const std::string& detail) {
    if (!keep(what)) {
        return;
    }
    std::vector<Entity> entities = name("cell", cells);
    std::string text = fmt::format("cell {}: {}", entities[0].number, detail);
    if (entities.size() > 1) {
        text += fmt::format(" ({})", list(std::span{entities}.subspan(1)));
    }
    result_.findings.push_back({what, std::move(entities), std::move(text)});
}

void Findings::other(Defect what, std::vector<Entity> entities, const std::string& text) {
    if (keep(what)) {
        result_.findings.push_back({what, std::move(entities), text});
    }
}

void Findings::skip(const std::string& check, const std::string& reason) {
    result_.skipped.push_back(fmt::format("{}: {}", check, reason));
}

std::string findings_as_text(const CheckResult& result) {
    std::string text;
    std::array<std::size_t, defect_kinds> shown{};
    for (const Finding& finding : result.findings) {
        text += fmt::format("  {}: {}\n", defect_name(finding.what), finding.text);
        ++shown[static_cast<std::size_t>(finding.what)];
    }
    for (std::size_t kind = 0; kind < defect_kinds; ++kind) {
        if (shown[kind] < result.found[kind]) {
            text += fmt::format("  {}: {} more\n", defect_name(static_cast<Defect>(kind)),
                                result.found[kind] - shown[kind]);
        }
    }
    for (const std::string& reason : result.skipped) {
        text += fmt::format("  not checked: {}\n", reason);
    }
    return text;
}

} // namespace slabhull
