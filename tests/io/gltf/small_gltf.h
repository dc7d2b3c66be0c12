#pragma once
// glTF files made in tests.
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace lightwalk::test {

template <class T>
std::string packed(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

inline std::string glb_chunk(const char* kind, std::string bytes, char padding) {
    while (bytes.size() % 4 != 0) bytes += padding;
    return packed<std::uint32_t>({static_cast<std::uint32_t>(bytes.size())}) +
           std::string(kind, 4) + bytes;
}

/// A binary file of a JSON text and its buffer.
inline std::string glb(const std::string& json, const std::string& buffer) {
    const std::string chunks = glb_chunk("JSON", json, ' ') + glb_chunk("BIN\0", buffer, '\0');
    return "glTF" + packed<std::uint32_t>({2, static_cast<std::uint32_t>(12 + chunks.size())}) +
           chunks;
}

/// A square of side 1 that stands on the x axis and faces +z, glTF's y up, with texture coordinates
/// from the upper left: accessors 0 (positions), 1 (normals), 2 (texture coordinates), 3 (indices),
/// bufferViews 0 to 3; `image`, if any, is bufferView 4.
struct SmallGltf {
    std::string image;
    std::string nodes = R"({"mesh":0})", roots = "0";
    std::string meshes =
        R"({"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0}]})";
    std::string materials = R"({"name":"m"})";
    std::string more;            ///< members of the file, each after a comma
    std::string more_accessors;  ///< each after a comma

    [[nodiscard]] std::string buffer() const {
        return packed<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) +
               packed<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}) +
               packed<float>({0, 1, 1, 1, 1, 0, 0, 0}) + packed<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
               image;
    }
    [[nodiscard]] std::string json(const std::string& uri = "") const {
        const auto view = [](std::size_t offset, std::size_t length) {
            return R"({"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":)" +
                   std::to_string(length) + "}";
        };
        std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots +
                           R"(]}],"nodes":[)" + nodes + R"(],"meshes":[)" + meshes +
                           R"(],"materials":[)" + materials + R"(],"buffers":[{"byteLength":)" +
                           std::to_string(buffer().size());
        if (!uri.empty()) text += R"(,"uri":")" + uri + "\"";
        text += R"(}],"bufferViews":[)" + view(0, 48) + "," + view(48, 48) + "," + view(96, 32) +
                "," + view(128, 12);
        if (!image.empty()) {
            text +=
                "," + view(140, image.size()) +
                R"(],"images":[{"bufferView":4,"mimeType":"image/png"}],"textures":[{"source":0})";
        }
        return text +
               R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
               R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"},)"
               R"({"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"},)"
               R"({"bufferView":3,"componentType":5123,"count":6,"type":"SCALAR"})" +
               more_accessors + "]" + more + "}";
    }
    [[nodiscard]] std::string binary() const { return glb(json(), buffer()); }
};

}  // namespace lightwalk::test
