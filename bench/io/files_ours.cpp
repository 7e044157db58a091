// SPDX-License-Identifier: BSD-3-Clause
#include "file_peers.h"
#include "hull_columns.h"
#include "slabhull/io/files.h"

#include <memory>

namespace slabhull::bench {

namespace {

Run writing_vtu(const HullSoup& soup) {
    return [mesh = hull_columns(soup)](const std::string& file) {
        io::write_vtu(file, mesh);
        return Outcome{};
    };
}

Run writing_msh(const HullSoup& soup) {
    return [mesh = mesh_columns(soup)](const std::string& file) {
        io::write_msh(file, mesh);
        return Outcome{};
    };
}

Run writing_text(const HullSoup& soup) {
    return [mesh = mesh_columns(soup)](const std::string& file) {
        io::write_msh(file, mesh, {io::MshVersion::v4_1, true});
        return Outcome{};
    };
}

Run reading_vtu(const HullSoup& soup) {
    return [soup](const std::string& file) {
        const auto found = std::make_shared<io::Soup>(io::read_vtu(file));
        return Outcome{[soup, found] { return is_hull(*found, soup); }};
    };
}

Run reading_within(const HullSoup& soup, double tolerance) {
    return [soup, tolerance](const std::string& file) {
        const auto found = std::make_shared<io::Soup>(io::read_msh(file));
        return Outcome{[soup, tolerance, found] { return is_mesh(*found, soup, tolerance); }};
    };
}

Run reading_msh(const HullSoup& soup) {
    return reading_within(soup, tolerance_of("read_msh"));
}

Run reading_text(const HullSoup& soup) {
    return reading_within(soup, tolerance_of("read_msh_ascii"));
}

const bool added =
    add_contestant({"write_vtu", "ours", writing_vtu}) && add_contestant({"read_vtu", "ours", reading_vtu}) &&
    add_contestant({"write_msh", "ours", writing_msh}) && add_contestant({"read_msh", "ours", reading_msh}) &&
    add_contestant({"write_msh_ascii", "ours", writing_text}) &&
    add_contestant({"read_msh_ascii", "ours", reading_text});

} // namespace

} // namespace slabhull::bench
