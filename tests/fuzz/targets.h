#pragma once
// The functions that the mutation test and the fuzzers call with damaged input, and the valid
// inputs that they start from.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace lightwalk::test {

/// Each reads `bytes` as the program would. InputError is the correct response to invalid input and
/// is caught. Returns whether the input was accepted. Any other exception is a defect.
using FuzzTarget = bool (*)(std::string_view bytes);

bool read_scene_text(std::string_view bytes);     ///< parse, compile, trace a few rays
bool read_octree(std::string_view bytes);         ///< decode an octree, compile, trace a few rays
bool read_function_file(std::string_view bytes);  ///< load, compile and evaluate its variables
bool read_picture(std::string_view bytes);        ///< as a pattern and as a picture
bool read_data_file(std::string_view bytes);      ///< data table, font, mesh
bool read_bsdf_file(std::string_view bytes);      ///< decode, look up, add up and sample
bool read_walk_request(std::string_view bytes);   ///< a browser's message
bool read_walk_frame(std::string_view bytes);     ///< a run's frame
bool read_rad_file(std::string_view bytes);       ///< variables, views and options
bool read_frozen(std::string_view bytes);         ///< a frozen scene: open, compile, trace
bool read_resealed(std::string_view bytes);       ///< a frozen scene whose digests are made right
bool read_luminaire(std::string_view bytes);      ///< photometric data, a table of lamps
bool read_wavefront(std::string_view bytes);      ///< an object file as a mesh, a material file
bool read_gltf_file(std::string_view bytes);      ///< a glTF file: meshes, materials, lights
bool read_image(std::string_view bytes);          ///< PNG, JPEG, TIFF
bool read_layers(std::string_view bytes);         ///< layers of an OpenEXR file

/// Valid inputs for each target; generated, so that the tests need no files.
[[nodiscard]] std::span<const std::string> seeds_of(FuzzTarget target);

struct NamedTarget {
    std::string_view name;
    FuzzTarget run;
};
inline constexpr NamedTarget kFuzzTargets[] = {
    {"scene", read_scene_text}, {"octree", read_octree},       {"function", read_function_file},
    {"picture", read_picture},  {"data", read_data_file},      {"request", read_walk_request},
    {"frozen", read_frozen},    {"resealed", read_resealed},   {"bsdf", read_bsdf_file},
    {"rad", read_rad_file},     {"luminaire", read_luminaire}, {"wavefront", read_wavefront},
    {"gltf", read_gltf_file},   {"image", read_image},         {"layers", read_layers},
    {"frame", read_walk_frame}};

}  // namespace lightwalk::test
