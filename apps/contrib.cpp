// lightwalk contrib: what light sources bring to single rays, as rcontrib tells it.
#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

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

constexpr std::size_t kPart = std::size_t{1} << 18;  ///< of answers, written at once [bytes]

class ContribRun final : CommandRun {
  public:
    ContribRun(ContribCommand& command, Communicator* communicator, FileSource& files)
        : CommandRun(command.common, communicator),
          command_(command),
          stream_(command.formats.input) {
        resolve_scene_files(command_.common, "the rays", files);
        tracked_ = tracked_modifiers(command_);
        if (command_.formats.input == NumberFormat::rgbe)
            throw UsageError("option -f: format c is for output only");
        for (std::size_t i = 0; i < tracked_.size(); ++i)
            outputs_.push_back({command_.modifiers[i].output, tracked_[i].name, tracked_[i].bins});
        (void)contribution_outputs(outputs_);  // what is wrong with names is told at once
        if (std::any_of(outputs_.begin(), outputs_.end(),
                        [](const OutputRequest& request) { return request.specification.empty(); }))
            use_standard_output();
        settle_contrib_command(command_, tracked_, warnings());
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
        task.options.make_tally = [this](const Tracer& tracer) {
            return std::make_unique<ContributionTally>(tracer, tracked_, command_.values,
                                                       warnings());
        };
        return task;
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
        limits.waits = command_.common.request.options.keep_coefficients;
        limits.most = rays_at_once(command_, tracked_);
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

int run_rcontrib(const std::vector<std::string>& words, Communicator* ranks) {
    ContribCommand command;
    command.common.called = "rcontrib";
    command.common.request.source.allow_commands = true;
    command.common.set_threads(1);
    return run_command<ContribRun>(std::move(command), words, ranks);
}

}  // namespace lightwalk
