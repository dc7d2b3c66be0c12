#include "io/scene/picture_file.h"

#include <utility>

#include "core/error.h"
#include "io/picture/picture_data.h"

namespace lightwalk {
namespace {

/// Radiance's pictures are called .hdr or .pic, and scenes are older than their pictures' names:
/// the same name with the other ending; nothing for other names.
std::optional<std::string> other_picture_name(const std::string& name) {
    for (const auto& [ending, other] : {std::pair(".pic", ".hdr"), std::pair(".hdr", ".pic")}) {
        if (name.ends_with(ending)) return name.substr(0, name.size() - 4) + other;
    }
    return std::nullopt;
}

}  // namespace

std::string not_searched(const std::string& name) {
    return name.starts_with('/') || name.starts_with('.') ? name : "./" + name;
}

std::string locate_picture(const LibraryPath& path, const std::string& name) {
    if (std::optional<std::string> found = path.find(name)) return *std::move(found);
    if (const std::optional<std::string> other = other_picture_name(name)) {
        if (std::optional<std::string> found = path.find(*other)) return *std::move(found);
    }
    return path.locate(name, "picture file");  // which says that it is not there
}

PictureFile read_picture_file(const LibraryPath& path, const std::string& name) {
    PictureFile file;
    if (name.ends_with(kAlphaPart) && !path.find(name)) {
        file.path = locate_picture(path, name.substr(0, name.size() - kAlphaPart.size()));
        file.channels = ImageChannels::alpha;
    } else {
        file.path = locate_picture(path, name);
    }
    file.bytes = path.files().read(file.path);
    return file;
}

PictureData decode_any_picture(const PictureFile& file) {
    if (is_image(file.bytes)) return decode_image(file.bytes, file.path, file.channels);
    return decode_picture(file.bytes, file.path);
}

TexturePicture texture_beside(const std::string& file, const std::string& directory,
                              const std::string& shown, FileSource& files) {
    const std::string path = path_from(directory, file);
    return {not_searched(path_from(shown, file)), image_aspect(files.read(path), path)};
}

}  // namespace lightwalk
