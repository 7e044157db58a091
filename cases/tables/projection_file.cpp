// SPDX-License-Identifier: BSD-3-Clause
#include "cases/tables/projection_file.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/cad_surface.h"
#include "slabhull/geometry/facet_surface.h"
#include "slabhull/io/files.h"

#include "cases/run/mesh_soup.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace slabhull {

namespace {

std::string lower_case_ending(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return ending;
}

std::optional<CadFormat> cad_format(const std::filesystem::path& path) {
    const std::string ending = lower_case_ending(path);
    if (ending == ".step" || ending == ".stp") {
        return CadFormat::step;
    }
    if (ending == ".brep" || ending == ".brp") {
        return CadFormat::brep;
    }
    return std::nullopt;
}

ProjectionSurfacePointer<3> read_cad(const std::filesystem::path& path, CadFormat format) {
    std::ifstream in{path, std::ios::binary};
    if (!in) {
        throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
    }
    return cad_surface(in, format, path.string());
}

/// An STL holds coordinates in single precision: two of them that should meet may miss each other by this.
template<int D>
double rounding_of_format(const std::filesystem::path& path, const Surface<D>& surface) {
    double largest = 0;
    for (const Point<D>& point : surface.points) {
        for (const double coordinate : point) {
            largest = std::max(largest, std::abs(coordinate));
        }
    }
    return lower_case_ending(path) == ".stl" ? std::numeric_limits<float>::epsilon() * largest : 0;
}

} // namespace

template<int D>
ProjectionSurfacePointer<D> surface_from_file(const std::filesystem::path& path,
                                              std::vector<std::string>& remarks) {
    if constexpr (D == 3) {
        if (const auto format = cad_format(path)) {
            return read_cad(path, *format);
        }
    }
    const io::Soup soup = D == 3 ? io::read_surface(path) : io::read_curve(path);
    remarks.insert(remarks.end(), soup.remarks.begin(), soup.remarks.end());
    const Surface<D> surface = surface_of_soup<D>(soup, {1, "projection"});
    return facet_surface<D>(surface, rounding_of_format<D>(path, surface));
}

template ProjectionSurfacePointer<2> surface_from_file<2>(const std::filesystem::path&,
                                                          std::vector<std::string>&);
template ProjectionSurfacePointer<3> surface_from_file<3>(const std::filesystem::path&,
                                                          std::vector<std::string>&);

} // namespace slabhull
