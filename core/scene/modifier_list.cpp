// Which factory makes which modifier: one line a type.
#include "core/material/factories.h"
#include "core/scene/modifier.h"
#include "core/texture/factories.h"

namespace lightwalk {

ModifierFactory modifier_factory(PrimitiveType type) {
    using enum PrimitiveType;
    switch (type) {
        case light:
        case illum:
        case glow:
        case spotlight:
            return make_light;
        case mirror:
            return make_mirror;
        case prism1:
        case prism2:
            return make_prism;
        case mist:
            return make_mist;
        case plastic:
        case metal:
        case trans:
            return make_plastic;
        case plastic2:
        case metal2:
        case trans2:
            return make_anisotropic;
        case ashik2:
            return make_ashikhmin;
        case dielectric:
        case interface:
            return make_dielectric;
        case glass:
            return make_glass;
        case plasfunc:
        case metfunc:
        case transfunc:
        case plasdata:
        case metdata:
        case transdata:
            return make_function_brdf;
        case brtdfunc:
            return make_brtdfunc;
        case antimatter:
            return make_antimatter;
        case texfunc:
            return make_function_texture;
        case texdata:
            return make_data_texture;
        case brightfunc:
        case colorfunc:
            return make_function_pattern;
        case brightdata:
        case colordata:
            return make_data_pattern;
        case colorpict:
            return make_picture_pattern;
        case brighttext:
        case colortext:
            return make_text_pattern;
        case mixfunc:
        case mixdata:
        case mixpict:
        case mixtext:
            return make_mixture;
        default:
            return nullptr;  // surfaces, alias, and what is recognised but refused
    }
}

}  // namespace lightwalk
