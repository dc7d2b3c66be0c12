#include "io/net/material_reply.h"

#include <nlohmann/json.hpp>

namespace lightwalk {
namespace {

using MaterialJson = nlohmann::json;

std::string material_text_of(const MaterialJson& object) {
    return object.dump(-1, ' ', false, MaterialJson::error_handler_t::replace);
}

MaterialJson names_json(const std::vector<ArgumentName>& names) {
    MaterialJson list = MaterialJson::array();
    for (const ArgumentName& name : names)
        list.push_back({{"quantity", name.quantity},
                        {"channel", name.channel},
                        {"low", name.low},
                        {"high", name.high},
                        {"unit", name.unit}});
    return list;
}

MaterialJson layer_json(const MaterialLayer& layer) {
    return {{"name", layer.name},   {"definition", layer.definition},
            {"kind", layer.kind},   {"modifier", layer.modifier},
            {"where", layer.where}, {"strings", layer.strings},
            {"built", layer.built}, {"names", names_json(layer.names)},
            {"reals", layer.reals}, {"fixed", layer.fixed}};
}

}  // namespace

std::string walk_text(const MaterialReply& reply) {
    MaterialJson layers = MaterialJson::array();
    for (const MaterialLayer& layer : reply.layers) layers.push_back(layer_json(layer));
    return material_text_of({{"type", "material"},
                             {"id", reply.id},
                             {"hit", reply.hit},
                             {"surface", reply.surface},
                             {"layers", std::move(layers)}});
}

std::string walk_text(const EditedReply& reply) {
    MaterialJson materials = MaterialJson::array(), refused = MaterialJson::array();
    for (const MaterialEdit& edit : reply.materials)
        materials.push_back({{"name", edit.name},
                             {"definition", edit.definition},
                             {"kind", edit.kind},
                             {"reals", edit.reals}});
    for (const RefusedEdit& edit : reply.refused)
        refused.push_back(
            {{"name", edit.name}, {"definition", edit.definition}, {"why", edit.why}});
    return material_text_of({{"type", "edited"},
                             {"id", reply.id},
                             {"materials", std::move(materials)},
                             {"refused", std::move(refused)},
                             {"kept", reply.kept}});
}

}  // namespace lightwalk
