#include "io/picture/picture_data.h"

#include <algorithm>
#include <span>

#include "io/picture/rgbe_picture.h"

namespace lightwalk {

PictureData empty_picture(int columns, int rows, double aspect) {
    const double width = columns, height = rows * aspect;
    PictureData data;
    data.axes[0].extent = static_cast<float>(width <= height ? height / width : 1);
    data.axes[0].count = static_cast<std::uint32_t>(rows);
    data.axes[1].extent = static_cast<float>(width <= height ? 1 : width / height);
    data.axes[1].count = static_cast<std::uint32_t>(columns);
    return data;
}

PictureData decode_picture(std::string_view bytes, const std::string& name) {
    const RgbePicture picture = decode_rgbe_picture(bytes, name, XyzPictures::refuse);
    PictureData data =
        empty_picture(picture.width, picture.height, pixel_aspect(picture.header, name));
    const std::span<Rgb> values = data.values.zeros(picture.pixels.size());
    const auto row = static_cast<std::ptrdiff_t>(picture.width);
    for (std::ptrdiff_t y = 0; y < picture.height; ++y) {
        const auto from = picture.pixels.end() - (y + 1) * row;
        std::transform(from, from + row, values.begin() + y * row, decode_rgbe);
    }
    return data;
}

}  // namespace lightwalk
