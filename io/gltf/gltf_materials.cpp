// The materials of a glTF file.
#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "io/gltf/gltf_parts.h"

namespace lightwalk {
namespace {

constexpr double kMostEmitted = 1e9;  ///< [cd/m²]
constexpr double kMostImages = 1e9;

double bounded(double value, double low, double high, double otherwise) {
    return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

GltfMaterial::Color color_of(const std::vector<double>& values, double otherwise, double most) {
    GltfMaterial::Color color{otherwise, otherwise, otherwise};
    for (std::size_t c = 0; c < 3 && values.size() >= 3; ++c)
        color[c] = bounded(values[c], 0, most, otherwise);
    return color;
}

GltfMaterial::Color color_of(const tinygltf::Value& object, const char* member) {
    GltfMaterial::Color color{1, 1, 1};
    const tinygltf::Value& values = object.Get(member);
    for (std::size_t c = 0; c < 3 && values.IsArray() && values.ArrayLen() >= 3; ++c) {
        const tinygltf::Value& value = values.Get(static_cast<int>(c));
        if (value.IsNumber()) color[c] = bounded(value.GetNumberAsDouble(), 0, 1, 1);
    }
    return color;
}

TextureWrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::clamp;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::mirror
                                                         : TextureWrap::repeat;
}

/// A name that is a word of the scene language.
std::string word_of(const std::string& name, std::size_t number) {
    std::string word = name;
    for (char& c : word) {
        const auto code = static_cast<unsigned char>(c);
        if (code <= ' ' || code == 0x7f || c == '"' || c == '\'') c = '_';
    }
    constexpr std::string_view kMarks = "#!(){}";
    if (!word.empty() && kMarks.find(word.front()) != std::string_view::npos) word[0] = '_';
    if (word.empty() || word == "void" || word == "inherit")
        word = "material_" + std::to_string(number);
    return word;
}

class MaterialReader {
  public:
    MaterialReader(const tinygltf::Model& model, const std::string& name)
        : model_(model), name_(name) {}

    GltfSurface read(const tinygltf::Material& m) {
        GltfSurface surface;
        GltfMaterial& to = surface.material;
        const tinygltf::PbrMetallicRoughness& pbr = m.pbrMetallicRoughness;
        to.base = color_of(pbr.baseColorFactor, 1, 1);
        if (pbr.baseColorFactor.size() == 4) to.opacity = bounded(pbr.baseColorFactor[3], 0, 1, 1);
        to.metallic = bounded(pbr.metallicFactor, 0, 1, 1);
        to.roughness = bounded(pbr.roughnessFactor, 0, 1, 1);
        to.base_texture = texture(pbr.baseColorTexture.index);
        to.roughness_texture = texture(pbr.metallicRoughnessTexture.index);
        to.emitted = color_of(m.emissiveFactor, 0, kMostEmitted);
        to.emitted_texture = texture(m.emissiveTexture.index);
        if (m.alphaMode == "MASK") to.alpha = GltfMaterial::Alpha::mask;
        if (m.alphaMode == "BLEND") to.alpha = GltfMaterial::Alpha::blend;
        to.cutoff = bounded(m.alphaCutoff, 0, 1, 0.5);
        const tinygltf::TextureInfo& uv =
            to.base_texture ? pbr.baseColorTexture : m.emissiveTexture;
        surface.uv_set = uv.texCoord;
        read_transform(uv, surface);
        read_extensions(m, to);
        return surface;
    }

  private:
    /// Nothing for a texture without an image that can be read. Throws InputError for one that does
    /// not exist.
    std::optional<GltfTexture> texture(int index) {
        if (index == -1) return std::nullopt;
        if (index < 0 || static_cast<std::size_t>(index) >= model_.textures.size())
            fail("texture " + std::to_string(index), model_.textures.size());
        const tinygltf::Texture& from = model_.textures[static_cast<std::size_t>(index)];
        const int source = source_of(from);
        if (source == -1) return std::nullopt;  // that of another extension
        if (source < 0 || static_cast<std::size_t>(source) >= model_.images.size())
            fail("image " + std::to_string(source), model_.images.size());
        GltfTexture to{static_cast<std::size_t>(source)};
        if (from.sampler >= 0 && static_cast<std::size_t>(from.sampler) < model_.samplers.size()) {
            const tinygltf::Sampler& sampler =
                model_.samplers[static_cast<std::size_t>(from.sampler)];
            to.wrap_u = wrap_of(sampler.wrapS);
            to.wrap_v = wrap_of(sampler.wrapT);
        }
        return to;
    }

    /// The image as WebP, where there is one: that of the texture itself is for those that cannot
    /// read it.
    static int source_of(const tinygltf::Texture& texture) {
        const auto found = texture.extensions.find("EXT_texture_webp");
        if (found == texture.extensions.end() || !found->second.IsObject()) return texture.source;
        const double source = gltf_number(found->second, "source", texture.source);
        return source >= 0 && source < kMostImages ? static_cast<int>(source) : texture.source;
    }

    [[noreturn]] void fail(const std::string& what, std::size_t count) const {
        throw InputError({name_, 0}, what + " does not exist, there are " + std::to_string(count));
    }

    static void read_transform(const tinygltf::TextureInfo& uv, GltfSurface& surface) {
        const auto found = uv.extensions.find("KHR_texture_transform");
        if (found == uv.extensions.end() || !found->second.IsObject()) return;
        const tinygltf::Value& t = found->second;
        const auto pair = [&t](const char* member, std::array<double, 2>& to) {
            const tinygltf::Value& values = t.Get(member);
            for (int c = 0; c < 2 && values.IsArray() && values.ArrayLen() >= 2; ++c) {
                const tinygltf::Value& value = values.Get(c);
                auto& number = to[static_cast<std::size_t>(c)];
                if (value.IsNumber())
                    number = bounded(value.GetNumberAsDouble(), -1e6, 1e6, number);
            }
        };
        pair("offset", surface.uv_offset);
        pair("scale", surface.uv_scale);
        surface.uv_rotation = bounded(gltf_number(t, "rotation", 0), -1e6, 1e6, 0);
        surface.uv_set =
            static_cast<int>(bounded(gltf_number(t, "texCoord", surface.uv_set), 0, 1e6, 0));
    }

    static void read_extensions(const tinygltf::Material& m, GltfMaterial& to) {
        for (const auto& [name, value] : m.extensions) {
            if (name == "KHR_materials_unlit") to.unlit = true;
            if (!value.IsObject()) continue;
            if (name == "KHR_materials_emissive_strength") {
                const double strength =
                    bounded(gltf_number(value, "emissiveStrength", 1), 0, kMostEmitted, 1);
                for (double& c : to.emitted) c = std::min(c * strength, kMostEmitted);
            } else if (name == "KHR_materials_ior") {
                to.ior = bounded(gltf_number(value, "ior", 1.5), 1, 10, 1.5);
            } else if (name == "KHR_materials_transmission") {
                to.transmission = bounded(gltf_number(value, "transmissionFactor", 0), 0, 1, 0);
            } else if (name == "KHR_materials_volume") {
                to.thickness = bounded(gltf_number(value, "thicknessFactor", 0), 0, 1e9, 0);
                to.attenuation = color_of(value, "attenuationColor");
                to.attenuation_distance =
                    bounded(gltf_number(value, "attenuationDistance", 0), 0, 1e9, 0);
            }
        }
    }

    const tinygltf::Model& model_;
    const std::string& name_;
};

}  // namespace

double gltf_number(const tinygltf::Value& object, const char* member, double otherwise) {
    const tinygltf::Value& value = object.Get(member);
    const double number = value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
    return std::isfinite(number) ? number : otherwise;
}

std::vector<GltfSurface> gltf_surfaces(const tinygltf::Model& model, const std::string& name) {
    std::vector<GltfSurface> surfaces;
    std::set<std::string> names;
    MaterialReader reader(model, name);
    for (std::size_t i = 0; i < model.materials.size(); ++i) {
        surfaces.push_back(reader.read(model.materials[i]));
        std::string word = word_of(model.materials[i].name, i);
        while (!names.insert(word).second) word += "." + std::to_string(i);
        surfaces.back().material.name = word;
    }
    return surfaces;
}

}  // namespace lightwalk
