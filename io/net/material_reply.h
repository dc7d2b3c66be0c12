#pragma once
// What the server says about materials: what a surface is made of, and what has been changed.
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/argument_names.h"
#include "io/net/walk_request.h"

namespace lightwalk {

/// One modifier of what a surface is made of.
struct MaterialLayer {
    std::string name;
    std::uint32_t definition = 0;  ///< which of the modifiers of that name, in their order
    std::string kind;              ///< its type
    std::string modifier;          ///< the name of its own modifier
    std::string where;             ///< "file:line"
    std::vector<std::string> strings;
    std::vector<ArgumentName> names;  ///< of its numbers; empty: they have none here
    std::vector<double> built;        ///< its numbers, as the scene has them
    std::vector<double> reals;        ///< as they are
    std::string fixed;                ///< why they cannot be changed; empty: they can
};
/// `material`, the answer to MaterialRequest.
struct MaterialReply {
    std::uint32_t id = 0;
    bool hit = false;
    std::string surface;
    /// What is seen comes first, then what it is made of: its patterns, and the materials of
    /// mixtures; at the end what is not seen itself (illum).
    std::vector<MaterialLayer> layers = {};
};
/// A change that is not made.
struct RefusedEdit {
    std::string name;
    std::uint32_t definition = 0;
    std::string why;
};
/// `edited`: what has been made of EditsRequest.
struct EditedReply {
    std::uint32_t id = 0;                      ///< of the request
    std::vector<MaterialEdit> materials = {};  ///< that are changed
    std::vector<RefusedEdit> refused = {};
    double kept = 1;  ///< share of the walk's points that show nothing of what has changed
};

[[nodiscard]] std::string walk_text(const MaterialReply& reply);
[[nodiscard]] std::string walk_text(const EditedReply& reply);

}  // namespace lightwalk
