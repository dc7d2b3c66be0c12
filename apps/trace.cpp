// lightwalk trace: single rays, as rtrace answers them.
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "apps/command_run.h"
#include "apps/ray_stream.h"
#include "apps/serve/scene_server.h"
#include "apps/session/local_backend.h"
#include "apps/session/render_backend.h"
#include "apps/session/replications.h"
#include "apps/session/run_header.h"
#include "apps/session/stopwatch.h"
#include "apps/trace_command.h"
#include "io/rays/ray_intervals.h"

namespace lightwalk {
namespace {

constexpr std::size_t kEnough = 1 << 16;         ///< bytes of output that are worth writing
constexpr std::size_t kAnswersAtOnce = 1 << 18;  ///< with --interval: they are kept in memory

TraceCommand rtrace_command() {
    TraceCommand command;
    command.common.called = "rtrace";
    command.common.request.source.allow_commands = true;
    command.common.set_threads(1);
    return command;
}

class TraceRun final : CommandRun {
  public:
    TraceRun(TraceCommand& command, Communicator* communicator, FileSource& files)
        : CommandRun(command.common, communicator),
          command_(command),
          options_(command.common.request.options.rays),
          stream_(command.formats.input) {
        use_standard_output();
        prepare_output();
        resolve_scene_files(command_.common, "the rays", files);
        check();
        if (command_.interval > 0) check_interval(communicator);
        options_.shade = shades() || options_.sensor;
        if (options_.shade) return;
        // Nothing is lit: do not prepare light sources.
        light().redirections = 0;
        light().shadow_threshold = 0;
    }

    int run() {
        if (command_.serve) return serve();
        join(task().options);
        int status = kSuccessStatus;
        if (!tree_)
            status = share_out([this] { return trace(ranks()); });
        else if (speaks())
            status = trace(nullptr);  // trees are told one after the other
        // After the answers to all rays before it, and when no rank waits for another any more.
        if (speaks() && !reader().problem().empty()) throw InputError(reader().problem());
        return status;
    }

  private:
    /// Stands ready for rtrace, whose defaults count: this process traces no ray.
    int serve() {
        if (command_.common.scene_files().size() != 1 || !speaks())
            throw UsageError("option --serve: expected one octree, and one process");
        return serve_scene(rtrace_command().common.request.source,
                           command_.common.scene_files().front(),
                           std::chrono::duration<double>(command_.idle));
    }

    /// @param ranks  that share the rays; null: this process does all
    int trace(Ranks* ranks) {
        std::vector<Renderer> renderers;
        renderers.push_back(open_renderer(ranks, task()));
        const RenderBackend& backend = renderers.front().backend();
        if (backend.leads() && options_.shade) backend.session().warn_of_darkness();
        if (tree_) tree_->watch(backend.session().tracer());
        scene_ = &backend.session().scene();
        for (int k = 1; k < command_.interval; ++k)
            renderers.emplace_back(std::make_unique<LocalBackend>(
                backend.session().shared_compiled(), another(backend.options(), k)));
        double seconds = 0;
        renderers.front().run([&] {
            const Stopwatch watch;
            put_header(backend.session().compiled().model());
            answer_all(renderers);
            if (stream_.ended_early()) warnings().warn("unexpected EOF on input");
            if (reader().misaligned_line() > 0)
                warnings().warn("standard input:" + std::to_string(reader().misaligned_line()) +
                                ": a ray begins within this line and ends in another one, "
                                "expected six numbers a line");
            flush();
            seconds = watch.seconds();
        });
        if (!backend.leads()) return kSuccessStatus;
        RunStatistics statistics = backend.statistics();
        for (Renderer& other : std::span(renderers).subspan(1))
            statistics.add_work(other.backend().statistics());
        statistics.render_seconds = seconds;
        save_statistics(std::move(statistics));
        return kSuccessStatus;
    }

    [[nodiscard]] RendererRequest task() {
        RendererRequest task = request();
        task.options.answers_rays = true;
        if (tree_) task.options.observer = &*tree_;
        if (intervals_) {
            task.options = replication_options(std::move(task.options), 0);
            task.options.record = recorder(0);
            return task;
        }
        task.options.record = [this](const RayQuery& query, const Ray& ray, const Hit& first,
                                     std::string& bytes) {
            if (tree_) bytes += tree_->take();
            if (records_) records_->append(record_of(query, ray, first), *scene_, bytes);
        };
        return task;
    }

    [[nodiscard]] RayRecord record_of(const RayQuery& query, const Ray& ray,
                                      const Hit& first) const {
        return {ray, first, options_.sensor && length_squared(query.direction) > 0};
    }

    // Of several answers to a ray.

    /// What a renderer does that gives answer `k`, from 1 on; `first` as the scene has settled it.
    [[nodiscard]] RendererOptions another(RendererOptions first, int k) {
        first.light.seed = light().seed;
        RendererOptions options = replication_options(std::move(first), k);
        options.record = recorder(k);
        return options;
    }

    [[nodiscard]] decltype(RendererOptions::record) recorder(int answer) {
        return [this, answer](const RayQuery& query, const Ray& ray, const Hit& first,
                              std::string& bytes) {
            intervals_->append(record_of(query, ray, first), *scene_, answer, bytes);
        };
    }

    [[nodiscard]] const RayReader& reader() const { return stream_.reader(); }
    [[nodiscard]] RenderOptions& light() { return command_.common.settings.light; }

    void answer_all(std::span<Renderer> renderers) {
        stream_.answer_all(
            renderers,
            [this](std::span<const std::string> answers) {
                output_ += intervals_ ? intervals_->join(answers) : answers.front();
                if (output_.size() >= kEnough) flush();
            },
            [this] { flush(); });
    }

    // Input and output.

    void prepare_output() {
        const OutputFields fields = parse_output_fields(command_.letters);
        const NumberFormat format = command_.formats.output;
        if (command_.interval > 0) {
            if (fields.has_tree())
                throw UsageError("option --interval: trees of rays (-ot, -oT) have no intervals");
            intervals_.emplace(fields.record, format, command_.color);
        }
        if (!fields.record.empty() || !fields.has_tree())
            records_.emplace(fields.record, format, command_.color);
        if (!fields.has_tree()) return;
        tree_.emplace(fields, format, command_.color, command_.tree, options_.sensor);
        command_.common.set_threads(1);  // trees are told one after the other
        command_.common.request.options.executor = ExecutorKind::serial;
    }

    [[nodiscard]] bool shades() const { return tree_ || records_->shades(); }

    void check_interval(const Communicator* communicator) const {
        if ((communicator != nullptr && communicator->size() > 1) ||
            !command_.common.ranks.timeline.empty())
            throw UsageError(
                "option --interval: is for one process: neither ranks nor --timeline go with it");
        if (command_.serve) throw UsageError("option --interval: --serve traces nothing");
        if (!command_.common.settings.ambient_file.empty())
            throw UsageError(
                "option --interval: answers that share an ambient file (-af) are not independent "
                "of "
                "each other");
    }

    void check() {
        const bool irradiance = options_.sensor || light().irradiance;
        if (irradiance && !shades())
            throw UsageError("-I+ and -i+ options require some value output");
        if (irradiance && records_ && records_->splits())
            warnings().warn("-or -oR -ox -oX say nothing with -i or -I");
        if (records_ && records_->asks_for_coefficients())
            warnings().warn("-oVW options require trace mode");
        // Values from the cache or by differences are not the sum of what the rays brought.
        const bool exact = light().ambient_bounces <= 0 || (light().ambient_accuracy <= kEpsilon &&
                                                            light().ambient_super_samples <= 0);
        if (tree_ && !exact && tree_->asks_for_coefficients())
            warnings().warn("-otV and -otW are only accurate with -aa 0 -as 0");
        RayStreamLimits limits;
        if (command_.interval > 0)
            limits.most = kAnswersAtOnce / static_cast<std::size_t>(command_.interval);
        limits.row = command_.x;
        if (command_.y > 0)
            limits.expected =
                static_cast<std::uint64_t>(command_.y) *
                (command_.x > 1 && command_.y > 1 ? static_cast<std::uint64_t>(command_.x) : 1);
        stream_.limit(limits);
    }

    void put_header(const Model& model) {
        if (command_.header) {
            std::string text = "#?RADIANCE\n";
            for (const std::string& line :
                 history_header(model.header, command_.common.request.history))
                text += line + '\n';
            for (const std::string& line : date_lines()) text += line + '\n';
            output_ += text;
            output_ += tree_        ? tree_->header_end(text.size())
                       : intervals_ ? intervals_->header_end(text.size())
                                    : records_->header_end(text.size());
        }
        if (command_.x > 0 && command_.y > 0) {
            char line[64];
            std::snprintf(line, sizeof line, "-Y %8d +X %8d\n", command_.y, command_.x);
            output_ += line;
        }
        if (!output_.empty()) flush();
    }

    void flush() {
        write_to_stdout(output_);
        output_.clear();
    }

    TraceCommand& command_;
    RayListOptions& options_;                ///< of the command
    std::optional<RayRecords> records_;      ///< not with trees alone
    std::optional<RayTree> tree_;            ///< -ot -oT
    std::optional<RayIntervals> intervals_;  ///< --interval
    RayStream stream_;
    const Scene* scene_ = nullptr;  ///< that records name parts of
    std::string output_;
};

}  // namespace

int run_trace(const std::vector<std::string>& words, Communicator* ranks) {
    return run_command<TraceRun>(TraceCommand{}, words, ranks);
}

int run_rtrace(const std::vector<std::string>& words, Communicator* ranks) {
    return run_command<TraceRun>(rtrace_command(), words, ranks);
}

int run_rtrace_on(const std::shared_ptr<const ResidentScene>& scene,
                  const std::vector<std::string>& words) {
    TraceCommand command = rtrace_command();
    command.common.request.resident = scene;
    return run_command<TraceRun>(std::move(command), words, nullptr);
}

}  // namespace lightwalk
