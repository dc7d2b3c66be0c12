#pragma once
// Interface by which core gets named files of the library path while a scene is built.
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/rgb.h"
#include "core/math/task_runner.h"
#include "core/model/column.h"
#include "core/model/primitive.h"

namespace lightwalk {

class Bsdf;

/// Interpolation table of a Radiance data file. Values are in row-major order, last dimension
/// fastest.
struct DataArray {
    struct Axis {
        float origin = 0, extent = 0;  ///< regular axis: first coordinate, last minus first
        std::uint32_t count = 0;       ///< >= 2 (>= 1 for a picture)
        std::vector<float>
            points;  ///< `count` coordinates of an irregular axis; empty when regular
    };
    std::vector<Axis> axes;     ///< 1 to 6
    std::vector<float> values;  ///< product of the counts
};

/// A picture as a two-dimensional table: axis 0 is v (upward), axis 1 is u (to the right), origin
/// lower left.
struct PictureData {
    std::array<DataArray::Axis, 2> axes;  ///< v, u
    Column<Rgb> values;  ///< row-major from the bottom row up, left to right [W/(m² sr)]
};

/// A picture of spectra as a table like PictureData, of several values a pixel.
struct SpectralPicture {
    std::array<DataArray::Axis, 2> axes;   ///< v, u
    double first_edge = 0, last_edge = 0;  ///< of the bands, which are of one width [nm]
    std::size_t bands = 0;                 ///< at least 1
    std::vector<float> values;             ///< [(v * width + u) * bands + band]
};

/// A font (.fnt): glyphs of closed polygons on a 0..255 grid.
struct Font {
    struct Glyph {
        bool defined = false;
        std::int16_t left = 128, right = 128, bottom = 128, top = 128;
        std::vector<std::array<std::uint8_t, 2>> vertices;
    };
    std::array<Glyph, 256> glyphs;
    int mean_width = 0;
};

/// A file that a scene names.
struct NamedFile {
    enum class Kind { octree, mesh, picture };
    Kind kind{};
    std::string name;
};

/// Finds and decodes files by the names that stand in a scene. Every method throws MissingFile,
/// naming the search path, when there is no such file, and InputError when it is damaged. Each name
/// is decoded once and shared.
class Resources {
  public:
    virtual ~Resources() = default;
    [[nodiscard]] virtual std::string function_file(
        const std::string& name) = 0;  ///< text of a .cal file
    [[nodiscard]] virtual std::shared_ptr<const DataArray> data(const std::string& name) = 0;
    [[nodiscard]] virtual std::shared_ptr<const PictureData> picture(const std::string& name) = 0;
    [[nodiscard]] virtual std::shared_ptr<const SpectralPicture> spectral_picture(
        const std::string& name) = 0;
    /// A file of BSDF data (.xml).
    [[nodiscard]] virtual std::shared_ptr<const Bsdf> bsdf(const std::string& name) = 0;
    [[nodiscard]] virtual std::shared_ptr<const Font> font(const std::string& name) = 0;
    [[nodiscard]] virtual std::vector<std::string> text_lines(const std::string& name) = 0;
    [[nodiscard]] virtual std::shared_ptr<const Model> octree(const std::string& name) = 0;
    [[nodiscard]] virtual std::shared_ptr<const MeshModel> mesh(const std::string& name) = 0;
    /// Announce files that will be requested soon, so that they can be decoded in parallel. A hint:
    /// errors in them are reported when they are requested.
    virtual void prepare(std::span<const NamedFile> files, const TaskRunner& task_runner) {
        (void)files;
        (void)task_runner;
    }
};

}  // namespace lightwalk
