// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace slabhull {

/// What to do about a file that cannot be opened, by errno: `; did you mean "out/room.msh"?` where a file of
/// nearly this name is beside it, else where it was looked for. Begins with "; "; nothing where there is
/// nothing to say.
std::string look_again(const std::filesystem::path& path, int why);

} // namespace slabhull
