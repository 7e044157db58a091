// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/csv_table.h"
#include "slabhull/io/soup.h"
#include "slabhull/io/space_time_files.h"

#include <string>

namespace fuzz {

/// What contradicts itself in a soup that a reader let through, in words; empty if nothing does. Looked at
/// are the promises of soup.h: vertices that exist, finite coordinates, arrays as long as what they belong
/// to, groups that are listed in order.
std::string fault_of(const slabhull::io::Soup& soup);
/// The same for a space-time mesh.
std::string fault_of(const slabhull::io::SpaceTimeSoup& soup);
/// The same for a table.
std::string fault_of(const slabhull::io::CsvTable& table);

/// Where two soups differ in what the first format of a round trip holds; empty if nowhere.
struct Compared {
    bool groups = true;
    bool point_data = true;
    bool cell_data = true;
    bool field_data = true;
};
std::string difference(const slabhull::io::Soup& before, const slabhull::io::Soup& after, Compared what);

} // namespace fuzz
