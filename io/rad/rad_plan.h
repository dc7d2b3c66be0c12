#pragma once
// What the variables of a rad file mean.
#include <optional>
#include <string>
#include <vector>

#include "core/math/vec3.h"
#include "io/files/file_source.h"
#include "io/rad/rad_file.h"

namespace lightwalk {

/// The box that is of interest, seen from inside or outside [m].
struct RadZone {
    bool exterior = true;
    Vec3 lower, upper;

    /// Mean of its edges.
    [[nodiscard]] double mean_edge() const {
        const Vec3 size = upper - lower;
        return (size.x + size.y + size.z) / 3;
    }
};

/// A view as it stands in the file.
struct RadView {
    std::string name;                ///< "" for none
    std::vector<std::string> words;  ///< rpict's options
    SourceLocation where;
    bool standard = false;  ///< the name is that of a view from a side of the zone: its options too

    /// How it is called where it has no name: its number, from 1.
    [[nodiscard]] std::string title(std::size_t number) const {
        return name.empty() ? std::to_string(number) : name;
    }
};

enum class RadLevel { low, medium, high };

struct RadPlan {
    std::string name;                      ///< of the file
    std::vector<RadValue> scene;           ///< materials=, scene= and illum=: files
    std::vector<std::string> scene_files;  ///< what rad_scene_files() makes of these
    std::vector<std::string> base;  ///< oconv= -i: the octree that they are added to, or nothing
    std::string octree;             ///< OCTREE=, or the name that it has without
    std::optional<RadZone> zone;    ///< ZONE=; nothing: the scene's cube, from outside
    RadLevel quality = RadLevel::low, detail = RadLevel::medium, variability = RadLevel::low;
    bool penumbras = false;
    int indirect = 0;                ///< INDIRECT=: bounces that matter
    std::optional<double> exposure;  ///< EXPOSURE=: a factor
    std::string ambient_file;        ///< AMBFILE=
    int width = 512, height = 512;   ///< RESOLUTION= [pixels]
    std::optional<double> pixel_aspect;
    std::optional<Vec3> up;  ///< UP=: a unit vector along an axis
    std::vector<RadValue> render, rpict;
    std::vector<RadView> views;                ///< in their order; at least one
    std::vector<std::string> notices;          ///< what is in the file without being heeded
    std::vector<std::string> picture_notices;  ///< the same, of pictures
};

/// Throws InputError "file:line: ..." for a value that its variable cannot have.
[[nodiscard]] RadPlan rad_plan(const RadFile& file);

/// The files of the scene, in order: those that the file names, or, where one of these cannot be
/// read, its octree, if that can, which adds a notice. Throws InputError where there are neither.
[[nodiscard]] std::vector<std::string> rad_scene_files(RadPlan& plan, FileSource& files);

}  // namespace lightwalk
