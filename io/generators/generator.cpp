#include "io/generators/generator.h"

#include <array>
#include <string_view>
#include <utility>

namespace lightwalk {
namespace {

constexpr std::array<std::pair<std::string_view, Generator>, 14> kGenerators = {{
    {"xform", &run_xform},
    {"genbox", &run_genbox},
    {"gensurf", &run_gensurf},
    {"genrev", &run_genrev},
    {"genworm", &run_genworm},
    {"genprism", &run_genprism},
    {"genblinds", &run_genblinds},
    {"gensky", &run_gensky},
    {"gendaylit", &run_gendaylit},
    {"replmarks", &run_replmarks},
    {"ies2rad", &run_ies2rad},
    {"ldt2rad", &run_ldt2rad},
    {"obj2rad", &run_obj2rad},
    {"pkgBSDF", &run_pkgbsdf},
}};

}  // namespace

Generator find_generator(const std::string& program) {
    for (const auto& [name, generator] : kGenerators) {
        if (name == program) return generator;
    }
    return nullptr;
}

}  // namespace lightwalk
