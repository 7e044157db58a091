// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/report.h"

#include "cases/run/report_objects.h"

#include <nlohmann/json.hpp>

namespace slabhull {

namespace {

using Json = nlohmann::ordered_json;

Json angles_as_json(const AngleRange& angles) {
    return {{"smallest", angles.smallest}, {"largest", angles.largest}};
}

Json findings_as_json(const CheckResult& result) {
    Json findings = Json::array();
    for (const Finding& finding : result.findings) {
        Json entities = Json::array();
        for (const Entity& entity : finding.entities) {
            entities.push_back({{"kind", entity.kind}, {"number", entity.number}});
        }
        findings.push_back({{"defect", defect_name(finding.what)},
                            {"entities", std::move(entities)},
                            {"text", finding.text}});
    }
    return findings;
}

Json defects_as_json(const CheckResult& result) {
    Json defects = Json::object();
    for (std::size_t kind = 0; kind < defect_kinds; ++kind) {
        if (result.found[kind] > 0) {
            defects[std::string{defect_name(static_cast<Defect>(kind))}] = result.found[kind];
        }
    }
    return defects;
}

void add_result(Json& json, const CheckResult& result) {
    json["clean"] = result.clean();
    json["defects"] = defects_as_json(result);
    json["findings"] = findings_as_json(result);
    json["skipped"] = result.skipped;
}

} // namespace

nlohmann::ordered_json as_json(const HullReport& report) {
    Json patches = Json::object();
    for (const PatchCount& patch : report.cells_by_patch) {
        patches[std::to_string(patch.number)] = patch.cells;
    }
    const auto& regions = report.cells_by_region;
    const auto& measures = report.measure_by_region;
    Json json{
        {"kind", "hull"},
        {"dimension", report.dimension},
        {"time", report.time},
        {"counts",
         {{"vertices", report.counts.vertices},
          {"edges", report.counts.edges},
          {"facets", report.counts.facets},
          {"cells", report.counts.cells},
          {"components", report.counts.components},
          {"euler", report.counts.euler},
          {"layers", report.layers}}},
        {"cells_by_region",
         {{"initial", regions[0]}, {"intermediate", regions[1]}, {"terminating", regions[2]}}},
        {"cells_by_patch", std::move(patches)},
        {"measure",
         {{"hull", report.measure},
          {"initial", measures[0]},
          {"intermediate", measures[1]},
          {"terminating", measures[2]},
          {"enclosed", report.enclosed},
          {"closure", report.closure}}},
        {"angle", angles_as_json(report.angles)},
    };
    if (!report.betti.empty()) {
        json["betti"] = report.betti;
    }
    add_result(json, report);
    return json;
}

nlohmann::ordered_json as_json(const MeshReport& report) {
    Json json{{"kind", "mesh"},
              {"dimension", report.dimension},
              {"counts",
               {{"vertices", report.vertices},
                {"cells", report.cells},
                {"boundary_facets", report.boundary_facets},
                {"components", report.components}}},
              {"measure", report.measure},
              {"angle", angles_as_json(report.angles)}};
    add_result(json, report);
    return json;
}

nlohmann::ordered_json as_json(const FillingReport& report) {
    Json by_attribute = Json::object();
    for (const auto& [attribute, facets] : report.facets_by_attribute) {
        by_attribute[std::to_string(attribute)] = facets;
    }
    Json json{{"kind", "filling"},
              {"dimension", report.dimension},
              {"time", report.time},
              {"counts",
               {{"vertices", report.vertices},
                {"cells", report.cells},
                {"boundary_facets", report.boundary_facets}}},
              {"facets_by_attribute", by_attribute},
              {"volume", report.volume},
              {"enclosed", report.enclosed},
              {"smallest_volume", report.smallest_volume}};
    add_result(json, report);
    return json;
}

template<int D>
nlohmann::ordered_json as_json(const FillingReport& report, const Filling<D>& filling,
                               const FillingQuality& quality, double seconds) {
    return {{"cells", report.cells},
            {"points", report.vertices},
            {"steiner_points", filling.steiner_points},
            {"volume", report.volume},
            {"smallest_volume", report.smallest_volume},
            {"mean_ratio", {quality.smallest, quality.one_per_cent, quality.median}},
            {"angle", {{"smallest", quality.angles.smallest}, {"largest", quality.angles.largest}}},
            {"time_scale", quality.time_scale},
            {"seconds", seconds}};
}

template nlohmann::ordered_json as_json<2>(const FillingReport&, const Filling<2>&, const FillingQuality&,
                                           double);
template nlohmann::ordered_json as_json<3>(const FillingReport&, const Filling<3>&, const FillingQuality&,
                                           double);

nlohmann::ordered_json as_json(const SectionReport& report, const PatchList& patches) {
    Json by_patch = Json::array();
    for (const PatchMeasure& patch : report.patches) {
        by_patch.push_back({{"number", patch.number},
                            {"name", patch_name(patches, patch.number)},
                            {"facets", patch.facets},
                            {"measure", patch.measure}});
    }
    return {{"kind", "section"},
            {"dimension", report.dimension},
            {"time", report.time},
            {"counts",
             {{"vertices", report.vertices}, {"facets", report.facets}, {"components", report.components}}},
            {"measure",
             {{"boundary", report.measure}, {"enclosed", report.enclosed}, {"closure", report.closure}}},
            {"patches", std::move(by_patch)}};
}

nlohmann::ordered_json as_json(const EmbeddingSummary& summary) {
    return {{"crossings", summary.crossings},
            {"all_listed", summary.all_listed},
            {"caps_proven", summary.caps_proven},
            {"tested_cells", summary.tested_cells},
            {"stars", summary.stars},
            {"proven_stars", summary.proven_stars},
            {"group_pairs", summary.group_pairs},
            {"tested_pairs", summary.tested_pairs},
            {"exact_pairs", summary.exact_pairs}};
}

std::string report_as_json(const HullReport& report) {
    return as_json(report).dump();
}

std::string report_as_json(const MeshReport& report) {
    return as_json(report).dump();
}

std::string report_as_json(const FillingReport& report) {
    return as_json(report).dump();
}

std::string report_as_json(const SectionReport& report, const PatchList& patches) {
    return as_json(report, patches).dump();
}

std::string report_as_json(const EmbeddingSummary& summary) {
    return as_json(summary).dump();
}

} // namespace slabhull
