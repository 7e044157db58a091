// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace slabhull::io {

/// XDMF's name of a topology of simplices, by dimension.
inline constexpr std::array<const char*, 4> xdmf_topologies{"Polyvertex", "Polyline", "Triangle",
                                                            "Tetrahedron"};
/// The numbers of these in a topology of mixed cells.
inline constexpr std::array<int, 4> xdmf_numbers{1, 2, 4, 6};

/// Our dataset beside the geometry of tetrahedra with times: x, y, z, t.
inline constexpr const char* xdmf_space_time = "xyzt";
/// Value of our Information elements whose bytes are texts, each ended by a zero byte.
inline constexpr const char* xdmf_texts = "slabhull_text";
/// Name of the Information that holds field data.
inline constexpr const char* xdmf_fields = "field_data";

} // namespace slabhull::io
