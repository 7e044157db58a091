// SPDX-License-Identifier: BSD-3-Clause
// Points and tetrahedra in three groups: what gmsh::write() writes of a mesh. Data would be views, which Gmsh
// keeps apart.
#include "file_peers.h"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace slabhull::bench {

namespace {

/// Gmsh has one model for all of a process.
class Session {
public:
    Session() {
        gmsh::initialize();
        gmsh::option::setNumber("General.Terminal", 0);
        gmsh::option::setNumber("Mesh.MshFileVersion", 4.1);
    }
    ~Session() { gmsh::finalize(); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
};

constexpr int tetrahedron = 4;

void add_nodes(const HullSoup& soup) {
    std::vector<std::size_t> tags(soup.point_count());
    std::vector<double> coordinates;
    coordinates.reserve(3 * soup.point_count());
    for (std::size_t v = 0; v < soup.point_count(); ++v) {
        tags[v] = v + 1;
        const auto x = soup.point(v);
        coordinates.insert(coordinates.end(), x.begin(), x.end());
    }
    gmsh::model::mesh::addNodes(3, 1, tags, coordinates);
}

void add_cells(const HullSoup& soup, int entity, std::size_t begin, std::size_t end) {
    std::vector<std::size_t> tags;
    std::vector<std::size_t> nodes;
    tags.reserve(end - begin);
    nodes.reserve(4 * (end - begin));
    for (std::size_t c = begin; c < end; ++c) {
        tags.push_back(c + 1);
        for (const std::int64_t v : soup.vertices(c)) {
            nodes.push_back(static_cast<std::size_t>(v) + 1);
        }
    }
    gmsh::model::mesh::addElementsByType(entity, tetrahedron, tags, nodes);
}

std::shared_ptr<Session> model_of(const HullSoup& soup) {
    auto session = std::make_shared<Session>();
    gmsh::model::add("soup");
    for (int region = 0; region < 3; ++region) {
        gmsh::model::addDiscreteEntity(3, region + 1);
        gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {region + 1}),
                                     "group " + std::to_string(region + 1));
    }
    add_nodes(soup);
    const auto begins = soup.begins();
    for (std::size_t region = 0; region < 3; ++region) {
        add_cells(soup, static_cast<int>(region) + 1, begins[region], begins[region + 1]);
    }
    return session;
}

template<int binary>
Run writing(const HullSoup& soup) {
    return [session = model_of(soup)](const std::string& file) {
        gmsh::option::setNumber("Mesh.Binary", binary);
        gmsh::write(file);
        return Outcome{};
    };
}

bool nodes_are(const HullSoup& soup, double tolerance) {
    const auto close = [=](double a, double b) { return std::abs(a - b) <= tolerance * std::abs(b); };
    std::vector<std::size_t> tags;
    std::vector<double> coordinates;
    std::vector<double> parameters;
    gmsh::model::mesh::getNodes(tags, coordinates, parameters);
    bool right = tags.size() == soup.point_count();
    for (std::size_t i = 0; right && i < tags.size(); ++i) {
        const auto x = soup.point(tags[i] - 1);
        right =
            std::equal(x.begin(), x.end(), coordinates.begin() + static_cast<std::ptrdiff_t>(3 * i), close);
    }
    return right;
}

bool cells_are(const HullSoup& soup) {
    std::vector<std::size_t> tags;
    std::vector<std::size_t> nodes;
    gmsh::model::mesh::getElementsByType(tetrahedron, tags, nodes);
    bool right = tags.size() == soup.cell_count();
    for (std::size_t i = 0; right && i < tags.size(); ++i) {
        const auto vertices = soup.vertices(tags[i] - 1);
        right = std::equal(
            vertices.begin(), vertices.end(), nodes.begin() + static_cast<std::ptrdiff_t>(4 * i),
            [](std::int64_t v, std::size_t node) { return static_cast<std::size_t>(v) + 1 == node; });
    }
    return right;
}

Run reading_within(const HullSoup& soup, double tolerance) {
    return [soup, tolerance, session = std::make_shared<Session>()](const std::string& file) {
        gmsh::open(file);
        return Outcome{[soup, tolerance, session] {
            const bool right = nodes_are(soup, tolerance) && cells_are(soup);
            gmsh::clear();
            return right;
        }};
    };
}

Run reading(const HullSoup& soup) {
    return reading_within(soup, tolerance_of("read_msh"));
}

Run reading_text(const HullSoup& soup) {
    return reading_within(soup, tolerance_of("read_msh_ascii"));
}

const bool added = add_contestant({"write_msh", "gmsh", writing<1>}) &&
                   add_contestant({"read_msh", "gmsh", reading}) &&
                   add_contestant({"write_msh_ascii", "gmsh", writing<0>}) &&
                   add_contestant({"read_msh_ascii", "gmsh", reading_text});

} // namespace

} // namespace slabhull::bench
