// SPDX-License-Identifier: BSD-3-Clause
#include "study/study_plots.h"

#include "slabhull/cases/run.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

namespace {

constexpr const char* page_style = R"(<style>
:root{color-scheme:light dark}
body{margin:0;font:15px/1.5 system-ui,sans-serif;background:#fff;color:#1c2128}
main{max-width:88rem;margin:0 auto;padding:1.5rem}
h2{margin-top:3rem;border-bottom:1px solid #b9c0c8}
.wide{overflow-x:auto}
table{border-collapse:collapse;margin:1rem 0;font-variant-numeric:tabular-nums}
caption{text-align:left;font-weight:600;padding:.3rem 0}
th,td{padding:.2rem .7rem;text-align:right;white-space:nowrap;border-bottom:1px solid #d5dae0}
thead th{white-space:normal;vertical-align:bottom}
th:first-child,td:first-child{text-align:left}
tfoot td,tfoot th{border-top:2px solid #8a939d;font-weight:600}
figure{display:inline-block;margin:.5rem .5rem .5rem 0;max-width:100%}
figure svg{max-width:100%;height:auto;border:1px solid #d5dae0}
@media (prefers-color-scheme:dark){body{background:#14181d;color:#e6e9ed}h2,th,td,figure svg{border-color:#3a414b}a{color:#5cb8f0}}
</style>)";

using Cells = std::vector<std::string>;

struct Table {
    std::string caption;
    Cells heads;
    std::vector<Cells> rows;
    std::vector<Cells> foot;
};

std::string line_of(const Cells& cells, bool head) {
    std::string line = "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const bool title = head || i == 0;
        line += fmt::format("<{0}{1}>{2}</{0}>", title ? "th" : "td",
                            !title ? ""
                            : head ? " scope=\"col\""
                                   : " scope=\"row\"",
                            escaped(cells[i]));
    }
    return line + "</tr>\n";
}

std::string html_of(const Table& table) {
    std::string html =
        fmt::format("<div class=\"wide\"><table>\n<caption>{}</caption>\n<thead>{}</thead>\n<tbody>\n",
                    escaped(table.caption), line_of(table.heads, true));
    for (const Cells& row : table.rows) {
        html += line_of(row, false);
    }
    html += "</tbody>\n";
    if (!table.foot.empty()) {
        html += "<tfoot>\n";
        for (const Cells& row : table.foot) {
            html += line_of(row, false);
        }
        html += "</tfoot>\n";
    }
    return html + "</table></div>\n";
}

/// Digits in groups of three.
std::string grouped(std::size_t number) {
    std::string text = std::to_string(number);
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) {
        text.insert(static_cast<std::size_t>(at), ",");
    }
    return text;
}

std::string ratio(std::size_t ours, std::size_t paper) {
    return fmt::format("{:.3f}", static_cast<double>(ours) / static_cast<double>(paper));
}

std::string optional_number(const std::optional<double>& number) {
    return number ? fmt::format("{:.2f}", *number) : "–";
}

double per_cell(double amount, const StudyRow& row) {
    return amount / static_cast<double>(row.counts.cells);
}

std::string heading_of(const StudySeries& series) {
    return fmt::format("{}, split {}", series.front().experiment, series.front().split);
}

Table counts_table(const StudySeries& series) {
    Table table{"Counts, the paper's beside ours",
                {"level", "layers", "boundary facets", "simplices", "the paper's", "ratio", "vertices",
                 "the paper's", "ratio", "in the side"},
                {},
                {}};
    for (const StudyRow& row : series) {
        const double side =
            static_cast<double>(row.cells_by_region[1]) / static_cast<double>(row.counts.cells);
        table.rows.push_back({std::to_string(row.level), grouped(row.layers), grouped(row.boundary_facets),
                              grouped(row.counts.cells), grouped(row.paper.cells),
                              ratio(row.counts.cells, row.paper.cells), grouped(row.counts.vertices),
                              grouped(row.paper.vertices), ratio(row.counts.vertices, row.paper.vertices),
                              fmt::format("{:.1f} %", 100 * side)});
    }
    return table;
}

Table errors_table(const StudySeries& series) {
    Table table{"Relative errors against the exact measures, and their order in N^(-1/D) by least squares",
                {"level", "simplices"},
                {},
                {}};
    Cells orders{"order", ""};
    for (std::size_t m = 0; m < study_measures.size(); ++m) {
        table.heads.emplace_back(study_measures[m]);
        orders.push_back(optional_number(order_of(series, m)));
    }
    for (const StudyRow& row : series) {
        Cells cells{std::to_string(row.level), grouped(row.counts.cells)};
        for (std::size_t m = 0; m < study_measures.size(); ++m) {
            cells.push_back(fmt::format("{:+.3e}", row.error(m)));
        }
        table.rows.push_back(std::move(cells));
    }
    table.foot.push_back(std::move(orders));
    return table;
}

Table time_table(const StudySeries& series) {
    Table table{"Seconds of wall time by stage; CPU time and peak memory of each level's own process",
                {"level", "simplices"},
                {},
                {}};
    for (const auto& [stage, passed] : series.back().seconds) {
        table.heads.push_back(stage);
    }
    const std::size_t stages = table.heads.size() - 2;
    for (const char* head : {"all", "CPU", "simplices per CPU second", "peak MB", "bytes per simplex"}) {
        table.heads.emplace_back(head);
    }
    for (const StudyRow& row : series) {
        Cells cells{std::to_string(row.level), grouped(row.counts.cells)};
        for (const auto& [stage, passed] : row.seconds) {
            cells.push_back(fmt::format("{:.3f}", passed));
        }
        cells.push_back(fmt::format("{:.2f}", row.total_seconds()));
        cells.push_back(fmt::format("{:.2f}", row.cpu_seconds));
        cells.push_back(grouped(static_cast<std::size_t>(1 / per_cell(row.cpu_seconds, row))));
        cells.push_back(fmt::format("{:.1f}", 1e-6 * static_cast<double>(row.peak())));
        cells.push_back(fmt::format("{:.0f}", per_cell(static_cast<double>(row.peak()), row)));
        table.rows.push_back(std::move(cells));
    }
    Cells growth{"growth: ~ N^p", ""};
    growth.resize(growth.size() + stages + 1);
    growth.push_back(optional_number(time_growth(series)));
    growth.emplace_back();
    growth.push_back(optional_number(memory_growth(series)));
    growth.emplace_back();
    table.foot.push_back(std::move(growth));
    return table;
}

Cells shape_cells(const CellShapes& shapes) {
    return {fmt::format("{:.1f}", shapes.angles.smallest), fmt::format("{:.1f}", shapes.angles.largest),
            fmt::format("{:.2f}", shapes.aspect.mean), fmt::format("{:.1f}", shapes.aspect.largest)};
}

void append(Cells& cells, const Cells& more) {
    cells.insert(cells.end(), more.begin(), more.end());
}

Table quality_table(const StudySeries& series) {
    Table table{
        "Shapes in space-time: smallest and largest dihedral angle in degrees, mean and largest aspect ratio "
        "(1 for the regular simplex)",
        {"level"},
        {},
        {}};
    for (const char* part : {"side: ", "caps: "}) {
        for (const char* what : {"smallest angle", "largest angle", "mean aspect", "largest aspect"}) {
            table.heads.push_back(std::string{part} + what);
        }
    }
    for (const StudyRow& row : series) {
        Cells cells{std::to_string(row.level)};
        append(cells, shape_cells(row.side));
        append(cells, shape_cells(row.caps));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table splits_table(const std::vector<StudyRow>& rows) {
    Table table{fmt::format("Splits side by side: {}, level {}", rows.front().experiment, rows.front().level),
                {"split", "simplices per prism", "simplices", "vertices", "centres", "smallest angle",
                 "largest angle", "mean aspect", "largest aspect", "error of the side", "error of the hull",
                 "error enclosed", "CPU s", "peak MB"},
                {},
                {}};
    for (const StudyRow& row : rows) {
        const std::size_t prisms = row.boundary_facets * row.layers;
        Cells cells{row.split, std::to_string(row.cells_by_region[1] / prisms), grouped(row.counts.cells),
                    grouped(row.counts.vertices), grouped(row.centres)};
        append(cells, shape_cells(row.side));
        for (const std::size_t m : {2, 0, 4}) {
            cells.push_back(fmt::format("{:+.3e}", row.error(m)));
        }
        cells.push_back(fmt::format("{:.2f}", row.cpu_seconds));
        cells.push_back(fmt::format("{:.1f}", 1e-6 * static_cast<double>(row.peak())));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table overview_table(const std::vector<StudySeries>& all) {
    Table table{"Orders of the errors, and growth of time and memory, by case",
                {"case", "split", "levels", "largest hull"},
                {},
                {}};
    for (const char* measure : study_measures) {
        table.heads.push_back(std::string{"order: "} + measure);
    }
    table.heads.emplace_back("CPU time ~ N^p");
    table.heads.emplace_back("memory ~ N^p");
    for (const StudySeries& series : all) {
        const StudyRow& last = series.back();
        Cells cells{last.experiment, last.split, fmt::format("{}–{}", series.front().level, last.level),
                    grouped(last.counts.cells)};
        for (std::size_t m = 0; m < study_measures.size(); ++m) {
            cells.push_back(optional_number(order_of(series, m)));
        }
        cells.push_back(optional_number(time_growth(series)));
        cells.push_back(optional_number(memory_growth(series)));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

std::string html_of(const Plot& plot) {
    return "<figure>" + svg_of(plot) + "</figure>\n";
}

/// The series of one experiment that differ in their splits; none where there is only one.
std::vector<StudySeries> rivals_of(const std::vector<StudySeries>& all, const std::string& experiment) {
    std::vector<StudySeries> rivals;
    std::copy_if(
        all.begin(), all.end(), std::back_inserter(rivals),
        [&experiment](const StudySeries& series) { return series.front().experiment == experiment; });
    return rivals.size() > 1 ? rivals : std::vector<StudySeries>{};
}

/// The row of each series at the finest level that all have.
std::vector<StudyRow> same_level(const std::vector<StudySeries>& rivals) {
    int level = rivals.front().back().level;
    for (const StudySeries& series : rivals) {
        level = std::min(level, series.back().level);
    }
    std::vector<StudyRow> rows;
    for (const StudySeries& series : rivals) {
        std::copy_if(series.begin(), series.end(), std::back_inserter(rows),
                     [level](const StudyRow& row) { return row.level == level; });
    }
    return rows;
}

/// The plot where there are several levels to plot over.
std::string where_several(const StudySeries& series, const Plot& plot) {
    return series.size() > 1 ? html_of(plot) : "";
}

std::string splits_section(const std::vector<StudySeries>& rivals) {
    const std::vector<StudyRow> rows = same_level(rivals);
    const std::string& name = rows.front().experiment;
    return fmt::format("<section><h2>{}: splits side by side</h2>\n", escaped(name)) +
           html_of(splits_table(rows)) + html_of(plot_of_split_angles(rows)) +
           where_several(rivals.front(), plot_of_measure(rivals, 2, "Error of the side by split: " + name)) +
           "</section>\n";
}

std::string section_of(const StudySeries& series) {
    return fmt::format("<section><h2>{}</h2>\n", escaped(heading_of(series))) +
           html_of(counts_table(series)) + html_of(errors_table(series)) +
           where_several(series, plot_of_errors(series)) + html_of(plot_of_angles(series.back())) +
           html_of(time_table(series)) + where_several(series, plot_of_seconds(series)) +
           where_several(series, plot_of_memory(series)) + html_of(quality_table(series)) + "</section>\n";
}

/// Only the first split of each experiment.
std::vector<StudySeries> one_each(const std::vector<StudySeries>& all) {
    std::vector<StudySeries> firsts;
    for (const StudySeries& series : all) {
        const bool fresh = std::none_of(firsts.begin(), firsts.end(), [&series](const StudySeries& known) {
            return known.front().experiment == series.front().experiment;
        });
        if (fresh) {
            firsts.push_back(series);
        }
    }
    return firsts;
}

std::string overview(const std::vector<StudySeries>& all) {
    std::string html = html_of(overview_table(all));
    const std::vector<StudySeries> firsts = one_each(all);
    if (firsts.size() > 1) {
        html += html_of(plot_of_measure(firsts, 0, "Error of the hull's measure by case"));
    }
    return html;
}

} // namespace

std::string study_page(const std::vector<StudyRow>& rows) {
    const std::vector<StudySeries> all = series_of(rows);
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\"><head>"
                       "<meta charset=\"utf-8\"/><meta name=\"viewport\" content=\"width=device-width\"/>"
                       "<title>Slabhull study</title>\n";
    html += page_style;
    html += fmt::format(
        "</head><body><main><h1>Slabhull study</h1>\n<p>{} hulls of the experiments of Anderson, "
        "Williams and Corrigan, each built, checked without a finding and measured by slabhull {}. The "
        "same numbers are in study.csv and study.json.</p>\n",
        rows.size(), version());
    html += overview(all);
    for (const StudySeries& series : one_each(all)) {
        if (const auto rivals = rivals_of(all, series.front().experiment); !rivals.empty()) {
            html += splits_section(rivals);
        }
    }
    for (const StudySeries& series : all) {
        html += section_of(series);
    }
    return html + "</main></body></html>\n";
}

std::vector<StudyFigure> study_figures(const std::vector<StudyRow>& rows) {
    const std::vector<StudySeries> all = series_of(rows);
    std::vector<StudyFigure> figures;
    for (const StudySeries& series : all) {
        const std::string tail = fmt::format("{}-{}", series.front().experiment, series.front().split);
        figures.push_back({"errors-" + tail, svg_of(plot_of_errors(series))});
        figures.push_back({"time-" + tail, svg_of(plot_of_seconds(series))});
        figures.push_back({"memory-" + tail, svg_of(plot_of_memory(series))});
        figures.push_back({"angles-" + tail, svg_of(plot_of_angles(series.back()))});
    }
    for (const StudySeries& series : one_each(all)) {
        const std::string& name = series.front().experiment;
        if (const auto rivals = rivals_of(all, name); !rivals.empty()) {
            figures.push_back({"split-angles-" + name, svg_of(plot_of_split_angles(same_level(rivals)))});
        }
    }
    return figures;
}

} // namespace slabhull
