#pragma once
// Layers of a picture, one for each light group: files that hold them, and their weighted sum.
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/rgb.h"
#include "io/picture/picture.h"

namespace lightwalk {

/// What a light group adds to a picture, as that is stored.
struct PictureLayer {
    std::string name;
    std::span<const Rgb> pixels;
};

/// Whether a file's name has a %s, for the names of layers: each layer is a file then.
[[nodiscard]] bool has_layer_place(const std::string& pattern);
/// `pattern` with its %s replaced; what else it has of % is left to frame_name(). Throws UsageError
/// for a second %s.
[[nodiscard]] std::string layer_file_name(const std::string& pattern, const std::string& layer);
/// Throws UsageError unless layers can be written by that name: an .exr, or with %s any kind of
/// picture that holds radiance.
void check_layers_name(const std::string& pattern);

/// Write a picture a layer, where the name has a %s: their headers say LIGHT_GROUP= and the name.
/// Else one OpenEXR file: `whole` as channels R G B, the layers as NAME.R NAME.G NAME.B, and the
/// whole picture's error, where it is known, as "error".
/// Each file appears whole or not at all. Throws InputError, UsageError.
/// @param error  of each pixel, as many as there are; empty: not known
/// @param file   the name that a layer's file gets of `pattern` with the layer's name in it
void write_layers(const std::string& pattern, const Picture& whole,
                  std::span<const PictureLayer> layers, std::span<const float> error,
                  const PictureHeader& header,
                  const std::function<std::string(const std::string&)>& file);

/// What the head of a file of layers says.
struct LayersHeader {
    int width = 0, height = 0;
    std::vector<std::string> names;  ///< of the layers, as they follow each other in the file
    std::vector<std::string> lines;  ///< of the picture's header, without LIGHT_GROUP
};
/// Of a file that write_layers() wrote; a picture without layers is one by the name of its file,
/// without ending. Throws InputError.
[[nodiscard]] LayersHeader read_layers_header(std::string_view bytes, const std::string& path);

/// Add the layers of a file, each times its factor. Of an OpenEXR file no more than some rows are
/// decoded at a time.
/// @param factors  one a layer; one that is 0 is not looked at
/// @param sum      as large as the file's header says
void add_layers(std::string_view bytes, const std::string& path, std::span<const Rgb> factors,
                Picture& sum);

}  // namespace lightwalk
