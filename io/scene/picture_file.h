#pragma once
// The files of pictures that scenes name: Radiance's, and images, which OpenImageIO decodes.
#include <optional>
#include <string>
#include <string_view>

#include "core/model/resources.h"
#include "io/files/library_path.h"
#include "io/language/material_text.h"
#include "io/picture/image_decoder.h"

namespace lightwalk {

/// What makes the name of an image that of its alpha: `leaf.png#alpha`, as grey.
inline constexpr std::string_view kAlphaPart = "#alpha";

/// A name that is looked for here rather than along the library path.
[[nodiscard]] std::string not_searched(const std::string& name);

/// Where the picture of this name is. If NAME.pic does not exist it is NAME.hdr, and the other way
/// round. Throws MissingFile.
[[nodiscard]] std::string locate_picture(const LibraryPath& path, const std::string& name);

/// The bytes of a picture, what messages call it, and which of its values are meant.
struct PictureFile {
    std::string path, bytes;
    ImageChannels channels = ImageChannels::color;
};
[[nodiscard]] PictureFile read_picture_file(const LibraryPath& path, const std::string& name);

/// Decode a Radiance picture, or an image. Throws InputError.
[[nodiscard]] PictureData decode_any_picture(const PictureFile& file);

/// A picture beside a file of materials.
/// @param directory  where it is read
/// @param shown  the directory by which the scene names it
/// Throws InputError for what is no picture.
[[nodiscard]] TexturePicture texture_beside(const std::string& file, const std::string& directory,
                                            const std::string& shown, FileSource& files);

}  // namespace lightwalk
