// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/file_bytes.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

/// Bytes [begin, end) of a file.
struct FileRange {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// The XML of a VTU file without its texts, which may be as large as the mesh: each is replaced by one 'x'.
/// Blanks between tags, comments, CDATA and the appended section, which is not XML, are left out.
class VtuSkeleton {
public:
    explicit VtuSkeleton(FileBytes& file);

    std::string& xml() { return xml_; }
    /// The range in the file of the text that begins at a byte of xml(); empty if none does.
    FileRange text(std::ptrdiff_t byte) const;
    /// The position in the file of a byte of xml().
    std::ptrdiff_t in_file(std::ptrdiff_t byte) const;

    /// The appended section after its underscore.
    FileRange appended() const { return appended_; }
    bool appended_is_base64() const { return appended_is_base64_; }

private:
    struct Place {
        std::size_t byte; ///< position in xml_
        FileRange text;   ///< empty for a tag, which begins there
    };

    bool pass(std::string_view stops, std::string* kept);
    void pass_blanks();
    bool starts_with(std::string_view text);
    bool pass_tag();
    bool pass_until(std::string_view end);
    bool next();

    FileBytes& file_;
    std::size_t at_ = 0;
    std::string xml_;
    std::vector<Place> places_; ///< of all tags and texts
    FileRange appended_;
    bool appended_is_base64_ = false;
};

} // namespace slabhull::io
