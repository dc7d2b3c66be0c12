#include "io/picture/resolution_line.h"

#include <limits>

#include "core/model/transform_args.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLongestResolution = 31;

/// Size behind the axis letter at `at`, or 0 when there is none.
int axis_size(std::string_view line, std::size_t at) {
    std::string_view rest = line.substr(at + 1);
    std::string_view word = take_word(rest);
    word = word.substr(0, word.find_first_of("+-", 1));
    long size = 0;
    if (!parse_integer(word, size) || size < 1 || size > std::numeric_limits<int>::max()) return 0;
    return static_cast<int>(size);
}

}  // namespace

InputError bad_picture(const std::string& name, const std::string& problem) {
    return InputError({name, 0}, "bad picture file: " + problem);
}

PictureResolution take_resolution(std::string_view& bytes, const std::string& name) {
    const std::string_view line = take_line(bytes);
    const std::size_t x = line.find('X'), y = line.find('Y');
    if (line.size() > kLongestResolution || x == std::string_view::npos ||
        y == std::string_view::npos) {
        throw bad_picture(name, "no resolution line");
    }
    PictureResolution resolution;
    resolution.width = axis_size(line, x);
    resolution.height = axis_size(line, y);
    if (resolution.width < 1 || resolution.height < 1) {
        throw bad_picture(
            name, "bad resolution \"" + std::string(line) + "\", expected two positive sizes");
    }
    resolution.columns = x < y;
    resolution.x_falling = x > 0 && line[x - 1] == '-';
    resolution.y_falling = y > 0 && line[y - 1] == '-';
    return resolution;
}

}  // namespace lightwalk
