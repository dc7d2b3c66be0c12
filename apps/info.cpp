// lightwalk info: what a scene holds.
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <string>

#include "apps/commands.h"
#include "apps/common_options.h"
#include "apps/rad_command.h"
#include "apps/session/scene_session.h"
#include "apps/warnings.h"
#include "core/bsdf/bsdf.h"
#include "core/light/light_sources.h"
#include "io/ambient/ambient_file.h"

namespace lightwalk {
namespace {

void print_bounds(const Bounds& bounds) {
    std::printf("bounds [m]%s\n", bounds.empty() ? "     empty" : "");
    if (bounds.empty()) return;
    for (const auto& [label, v] : {std::pair{"lower", bounds.lower}, {"upper", bounds.upper}})
        std::printf("  %-12s %g %g %g\n", label, v.x, v.y, v.z);
}

void print_counts(const Model& model) {
    std::map<PrimitiveType, std::size_t> counts;
    for (const Primitive& modifier : model.modifiers) ++counts[modifier.type];
    for (std::size_t i = 0; i < model.surfaces.size(); ++i) ++counts[model.surfaces.type(i)];
    std::printf("primitives     %zu\n", model.size());
    for (const auto& [type, count] : counts)
        std::printf("  %-12s %zu\n", std::string(to_string(type)).c_str(), count);
}

/// What a table holds: "matrix 145 x 145", "tree of rank 4, 16 MB".
std::string table_words(const BsdfTable& table) {
    if (const auto* matrix = std::get_if<BsdfMatrix>(&table)) {
        return "matrix " + std::to_string(matrix->incident.size()) + " x " +
               std::to_string(matrix->exitant.size());
    }
    const TensorTree& tree = std::get<BsdfTree>(table).y;
    const std::size_t leaves =
        tree.nodes().empty() ? 1 : tree.nodes().size() - tree.nodes().size() / tree.children() + 1;
    return "tree of rank " + std::to_string(tree.rank()) + ", " + std::to_string(leaves) +
           " leaves";
}

/// The BSDF files in use, each component with its largest hemispherical total.
void print_bsdfs(const Scene& scene) {
    constexpr std::array<const char*, kBsdfParts> kNames = {
        "transmission front", "transmission back", "reflection front", "reflection back"};
    std::set<const Bsdf*> all;
    for (std::size_t i = 0; i < scene.modifier_count(); ++i) {
        const auto& node = scene.modifier(ModifierId{static_cast<std::int32_t>(i)}).node;
        const Bsdf* bsdf = node ? node->bsdf() : nullptr;
        if (!bsdf || !all.insert(bsdf).second) continue;
        if (all.size() == 1) std::puts("BSDF files, with their largest totals");
        std::printf("  %s, %.1f MB\n", printable(bsdf->data().name).c_str(),
                    1e-6 * static_cast<double>(bsdf->own_bytes()));
        for (std::size_t part = 0; part < kBsdfParts; ++part) {
            const std::optional<BsdfTable>& table = bsdf->data().parts[part];
            if (!table) continue;
            std::printf("    %-18s %5.1f %%, %s\n", kNames[part],
                        100 * bsdf->largest_total(static_cast<BsdfPart>(part)),
                        table_words(*table).c_str());
        }
        if (!bsdf->data().geometry.empty()) {
            std::printf("    geometry           %.1f kB of MGF, for pkgBSDF\n",
                        1e-3 * static_cast<double>(bsdf->data().geometry.size()));
        }
    }
}

void print_geometry(const Scene& scene) {
    const Bounds bounds = scene.geometry().bounds();
    print_bounds(bounds);
    if (!bounds.empty())
        std::printf("  %-12s %g at %g %g %g\n", "cube", scene.cube().size, scene.cube().origin.x,
                    scene.cube().origin.y, scene.cube().origin.z);
    const std::size_t own = scene.own_surfaces();
    const std::size_t all =
        scene.surfaces().size() - 1;  // without the one that stands for a sensor
    std::printf("surfaces       %zu, and %zu inside instances\n", own, all - own);
    std::printf("instances      %zu placed\n", scene.geometry().instance_count());
}

void print_lights(const Scene& scene, const LightSources& lights) {
    constexpr int kMostLines = 100;
    std::printf("light sources  %zu real, %zu virtual\n",
                lights.all().size() - lights.virtual_count(), lights.virtual_count());
    int lines = 0;
    for (const LightSource& light : lights.all()) {
        if (light.is_virtual()) continue;
        if (++lines > kMostLines) {
            std::puts("  ...");
            return;
        }
        const Surface surface = scene.surface(light.object);
        std::printf("  %-12s %s (%s)%s\n", std::string(to_string(light.material_type)).c_str(),
                    printable(surface.name()).c_str(),
                    std::string(to_string(surface.type())).c_str(),
                    light.unusable ? ", not sampled" : "");
    }
}

/// Throws InputError for a scene of which a ray may meet what cannot be shaded.
void expect_all_files(const Scene& scene) {
    for (std::size_t i = 0; i < scene.modifier_count(); ++i) {
        const auto& node = scene.modifier(ModifierId{static_cast<std::int32_t>(i)}).node;
        if (node && node->problem() != nullptr) throw InputError(*node->problem());
    }
}

/// How many files a frozen scene was made from.
void print_origin(const FrozenScene& frozen) {
    const auto files = std::ranges::count_if(frozen.manifest(), &ManifestFile::exists);
    std::printf("frozen         from %td files\n", files);
}

/// What weighs how much, and the most that the process held.
void print_memory(const SceneSession& session) {
    const SceneMemory memory = session.scene().memory();
    const auto megabytes = [](std::uint64_t bytes) { return 1e-6 * static_cast<double>(bytes); };
    const auto print = [&](const char* label, std::size_t bytes, std::size_t things,
                           const char* thing) {
        if (bytes == 0) return;
        std::printf("  %-12s %.1f", label, megabytes(bytes));
        if (things > 0)
            std::printf(", %.0f bytes a %s",
                        static_cast<double>(bytes) / static_cast<double>(things), thing);
        std::puts("");
    };
    std::puts("memory [MB]");
    print("as read", memory.surfaces, memory.surface_count, "surface");
    print("shapes", memory.shapes, memory.surface_count, "surface");
    print("meshes", memory.meshes, memory.triangle_count, "triangle");
    print("search tree", memory.search.tree, memory.surface_count + memory.triangle_count,
          memory.triangle_count == 0 ? "surface" : "surface or triangle");
    print("around it", memory.search.tables, 0, "");
    print("mapped", memory.mapped, 0, "");
    std::printf("  %-12s %.1f after reading, %.1f after building\n", "peak",
                megabytes(session.cost().read_peak_bytes),
                megabytes(session.cost().build_peak_bytes));
}

/// Count, levels, radii and bounds of an ambient file.
void print_ambient_file(const std::string& path) {
    const AmbientFile file = decode_ambient_file(read_file(path), path);
    std::map<int, std::size_t> levels;
    Bounds bounds;
    double least = kHuge, most = 0;
    for (const AmbientRecord& record : file.records) {
        ++levels[record.level];
        bounds.extend({static_cast<double>(record.position[0]),
                       static_cast<double>(record.position[1]),
                       static_cast<double>(record.position[2])});
        least = std::min(least, static_cast<double>(record.radius[0]));
        most = std::max(most, static_cast<double>(record.radius[1]));
    }
    for (const std::string& line : file.header) std::printf("%s\n", printable(line).c_str());
    std::printf("values         %zu\n", file.records.size());
    for (const auto& [level, count] : levels) std::printf("  level %-6d %zu\n", level, count);
    if (!file.records.empty()) {
        std::printf("radii [m]      %g to %g\n", least, most);
        print_bounds(bounds);
    }
    if (!file.damage.empty()) std::printf("damage         %s\n", printable(file.damage).c_str());
}

/// The views and rpict's options of a rad file.
void print_rad_plan(const RadPlan& plan, const Scene& scene) {
    std::string views, options;
    for (std::size_t i = 0; i < plan.views.size(); ++i)
        views += (i > 0 ? ", " : "") + plan.views[i].title(i + 1);
    for (const std::string& word : rad_option_words(plan, scene)) options += ' ' + word;
    std::printf("views          %s\n", printable(views).c_str());
    std::printf("options       %s\n", printable(options).c_str());
}

OptionTable info_table(CommonOptions& options) {
    return {{options.command, kInfo},
            {render_option_rows(options.settings, LibraryPath::from_environment()),
             common_option_rows(options)},
            {"-dr", "-n", "-w", "--allow-commands", "--stale", "--quiet"}};
}

}  // namespace

OptionTable info_option_table() {
    return owning_table(CommonOptions("info"), info_table);
}

int run_info(const std::vector<std::string>& line, Communicator* /*ranks*/) {
    CommonOptions options("info");
    const auto read = [&] { read_command_line(OptionWords(line), info_table(options), options); };
    read();
    const RadPlanPtr plan = named_rad_plan(options, *real_files());
    if (plan) {
        options = CommonOptions("info");
        take_rad_light(*plan, options.settings, real_files());
        read();
        take_rad_scene(*plan, options);
    }
    RenderSettings& settings = options.settings;
    settings.light.shadow_threshold = 0;  // no statistics of shadows: nothing is rendered
    StderrWarnings warnings(options.program());
    warnings.enable(settings.warnings && !options.quiet);
    if (plan)
        for (const std::string& notice : plan->notices) warnings.warn(notice);
    if (options.scene_files().size() == 1 && options.scene_files()[0].ends_with(".amb")) {
        print_ambient_file(options.scene_files()[0]);
        return kSuccessStatus;
    }
    resolve_scene_files(options, "", *real_files());
    const auto scene = std::make_shared<CompiledScene>(options.request.source, warnings);
    if (scene->frozen() != nullptr) print_origin(*scene->frozen());
    print_counts(scene->model());
    scene->compile();
    if (plan) {
        print_rad_plan(*plan, scene->scene());
        settle_rad_light(*plan, scene->scene(), settings.light);
    }
    const SceneSession session(scene, settings.light, settings.ambient_file, OthersValues::taken,
                               false, warnings);
    print_geometry(session.scene());
    print_lights(session.scene(), session.tracer().lights());
    print_bsdfs(session.scene());
    print_memory(session);
    std::printf("time           %.2f s to read, %.2f s to build\n", session.cost().read_seconds,
                session.cost().build_seconds);
    expect_all_files(session.scene());
    return kSuccessStatus;
}

}  // namespace lightwalk
