// The container of a glTF file, its JSON and its buffers.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <exception>
#include <utility>

#include "core/error.h"
#include "io/gltf/gltf_parts.h"

namespace lightwalk {
namespace {

constexpr int kDeepestNesting = 64;  ///< of the JSON: tinygltf calls itself for each level
constexpr std::size_t kMostValues = std::size_t{1} << 22;    ///< of the JSON
constexpr std::size_t kMostRepeated = std::size_t{1} << 23;  ///< triangles that nodes repeat
constexpr std::size_t kLeastTriangleBytes = 3;
constexpr std::size_t kGlbHead = 12, kChunkHead = 8;

constexpr std::array<std::string_view, 15> kKnownExtensions = {
    "EXT_texture_webp",       "KHR_lights_punctual",       "KHR_materials_emissive_strength",
    "KHR_materials_ior",      "KHR_materials_specular",    "KHR_materials_transmission",
    "KHR_materials_unlit",    "KHR_materials_volume",      "KHR_materials_clearcoat",
    "KHR_materials_sheen",    "KHR_materials_iridescence", "KHR_materials_anisotropy",
    "KHR_materials_variants", "KHR_mesh_quantization",     "KHR_texture_transform"};

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i > 0; --i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i - 1]);
    return value;
}

/// The JSON of a container whose chunks lie within its bytes. tinygltf's own check lets the last
/// chunk exceed them by eight bytes.
std::string_view json_of_container(std::string_view bytes, const std::string& name) {
    const auto fail = [&name](const char* problem) {
        throw InputError({name, 0}, std::string("damaged binary glTF file: ") + problem);
    };
    if (bytes.size() < kGlbHead + kChunkHead) fail("it ends within its header");
    if (little_endian(bytes, 4) != 2) fail("it is not of version 2");
    const std::size_t length = little_endian(bytes, 8);
    if (length > bytes.size()) fail("it is cut off");
    const std::size_t json = little_endian(bytes, kGlbHead);
    std::size_t at = kGlbHead + kChunkHead;
    if (json > length || json > length - std::min(at, length)) fail("its JSON is cut off");
    at += json;
    if (at < length) {
        if (length - at < kChunkHead || little_endian(bytes, at) > length - at - kChunkHead)
            fail("its buffer is cut off");
    }
    return bytes.substr(kGlbHead + kChunkHead, json);
}

/// Refuses JSON that would exhaust the stack or memory of its parser.
void check_json(std::string_view json, const std::string& name) {
    int depth = 0;
    std::size_t values = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"' || i >= json.size();
            continue;
        }
        if (c == '"') in_string = true;
        if (c == '[' || c == '{') ++depth;
        if (c == ']' || c == '}') --depth;
        if (c == '[' || c == '{' || c == ',') ++values;
        if (depth > kDeepestNesting)
            throw InputError({name, 0}, "its JSON nests more than " +
                                            std::to_string(kDeepestNesting) + " levels deep");
        if (values > kMostValues)
            throw InputError({name, 0},
                             "its JSON has more than " + std::to_string(kMostValues) + " values");
    }
}

/// Relative paths that stay where the file is, or below.
bool stays_beside(const std::string& path) {
    if (path.empty() || path.front() == '/' || path.find('\0') != std::string::npos ||
        path.find('\\') != std::string::npos || path.find("://") != std::string::npos)
        return false;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        if (path.compare(begin, end - begin, "..") == 0) return false;
        begin = end + 1;
    }
    return true;
}

/// %20 and the like as the characters that they stand for.
std::string without_percents(std::string uri) {
    for (std::size_t at = uri.find('%'); at != std::string::npos; at = uri.find('%', at + 1)) {
        unsigned int code = 0;
        const char* const digits = uri.data() + std::min(at + 1, uri.size());
        const char* const end = uri.data() + std::min(at + 3, uri.size());
        if (end - digits == 2 && std::from_chars(digits, end, code, 16).ptr == end)
            uri.replace(at, 3, 1, static_cast<char>(code));
    }
    return uri;
}

std::string refusal_of(const std::string& path) {
    return "refers to \"" + path + "\", which is not a file beside it or below";
}

/// What tinygltf reads through.
struct FilesBeside {
    FunctionRef<std::string(const std::string& path)> read;
    std::string error;
};

bool read_beside(std::vector<unsigned char>* out, std::string* /*error*/, const std::string& path,
                 void* user_data) {
    auto& files = *static_cast<FilesBeside*>(user_data);
    if (!stays_beside(path)) {
        files.error = refusal_of(path);
        return false;
    }
    try {
        const std::string bytes = files.read(path);
        out->assign(bytes.begin(), bytes.end());
        return true;
    } catch (const InputError& failed) {
        files.error = failed.what();
        return false;
    }
}

/// Keeps the bytes of data URIs. Those in buffers are looked for later: whether their view exists
/// tinygltf does not check.
bool keep_image(tinygltf::Image* image, const int /*index*/, std::string* /*error*/,
                std::string* /*warning*/, int /*width*/, int /*height*/, const unsigned char* bytes,
                int size, void* /*user_data*/) {
    if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
    return true;
}

/// In one line, without its full stop.
std::string one_line(std::string text) {
    text = text.substr(0, text.find('\n'));
    while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
    return text.empty() ? "unknown error" : text;
}

void check_extensions(const tinygltf::Model& model, const std::string& name) {
    for (const std::string& extension : model.extensionsRequired) {
        if (std::ranges::find(kKnownExtensions, extension) == kKnownExtensions.end())
            throw InputError({name, 0},
                             "requires the extension " + extension + ", which is not supported");
    }
}

}  // namespace

tinygltf::Model load_gltf(std::string_view bytes, const std::string& name,
                          FunctionRef<std::string(const std::string& path)> read) {
    const bool is_binary = bytes.starts_with("glTF");
    check_json(is_binary ? json_of_container(bytes, name) : bytes, name);
    FilesBeside files{read, {}};
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_image, nullptr);
    loader.SetFsCallbacks({[](const std::string&, void*) { return true; },
                           [](const std::string& path, void*) { return path; }, read_beside,
                           nullptr, &files});
    tinygltf::Model model;
    std::string error, warning;
    bool loaded = false;
    const auto size = static_cast<unsigned int>(bytes.size());
    try {
        loaded = is_binary
                     ? loader.LoadBinaryFromMemory(
                           &model, &error, &warning,
                           reinterpret_cast<const unsigned char*>(bytes.data()), size)
                     : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, "");
    } catch (const std::exception& failed) {
        error = failed.what();
    }
    if (!files.error.empty()) throw InputError({name, 0}, files.error);
    if (!loaded) throw InputError({name, 0}, "damaged glTF file: " + one_line(error));
    check_extensions(model, name);
    return model;
}

std::string_view gltf_view(const tinygltf::Model& model, int view, const std::string& name) {
    const auto fail = [&](const std::string& problem) {
        throw InputError({name, 0}, "bufferView " + std::to_string(view) + " " + problem);
    };
    if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
        fail("does not exist, there are " + std::to_string(model.bufferViews.size()));
    const tinygltf::BufferView& v = model.bufferViews[static_cast<std::size_t>(view)];
    if (v.buffer < 0 || static_cast<std::size_t>(v.buffer) >= model.buffers.size())
        fail("is of buffer " + std::to_string(v.buffer) + ", there are " +
             std::to_string(model.buffers.size()));
    const std::vector<unsigned char>& bytes =
        model.buffers[static_cast<std::size_t>(v.buffer)].data;
    if (v.byteOffset > bytes.size() || v.byteLength > bytes.size() - v.byteOffset)
        fail("lies beyond its buffer of " + std::to_string(bytes.size()) + " bytes");
    return {reinterpret_cast<const char*>(bytes.data()) + v.byteOffset, v.byteLength};
}

std::vector<GltfImage> gltf_images(const tinygltf::Model& model, const std::string& name) {
    std::vector<GltfImage> images;
    for (const tinygltf::Image& image : model.images) {
        GltfImage& kept = images.emplace_back();
        if (image.bufferView >= 0) {
            kept.bytes = gltf_view(model, image.bufferView, name);
        } else if (!image.image.empty()) {
            kept.bytes.assign(image.image.begin(), image.image.end());
        } else if (!image.uri.empty()) {
            kept.uri = without_percents(image.uri);
            if (!stays_beside(kept.uri)) throw InputError({name, 0}, refusal_of(kept.uri));
        }
    }
    return images;
}

GltfFile decode_gltf(std::string_view bytes, const std::string& name,
                     FunctionRef<std::string(const std::string& path)> read) {
    const tinygltf::Model model = load_gltf(bytes, name, read);
    GltfFile file;
    const std::vector<GltfSurface> surfaces = gltf_surfaces(model, name);
    for (const GltfSurface& surface : surfaces) file.materials.push_back(surface.material);
    if (std::ranges::any_of(model.materials,
                            [](const auto& m) { return m.normalTexture.index >= 0; }))
        file.left_out.emplace_back("normal textures are left out");
    file.images = gltf_images(model, name);
    std::size_t all_bytes = 0;
    for (const tinygltf::Buffer& buffer : model.buffers) all_bytes += buffer.data.size();
    add_gltf_nodes(model, surfaces, name, all_bytes / kLeastTriangleBytes + kMostRepeated, file);
    return file;
}

}  // namespace lightwalk
