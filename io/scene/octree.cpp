#include "io/formats/binary_reader.h"
#include "io/formats/header.h"
#include "io/scene/binary_models.h"
#include "io/scene/binary_objects.h"

namespace lightwalk {
namespace {

constexpr std::string_view kOctreeFormat = "Radiance_octree";
constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
constexpr std::int64_t kOctreeMagic = 283;

}  // namespace

bool is_octree(std::string_view bytes) {
    bytes = bytes.substr(0, kLongestHeader);
    bool found = false;
    while (!bytes.empty()) {
        const std::size_t end = bytes.find('\n');
        if (end == std::string_view::npos) return false;
        std::string_view line = bytes.substr(0, end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.empty()) return found;
        if (const auto format = header_variable(line, "FORMAT")) found = *format == kOctreeFormat;
        bytes.remove_prefix(end + 1);
    }
    return false;
}

OctreeContents decode_octree(std::string_view bytes, const std::string& name) {
    const InfoHeader header = decode_header(bytes, name);
    if (!header.format.empty() && header.format != kOctreeFormat) {
        throw InputError({name, 0}, "not an octree: FORMAT=" + header.format + ", expected " +
                                        std::string(kOctreeFormat));
    }
    BinaryReader reader(bytes.substr(header.size), name, "octree");
    const std::int64_t id_size = reader.integer(2) - kOctreeMagic;
    if (id_size < 1 || id_size > 8) reader.fail("incompatible octree format");
    const int size = static_cast<int>(id_size);

    OctreeContents contents;
    contents.header = header.lines;
    contents.cube = read_cube(reader);
    for (std::string file = reader.string(); !file.empty(); file = reader.string()) {
        contents.scene_files.push_back(std::move(file));
    }
    contents.objects = reader.unsigned_integer(size);
    skip_tree(reader, size);
    if (!contents.scene_files.empty()) return contents;

    ModelBuilder builder;
    read_objects(reader, size, builder);
    const std::size_t objects = builder.model().size();
    if (objects < contents.objects) {
        reader.fail("holds " + std::to_string(objects) + " objects, expected " +
                    std::to_string(contents.objects));
    }
    contents.model = builder.release();
    contents.model->header = contents.header;
    contents.model->cube = contents.cube;
    return contents;
}

}  // namespace lightwalk
