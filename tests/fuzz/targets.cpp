#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/bsdf/through_part.h"
#include "core/function/environment.h"
#include "core/scene/scene.h"
#include "core/texture/interpolate.h"
#include "core/trace/tracer.h"
#include "io/bsdf/bsdf_file.h"
#include "io/formats/decode.h"
#include "io/generators/luminaire_scene.h"
#include "io/gltf/gltf_material.h"
#include "io/net/walk_frame.h"
#include "io/net/walk_request.h"
#include "io/photometry/eulumdat.h"
#include "io/photometry/ies_file.h"
#include "io/photometry/lamp_table.h"
#include "io/picture/image_decoder.h"
#include "io/picture/layers.h"
#include "io/picture/picture.h"
#include "io/picture/picture_data.h"
#include "io/rad/rad_options.h"
#include "io/rad/rad_views.h"
#include "io/scene/binary_models.h"
#include "io/scene/frozen_scene.h"
#include "io/scene/scene_reader.h"
#include "io/wavefront/mtl_file.h"
#include "io/wavefront/obj_mesh.h"
#include "tests/io/gltf/small_gltf.h"
#include "tests/test_scene.h"

namespace lightwalk::test {
namespace {

/// Build the scene and look at it from a few directions.
void trace_some(std::shared_ptr<const Model> model, Resources& resources) {
    Silence silence;
    const Scene scene(std::move(model), modifier_factory, resources, silence);
    RenderOptions options;
    options.virtual_source_pretest = 0;
    options.shadow_threshold = 0;
    options.reflection_limit = 3;
    const Tracer tracer(scene, options, silence);
    TraceContext context(tracer, silence);
    for (std::uint32_t i = 0; i < 4; ++i) {
        const Vec3 direction{0.3 * i - 0.5, 1, 0.1 - 0.2 * i};
        Ray ray = tracer.primary({0.5, -3, 0.5}, direction, 0, RandomStream::of_pixel(1, i, 0, 0));
        tracer.trace(ray, context);
    }
}

void trace_some(std::shared_ptr<const Model> model) {
    MemoryResources resources;
    trace_some(std::move(model), resources);
}

template <class Read>
bool accepts(const Read& read) {
    try {
        read();
        return true;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace

bool read_scene_text(std::string_view bytes) {
    return accepts([&] {
        Silence silence;
        SceneReadOptions options;
        options.library = LibraryPath(std::vector<std::string>{});
        trace_some(parse_scene(bytes, "mutant.rad", options, silence));
    });
}

bool read_octree(std::string_view bytes) {
    return accepts([&] {
        const OctreeContents contents = decode_octree(bytes, "mutant.oct");
        if (contents.model) trace_some(contents.model);
    });
}

bool read_function_file(std::string_view bytes) {
    return accepts([&] {
        FunctionEnvironment environment;
        environment.load("mutant.cal", bytes);
        const std::array<double, 3> reals{1, 2, 3};
        for (const char* name : {"a", "b", "c", "f(Px,Py)"}) {
            (void)accepts([&] {
                const std::array<ExpressionRequest, 1> request{ExpressionRequest{name, -1}};
                const Program program =
                    environment.compile("mutant.cal", request, reals, 0, {"mutant.rad", 1});
                ChannelValues channels{};
                channels.fill(0.5);
                EvalState state;
                program.begin(state, channels);
                (void)program.evaluate(0, state);
            });
        }
    });
}

bool read_picture(std::string_view bytes) {
    const bool pattern = accepts([&] {
        const PictureData data = decode_picture(bytes, "mutant.hdr");
        (void)interpolate(data, 0.4, 0.7);
    });
    const bool picture = accepts([&] { (void)read_hdr(bytes, "mutant.hdr"); });
    return pattern || picture;
}

bool read_data_file(std::string_view bytes) {
    const bool data = accepts([&] {
        const DataArray array = decode_data(bytes, "mutant.dat");
        const std::array<double, 6> point{0.3, 1.7, 0.1, 0.2, 0.3, 0.4};
        (void)interpolate(array, std::span(point).first(array.axes.size()));
    });
    const bool font = accepts([&] { (void)decode_font(bytes, "mutant.fnt"); });
    const bool mesh = accepts([&] { (void)decode_mesh(bytes, "mutant.rtm"); });
    return data || font || mesh;
}

bool read_bsdf_file(std::string_view bytes) {
    return accepts([&] {
        const Bsdf bsdf(std::make_shared<BsdfData>(decode_bsdf(bytes, "mutant.xml")));
        const ProjectedDirection e{0.3, -0.4}, l{-0.25, 0.45};
        for (const bool front : {true, false}) {
            (void)find_through_part(bsdf.transmission(front), e);
            for (const BsdfComponent* part : {&bsdf.transmission(front), &bsdf.reflection(front)}) {
                (void)part->value(e, l);
                if (!part->lobes) continue;
                const BsdfLookup lookup = part->lobes->look_up(e);
                (void)part->lobes->resolution(lookup);
                if (part->lobes->total(lookup) > 0)
                    (void)part->lobes->sample(lookup, 0.3, 0.6, 0.9);
            }
        }
    });
}

bool read_rad_file(std::string_view bytes) {
    return accepts([&] {
        const RadPlan plan = rad_plan(decode_rad_file(bytes, "mutant.rif"));
        const RadZone zone = plan.zone.value_or(RadZone{true, {0, 0, 0}, {1, 1, 1}});
        for (const RadView& view : plan.views) (void)rad_view_words(plan, view, zone);
        for (const RadValue& value : plan.render) (void)words_of(value);
        (void)rad_light_words(plan);
        (void)rad_ambient_resolution(plan, zone, 1);
        (void)rad_scatter_step(plan, zone);
        (void)find_rad_view(plan, "1");
    });
}

bool read_luminaire(std::string_view bytes) {
    const auto show = [](const Photometry& photometry) {
        (void)luminaire_scene(photometry, {"mutant", "mutant.dat"});
        (void)decode_data(luminaire_data(photometry), "mutant.dat");
    };
    const bool ies = accepts([&] {
        const IesFile file = decode_ies(bytes, "mutant.ies");
        show(file.photometry);
        if (file.tilt) (void)decode_data(tilt_data(*file.tilt), "mutant.dat");
    });
    const bool lamps = accepts([&] {
        const LampTable table(bytes, "mutant.tab");
        if (const auto lamp = table.find("a cool white fluorescent lamp")) (void)lamp->color();
    });
    const bool ldt = accepts([&] { show(decode_eulumdat(bytes, "mutant.ldt").photometry); });
    return ies || lamps || ldt;
}

bool read_wavefront(std::string_view bytes) {
    const bool object = accepts([&] {
        const ObjFile file = decode_obj(bytes, "mutant.obj");
        MemoryResources resources;
        resources.meshes["mutant"] =
            std::make_shared<const MeshModel>(mesh_of_obj(file, std::nullopt, {}));
        for (const ObjFile::Face& face : file.faces) (void)triangulate(file, face, 1);
        Silence silence;
        SceneReadOptions options;
        options.library = LibraryPath(std::vector<std::string>{});
        trace_some(parse_scene("void plastic p 0 0 5 .5 .5 .5 0 0\np mesh m 1 mutant 0 0\n",
                               "mutant.rad", options, silence),
                   resources);
    });
    const bool materials = accepts([&] {
        Silence silence;
        SceneReadOptions options;
        options.library = LibraryPath(std::vector<std::string>{});
        for (const MtlMaterial& material : decode_mtl(bytes, "mutant.mtl"))
            trace_some(parse_scene(mtl_scene(material, {}), "mutant.rad", options, silence));
    });
    return object && materials;
}

bool read_gltf_file(std::string_view bytes) {
    return accepts([&] {
        const GltfFile file = decode_gltf(bytes, "mutant.glb", [](const std::string& path) {
            if (path == "a.bin") return SmallGltf{}.buffer();
            throw InputError({path, 0}, "cannot open");
        });
        MemoryResources resources;
        std::string text = "void plastic p 0 0 5 .5 .5 .5 0 0\n";
        for (std::size_t i = 0; i < file.parts.size(); ++i) {
            const std::string number = std::to_string(i);
            resources.meshes["m" + number] = file.parts[i];
            std::string material = "p";
            if (i < file.materials.size()) {
                material = file.materials[i].name;
                text += gltf_material_scene(file.materials[i], {}, false);
            }
            append_primitive(material, "mesh", "m", {"m" + number}, {}, kFullDigits, text);
        }
        for (const GltfLight& light : file.lights) text += gltf_light_scene(light, "l");
        Silence silence;
        SceneReadOptions options;
        options.library = LibraryPath(std::vector<std::string>{});
        trace_some(parse_scene(text, "mutant.rad", options, silence), resources);
    });
}

bool read_image(std::string_view bytes) {
    return accepts([&] {
        for (const auto channels :
             {ImageChannels::color, ImageChannels::alpha, ImageChannels::numbers})
            (void)interpolate(decode_image(bytes, "mutant.png", channels), 0.4, 0.7);
    });
}

bool read_layers(std::string_view bytes) {
    return accepts([&] {
        const LayersHeader header = read_layers_header(bytes, "mutant.exr");
        Picture sum{header.width, header.height, {}};
        sum.pixels.resize(static_cast<std::size_t>(header.width) *
                          static_cast<std::size_t>(header.height));
        add_layers(bytes, "mutant.exr", std::vector<Rgb>(header.names.size(), {1, 1, 1}), sum);
    });
}

bool read_walk_request(std::string_view bytes) {
    return accepts([&] {
        const WalkRequest request = parse_walk_request(bytes);
        if (const auto* view = std::get_if<ViewRequest>(&request)) (void)Camera(view->view);
    });
}

bool read_walk_frame(std::string_view bytes) {
    const auto frame = parse_walk_frame(bytes);
    if (frame && encode_walk_frame(frame->header, frame->pieces).size() != bytes.size())
        throw std::logic_error("a frame's pieces are not all of it");
    return frame.has_value();
}

bool read_frozen(std::string_view bytes) {
    return accepts([&] {
        const auto memory = std::make_shared<std::vector<std::uint64_t>>(bytes.size() / 8 + 1);
        std::ranges::copy(bytes, reinterpret_cast<char*>(memory->data()));
        const auto all = std::as_bytes(std::span(*memory)).first(bytes.size());
        FrozenScene frozen(FrozenFile(memory, all, "mutant.lwz"));
        trace_some(frozen.model(), frozen);
    });
}

bool read_resealed(std::string_view bytes) {
    return read_frozen(resealed(std::string(bytes)));
}

}  // namespace lightwalk::test
