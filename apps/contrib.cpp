// lightwalk contrib: what light sources bring to single rays, as rcontrib tells it.
#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>

#include "apps/command_run.h"
#include "apps/contrib_command.h"
#include "apps/interrupt.h"
#include "apps/ray_stream.h"
#include "apps/session/render_backend.h"
#include "apps/session/run_header.h"
#include "apps/session/stopwatch.h"
#include "io/contributions/contribution_tally.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;  ///< of answers that wait to be written
constexpr std::size_t kPart = std::size_t{1} << 18;        ///< of them, written at once [bytes]
constexpr std::size_t kMostLongRays = 1024;                ///< with indirect light, at once
constexpr double kCacheAccuracy = 0.2;                     ///< -aa, with --cache and -aa 0

class ContribRun final : CommandRun {
  public:
    ContribRun(ContribCommand& command, Communicator* communicator, FileSource& files)
        : CommandRun(command.common, communicator),
          command_(command),
          stream_(command.formats.input) {
        resolve_scene_files(command_.common, "the rays", files);
        if (command_.modifiers.empty())
            throw UsageError("no modifier is named: expected -m MODIFIER or -M FILE");
        if (command_.next_open)
            throw UsageError(
                "options -o -b -bn -p hold for the modifiers behind them: expected -m");
        if (command_.formats.input == NumberFormat::rgbe)
            throw UsageError("option -f: format c is for output only");
        for (const ModifierRequest& request : command_.modifiers) {
            tracked_.push_back({request.name,
                                command_.definitions.bin(request.bin, request.parameters),
                                static_cast<std::size_t>(request.bins)});
            outputs_.push_back({request.output, request.name, tracked_.back().bins});
        }
        (void)contribution_outputs(outputs_);  // what is wrong with names is told at once
        if (std::any_of(outputs_.begin(), outputs_.end(),
                        [](const OutputRequest& request) { return request.specification.empty(); }))
            use_standard_output();
        settle_light();
        if (command_.cache) settle_cache();
    }

    int run() {
        join(task().options);
        const int status = share_out([this] { return trace(); });
        // After the answers to all rays before it, and when no rank waits for another any more.
        if (speaks() && status == kSuccessStatus) {
            if (!stream_.reader().problem().empty()) throw InputError(stream_.reader().problem());
            if (stream_.ended_early())
                throw InputError("standard input: it ends before the rays that -x and -y ask for");
        }
        return status;
    }

  private:
    /// Contributions come neither from a cache nor from differences.
    void settle_light() {
        RenderSettings& settings = command_.common.settings;
        if (!settings.ambient_file.empty())
            throw UsageError("option -af: contributions are not kept in ambient files");
        if (settings.light.ambient_super_samples > 0)
            warnings().warn("-as counts as 0: contributions tell no places that need more samples");
        if (settings.light.ambient_accuracy > 0 && !command_.cache)
            warnings().warn("-aa counts as 0: without --cache contributions are not interpolated");
        if (!command_.cache)
            settings.light.ambient_accuracy = 0;
        else if (settings.light.ambient_accuracy <= 0)
            settings.light.ambient_accuracy = kCacheAccuracy;
        settings.light.ambient_super_samples = 0;
        settings.light.shadow_threshold = 0;
    }

    void settle_cache() {
        for (const TrackedModifier& modifier : tracked_) {
            if (depends_on_position(modifier.bin))
                throw UsageError("option --cache: the bins of modifier \"" + modifier.name +
                                 "\" depend on place (Px Py Pz), which is not kept: expected Dx Dy "
                                 "Dz alone");
        }
        if (command_.common.settings.light.ambient_bounces < 2)
            warnings().warn("--cache changes nothing: it is for -ab 2 and more");
    }

    int trace() {
        Renderer renderer = open_renderer(ranks(), task());
        const RenderBackend& backend = renderer.backend();
        double seconds = 0;
        if (backend.leads()) warn_of_missing(backend.session().scene());
        renderer.run([&] {
            const Stopwatch watch;
            ContributionFiles files(writing(backend.session().compiled().model()));
            answer_all(renderer, files);
            seconds = watch.seconds();
        });
        if (!backend.leads()) return kSuccessStatus;
        RunStatistics statistics = backend.statistics();
        statistics.render_seconds = seconds;
        save_statistics(std::move(statistics));
        return stream_.is_complete() ? kSuccessStatus : kInterruptedStatus;
    }

    [[nodiscard]] RendererRequest task() {
        RendererRequest task = request();
        task.options.answers_rays = true;
        task.options.long_rays = indirect();
        task.options.keep_coefficients = keeps_coefficients();
        task.options.make_tally = [this](const Tracer& tracer) {
            return std::make_unique<ContributionTally>(tracer, tracked_, command_.values,
                                                       warnings());
        };
        return task;
    }

    [[nodiscard]] bool indirect() const {
        return command_.common.settings.light.ambient_bounces > 0;
    }

    [[nodiscard]] bool keeps_coefficients() const {
        return command_.cache && command_.common.settings.light.ambient_bounces > 1;
    }

    void warn_of_missing(const Scene& scene) {
        for (const std::string& name : missing_modifiers(scene, tracked_))
            warnings().warn("the scene has no modifier \"" + name + "\": it brings nothing");
    }

    [[nodiscard]] ContributionWriting writing(const Model& model) const {
        ContributionWriting writing;
        writing.outputs = contribution_outputs(outputs_);
        writing.format = {command_.formats.output, command_.x, command_.y};
        writing.with_header = command_.header;
        writing.history = history_header(model.header, command_.common.request.history);
        for (const std::string& line : date_lines()) writing.history.push_back(line);
        writing.rays = command_.rays;
        writing.existing = command_.existing;
        return writing;
    }

    [[nodiscard]] RayStreamLimits limits() const {
        RayStreamLimits limits;
        const auto x = static_cast<std::uint64_t>(std::max(command_.x, 0));
        const auto y = static_cast<std::uint64_t>(std::max(command_.y, 0));
        limits.expected =
            y * std::max<std::uint64_t>(x, 1) * static_cast<std::uint64_t>(command_.rays);
        limits.row = command_.x;
        limits.waits = keeps_coefficients();
        limits.most = std::clamp<std::size_t>(kMostBytes / answer_bytes(), 1, limits.most);
        if (indirect()) limits.most = std::min(limits.most, kMostLongRays);
        return limits;
    }

    /// Of the answer to a ray.
    [[nodiscard]] std::size_t answer_bytes() const {
        return 3 * sizeof(double) * column_count(tracked_);
    }

    void answer_all(Renderer& renderer, ContributionFiles& files) {
        stream_.limit(limits());
        const auto put = [&] { write_to_stdout(files.take_standard_output()); };
        put();
        if (!stream_.skip(files.rays_done()))
            throw InputError("standard input ends before the rays whose records exist (-r)");
        stream_.answer_all(
            renderer,
            [&](const std::string& answers) {
                // Records go out while they are in the processor's caches.
                const std::size_t part =
                    answer_bytes() * std::max<std::size_t>(1, kPart / answer_bytes());
                for (std::string_view rest = answers; !rest.empty();
                     rest.remove_prefix(std::min(part, rest.size()))) {
                    files.add(rest.substr(0, part));
                    put();
                }
                files.flush();
            },
            put);
        if (!stream_.is_complete() || !stream_.reader().problem().empty() || stream_.ended_early())
            return;  // files stay parts
        if (files.finish())
            warnings().warn("the last record is the mean of fewer rays than the others");
        put();
    }

    ContribCommand& command_;
    std::vector<TrackedModifier> tracked_;
    std::vector<OutputRequest> outputs_;
    RayStream stream_;
};

}  // namespace

int run_contrib(const std::vector<std::string>& words, Communicator* ranks) {
    return run_command<ContribRun>(ContribCommand{}, words, ranks);
}

}  // namespace lightwalk
