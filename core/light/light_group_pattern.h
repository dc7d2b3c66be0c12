#pragma once
// How a group of emitters is asked for.
#include <string>
#include <vector>

namespace lightwalk {

/// A group, and which modifiers belong to it: those of a name that one of the patterns matches, as
/// a shell's do (* ? [...]; glob(7)).
struct LightGroupPattern {
    std::string name;
    std::vector<std::string> patterns;
    friend bool operator==(const LightGroupPattern&, const LightGroupPattern&) = default;
};

}  // namespace lightwalk
