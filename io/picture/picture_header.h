#pragma once
// Makes the lines of a picture's information header, in the order in which rpict writes them.
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "core/view/view.h"
#include "io/picture/picture.h"

namespace lightwalk {

struct PictureFacts {
    std::vector<std::string> scene_lines;  ///< history of the scene (its octree's header lines)
    std::string command;   ///< command line as one history line (history_line of option_words.h)
    std::string software;  ///< name and version of the writing program
    std::optional<int> frame;  ///< number in a sequence
    View view;
    double pixel_aspect = 1;  ///< pixel height / width; written only when it is not about 1
    std::time_t time = 0;     ///< time of creation
};

/// The lines from the scene's history to PRIMARIES, without those whose text is empty. The time is
/// written as local time of the environment. Source: Radiance's file format guide, "picture file
/// headers"; manual page rpict(1).
[[nodiscard]] PictureHeader make_picture_header(const PictureFacts& facts);

}  // namespace lightwalk
