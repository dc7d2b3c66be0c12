#include "io/scene/frozen_resources.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "io/formats/packed.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMostAxes = 6;
constexpr std::int32_t kFontGrid = 255;
constexpr std::uint64_t kMostBands = 1000;  ///< of a spectral picture

void pack_axis(PackedWriter& writer, const DataArray::Axis& axis) {
    writer.number(axis.origin);
    writer.number(axis.extent);
    writer.number(axis.count);
    writer.list(axis.points);
}

/// @param fewest  points
DataArray::Axis unpack_axis(PackedReader& reader, std::uint32_t fewest) {
    DataArray::Axis axis;
    axis.origin = reader.number<float>();
    axis.extent = reader.number<float>();
    axis.count = reader.number<std::uint32_t>();
    axis.points = reader.list<float>();
    const bool points = axis.points.empty() || axis.points.size() == axis.count;
    if (!std::isfinite(axis.origin) || !std::isfinite(axis.extent) || axis.extent == 0 ||
        axis.count < fewest || !points ||
        !std::ranges::all_of(axis.points, [](float x) { return std::isfinite(x); }))
        reader.fail();
    return axis;
}

/// Checks that the number of values of a table is the product of its axes.
void check_size(const PackedReader& reader, std::span<const DataArray::Axis> axes,
                std::size_t values) {
    std::size_t size = 1;
    for (const DataArray::Axis& axis : axes) {
        if (axis.count > values / size) reader.fail();
        size *= axis.count;
    }
    if (size != values) reader.fail();
}

}  // namespace

void freeze_data(const DataArray& data, std::uint32_t number, FrozenParts& parts) {
    PackedWriter writer;
    writer.count(data.axes.size());
    for (const DataArray::Axis& axis : data.axes) pack_axis(writer, axis);
    writer.list(data.values);
    parts.add(FrozenKind::data, number, writer.bytes());
}

std::shared_ptr<const DataArray> map_data(const FrozenFile& file, std::uint32_t number) {
    PackedReader reader(part_of(file, FrozenKind::data, number), file.name(), "a data file");
    auto data = std::make_shared<DataArray>();
    const auto axes = reader.number<std::uint64_t>();
    if (axes < 1 || axes > kMostAxes) reader.fail();
    for (std::uint64_t i = 0; i < axes; ++i) data->axes.push_back(unpack_axis(reader, 2));
    data->values = reader.list<float>();
    reader.end();
    check_size(reader, data->axes, data->values.size());
    if (!std::ranges::all_of(data->values, [](float x) { return std::isfinite(x); })) reader.fail();
    return data;
}

void freeze_picture(const PictureData& picture, std::uint32_t number, FrozenParts& parts) {
    PackedWriter writer;
    for (const DataArray::Axis& axis : picture.axes) pack_axis(writer, axis);
    parts.add(FrozenKind::picture, number, writer.bytes());
    parts.add(FrozenKind::pixels, number, picture.values.values());
}

std::shared_ptr<const PictureData> map_picture(const FrozenFile& file, std::uint32_t number) {
    PackedReader reader(part_of(file, FrozenKind::picture, number), file.name(), "a picture");
    const auto mapped = std::make_shared<Mapped<PictureData>>();
    mapped->bytes = file.owner();
    PictureData& picture = mapped->thing;
    for (DataArray::Axis& axis : picture.axes) {
        axis = unpack_axis(reader, 1);
        if (!axis.points.empty()) reader.fail();
    }
    reader.end();
    picture.values = column_of<Rgb>(file, FrozenKind::pixels, number);
    check_size(reader, picture.axes, picture.values.size());
    const auto finite = [](const Rgb& c) { return std::isfinite(c.r + c.g + c.b); };
    if (!std::ranges::all_of(picture.values, finite)) reader.fail();
    return {mapped, &picture};
}

void freeze_spectral_picture(const SpectralPicture& picture, std::uint32_t number,
                             FrozenParts& parts) {
    PackedWriter writer;
    for (const DataArray::Axis& axis : picture.axes) pack_axis(writer, axis);
    writer.number(picture.first_edge);
    writer.number(picture.last_edge);
    writer.count(picture.bands);
    writer.list(picture.values);
    parts.add(FrozenKind::spectral_picture, number, writer.bytes());
}

std::shared_ptr<const SpectralPicture> map_spectral_picture(const FrozenFile& file,
                                                            std::uint32_t number) {
    PackedReader reader(part_of(file, FrozenKind::spectral_picture, number), file.name(),
                        "a spectral picture");
    auto picture = std::make_shared<SpectralPicture>();
    for (DataArray::Axis& axis : picture->axes) {
        axis = unpack_axis(reader, 1);
        if (!axis.points.empty()) reader.fail();
    }
    picture->first_edge = reader.number<double>();
    picture->last_edge = reader.number<double>();
    const auto bands = reader.number<std::uint64_t>();
    picture->values = reader.list<float>();
    reader.end();
    if (!std::isfinite(picture->first_edge) || !std::isfinite(picture->last_edge) ||
        picture->first_edge == picture->last_edge || bands < 1 || bands > kMostBands ||
        picture->values.size() % bands != 0)
        reader.fail();
    picture->bands = bands;
    check_size(reader, picture->axes, picture->values.size() / bands);
    if (!std::ranges::all_of(picture->values, [](float x) { return std::isfinite(x); }))
        reader.fail();
    return picture;
}

void freeze_font(const Font& font, std::uint32_t number, FrozenParts& parts) {
    PackedWriter writer;
    writer.number(font.mean_width);
    for (const Font::Glyph& glyph : font.glyphs) {
        writer.boolean(glyph.defined);
        for (const std::int16_t edge : {glyph.left, glyph.right, glyph.bottom, glyph.top})
            writer.number(edge);
        writer.list(glyph.vertices);
    }
    parts.add(FrozenKind::font, number, writer.bytes());
}

std::shared_ptr<const Font> map_font(const FrozenFile& file, std::uint32_t number) {
    PackedReader reader(part_of(file, FrozenKind::font, number), file.name(), "a font");
    const auto on_grid = [&](std::int32_t value) {
        if (value < 0 || value > kFontGrid) reader.fail();
        return value;
    };
    auto font = std::make_shared<Font>();
    font->mean_width = on_grid(reader.number<int>());
    for (Font::Glyph& glyph : font->glyphs) {
        glyph.defined = reader.boolean();
        for (std::int16_t* edge : {&glyph.left, &glyph.right, &glyph.bottom, &glyph.top})
            *edge = static_cast<std::int16_t>(on_grid(reader.number<std::int16_t>()));
        glyph.vertices = reader.list<std::array<std::uint8_t, 2>>();
    }
    reader.end();
    return font;
}

}  // namespace lightwalk
