// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/run.h"
#include "slabhull/study/study.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace slabhull {

namespace {

using Json = nlohmann::ordered_json;

Json as_json(const CellShapes& shapes) {
    return {{"smallest_angle", shapes.angles.smallest},
            {"largest_angle", shapes.angles.largest},
            {"histogram", shapes.histogram},
            {"mean_aspect", shapes.aspect.mean},
            {"largest_aspect", shapes.aspect.largest}};
}

CellShapes shapes_from(const Json& json) {
    return {{json["smallest_angle"], json["largest_angle"]},
            json["histogram"].get<AngleHistogram>(),
            {json["mean_aspect"], json["largest_aspect"]}};
}

Json as_json(const HullCounts& counts) {
    return {{"cells", counts.cells}, {"vertices", counts.vertices}};
}

HullCounts counts_from(const Json& json) {
    return {json["cells"], json["vertices"]};
}

Json as_json(const StudyRow& row) {
    Json measures = Json::object();
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        measures[study_measures[m]] = {
            {"measured", row.measured[m]}, {"exact", row.exact[m]}, {"error", row.error(m)}};
    }
    Json seconds = Json::object();
    for (const auto& [stage, passed] : row.seconds) {
        seconds[stage] = passed;
    }
    const auto& regions = row.cells_by_region;
    return {{"case", row.experiment},
            {"level", row.level},
            {"dimension", row.dimension},
            {"split", row.split},
            {"counts", as_json(row.counts)},
            {"paper", as_json(row.paper)},
            {"cells_by_region", {{"initial", regions[0]}, {"side", regions[1]}, {"terminating", regions[2]}}},
            {"layers", row.layers},
            {"boundary_facets", row.boundary_facets},
            {"centres", row.centres},
            {"measures", std::move(measures)},
            {"closure", row.closure},
            {"side", as_json(row.side)},
            {"caps", as_json(row.caps)},
            {"seconds", std::move(seconds)},
            {"cpu_seconds", row.cpu_seconds},
            {"peak_bytes", row.peak_bytes},
            {"mesher_peak_bytes", row.mesher_peak_bytes}};
}

StudyRow row_from(const Json& json) {
    StudyRow row;
    row.experiment = json["case"];
    row.level = json["level"];
    row.dimension = json["dimension"];
    row.split = json["split"];
    row.counts = counts_from(json["counts"]);
    row.paper = counts_from(json["paper"]);
    std::size_t region = 0;
    for (const Json& cells : json["cells_by_region"]) {
        row.cells_by_region[region++] = cells;
    }
    row.layers = json["layers"];
    row.boundary_facets = json["boundary_facets"];
    row.centres = json["centres"];
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        row.measured[m] = json["measures"][study_measures[m]]["measured"];
        row.exact[m] = json["measures"][study_measures[m]]["exact"];
    }
    row.closure = json["closure"];
    row.side = shapes_from(json["side"]);
    row.caps = shapes_from(json["caps"]);
    for (const auto& [stage, passed] : json["seconds"].items()) {
        row.seconds.emplace_back(stage, passed);
    }
    row.cpu_seconds = json["cpu_seconds"];
    row.peak_bytes = json["peak_bytes"];
    row.mesher_peak_bytes = json["mesher_peak_bytes"];
    return row;
}

Json number_or_null(const std::optional<double>& number) {
    return number ? Json(*number) : Json();
}

Json rates_of(const StudySeries& series) {
    Json orders = Json::object();
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        orders[study_measures[m]] = number_or_null(order_of(series, m));
    }
    return {{"case", series.front().experiment},
            {"split", series.front().split},
            {"levels", series.size()},
            {"order", std::move(orders)},
            {"time_growth", number_or_null(time_growth(series))},
            {"memory_growth", number_or_null(memory_growth(series))}};
}

/// A table by columns: heads in the order in which the first row names them.
class CsvLine {
public:
    void add(const std::string& head, const std::string& value) {
        heads_ += separator() + head;
        values_ += (values_.empty() ? "" : ",") + value;
    }
    void add(const std::string& head, double value) { add(head, fmt::format("{:.17g}", value)); }
    void add(const std::string& head, std::size_t value) { add(head, fmt::format("{}", value)); }

    const std::string& heads() const { return heads_; }
    const std::string& values() const { return values_; }

private:
    std::string separator() const { return heads_.empty() ? "" : ","; }

    std::string heads_;
    std::string values_;
};

void add_shapes(CsvLine& line, const std::string& part, const CellShapes& shapes) {
    line.add(part + "_smallest_angle", shapes.angles.smallest);
    line.add(part + "_largest_angle", shapes.angles.largest);
    line.add(part + "_mean_aspect", shapes.aspect.mean);
    line.add(part + "_largest_aspect", shapes.aspect.largest);
}

CsvLine csv_line(const StudyRow& row) {
    CsvLine line;
    line.add("case", row.experiment);
    line.add("split", row.split);
    line.add("level", static_cast<std::size_t>(row.level));
    line.add("dimension", static_cast<std::size_t>(row.dimension));
    line.add("cells", row.counts.cells);
    line.add("paper_cells", row.paper.cells);
    line.add("vertices", row.counts.vertices);
    line.add("paper_vertices", row.paper.vertices);
    line.add("initial_cells", row.cells_by_region[0]);
    line.add("side_cells", row.cells_by_region[1]);
    line.add("terminating_cells", row.cells_by_region[2]);
    line.add("layers", row.layers);
    line.add("boundary_facets", row.boundary_facets);
    line.add("centres", row.centres);
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        const std::string name = study_measures[m];
        line.add(name + "_measure", row.measured[m]);
        line.add(name + "_exact", row.exact[m]);
        line.add(name + "_error", row.error(m));
    }
    line.add("closure", row.closure);
    add_shapes(line, "side", row.side);
    add_shapes(line, "caps", row.caps);
    line.add("seconds", row.total_seconds());
    line.add("cpu_seconds", row.cpu_seconds);
    line.add("peak_bytes", row.peak_bytes);
    line.add("mesher_peak_bytes", row.mesher_peak_bytes);
    return line;
}

} // namespace

std::string row_as_text(const StudyRow& row) {
    return as_json(row).dump();
}

StudyRow row_from_text(const std::string& text) {
    return row_from(Json::parse(text));
}

std::string study_csv(const std::vector<StudyRow>& rows) {
    std::string text;
    for (const StudyRow& row : rows) {
        const CsvLine line = csv_line(row);
        text += text.empty() ? line.heads() + "\n" : "";
        text += line.values() + "\n";
    }
    return text;
}

std::string study_json(const std::vector<StudyRow>& rows) {
    Json json{{"kind", "study"}, {"slabhull", version()}, {"rates", Json::array()}, {"rows", Json::array()}};
    for (const StudySeries& series : series_of(rows)) {
        json["rates"].push_back(rates_of(series));
    }
    for (const StudyRow& row : rows) {
        json["rows"].push_back(as_json(row));
    }
    return json.dump(2) + "\n";
}

} // namespace slabhull
