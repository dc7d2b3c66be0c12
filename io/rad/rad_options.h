#pragma once
// The options that rad(1) gives rpict(1) for the quality that its file asks for.
#include <string>
#include <vector>

#include "io/rad/rad_plan.h"

namespace lightwalk {

/// Rendering options, without those of render= and rpict=, and those that need the scene.
[[nodiscard]] std::vector<std::string> rad_light_words(const RadPlan& plan);
/// -ps and -pt, which stand behind those of render=.
[[nodiscard]] std::vector<std::string> rad_pixel_words(const RadPlan& plan);
/// -x and -y, and -pa where the file tells it: the size of the finished picture.
[[nodiscard]] std::vector<std::string> rad_size_words(const RadPlan& plan);

/// -ar.
/// @param edge  of the scene's cube [m]
[[nodiscard]] int rad_ambient_resolution(const RadPlan& plan, const RadZone& zone, double edge);
/// -ms [m]; 0: rad leaves it at that.
[[nodiscard]] double rad_scatter_step(const RadPlan& plan, const RadZone& zone);

/// Rays a pixel of the finished picture, which rad makes larger first: 1, 2 x 2 or 3 x 3.
[[nodiscard]] int rad_samples(const RadPlan& plan);

}  // namespace lightwalk
