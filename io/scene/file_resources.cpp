#include "io/scene/file_resources.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "io/formats/decode.h"
#include "io/picture/picture_data.h"
#include "io/scene/binary_models.h"
#include "io/scene/scene_reader.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLongestTextLine = 511;

/// Radiance's pictures are called .hdr or .pic, and scenes are older than their pictures' names:
/// the same name with the other ending; nothing for other names.
std::optional<std::string> other_picture_name(const std::string& name) {
    for (const auto& [ending, other] : {std::pair(".pic", ".hdr"), std::pair(".hdr", ".pic")}) {
        if (name.ends_with(ending)) return name.substr(0, name.size() - 4) + other;
    }
    return std::nullopt;
}

std::string locate_picture(const LibraryPath& path, const std::string& name) {
    if (std::optional<std::string> found = path.find(name)) return *std::move(found);
    if (const std::optional<std::string> other = other_picture_name(name)) {
        if (std::optional<std::string> found = path.find(*other)) return *std::move(found);
    }
    return path.locate(name, "picture file");  // which says that it is not there
}

/// The cached value of `name`, or what `load` makes of it.
template <class T, class Load>
std::shared_ptr<const T> cached(std::map<std::string, std::shared_ptr<const T>>& cache,
                                const std::string& name, const Load& load) {
    const auto found = cache.find(name);
    if (found != cache.end()) return found->second;
    std::shared_ptr<const T> value = load();
    cache.emplace(name, value);
    return value;
}

}  // namespace

FileResources::FileResources(LibraryPath path, bool allow_commands, WarningSink& warnings)
    : path_(std::move(path)), allow_commands_(allow_commands), warnings_(warnings) {}

std::string FileResources::function_file(const std::string& name) {
    return path_.files().read(path_.locate(name, "function file"));
}

std::shared_ptr<const DataArray> FileResources::data(const std::string& name) {
    return cached(data_, name, [&] {
        const std::string path = path_.locate(name, "data file");
        return std::make_shared<const DataArray>(decode_data(path_.files().read(path), path));
    });
}

std::shared_ptr<const PictureData> FileResources::picture(const std::string& name) {
    return cached(pictures_, name, [&] {
        const std::string path = locate_picture(path_, name);
        return std::make_shared<const PictureData>(decode_picture(path_.files().read(path), path));
    });
}

std::shared_ptr<const Font> FileResources::font(const std::string& name) {
    return cached(fonts_, name, [&] {
        const std::string path = path_.locate(name, "font file");
        return std::make_shared<const Font>(decode_font(path_.files().read(path), path));
    });
}

std::vector<std::string> FileResources::text_lines(const std::string& name) {
    const std::string text = path_.files().read(path_.locate(name, "text file"));
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::size_t length = std::min(end - begin, kLongestTextLine);
        lines.push_back(text.substr(begin, length));
        begin += length;
        if (begin == end) ++begin;
    }
    return lines;
}

std::shared_ptr<const Model> FileResources::octree(const std::string& name) {
    return cached(octrees_, name, [&] {
        const std::string path = path_.locate(name, "octree file");
        const SceneReadOptions options{path_, allow_commands_, path_.base()};
        return read_octree(path_.files().read(path), path, options, warnings_);
    });
}

std::shared_ptr<const MeshModel> FileResources::mesh(const std::string& name) {
    return cached(meshes_, name, [&] {
        const std::string path = path_.locate(name, "mesh file");
        return std::make_shared<const MeshModel>(decode_mesh(path_.files().read(path), path));
    });
}

}  // namespace lightwalk
