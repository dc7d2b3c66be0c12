// lightwalk trace: single rays, as rtrace answers them.
#include <chrono>
#include <cstdio>
#include <optional>
#include <utility>

#include "apps/command_run.h"
#include "apps/ray_stream.h"
#include "apps/serve/scene_server.h"
#include "apps/session/render_backend.h"
#include "apps/session/run_header.h"
#include "apps/session/stopwatch.h"
#include "apps/trace_command.h"

namespace lightwalk {
namespace {

constexpr std::size_t kEnough = 1 << 16;  ///< bytes of output that are worth writing

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
        Renderer renderer = open_renderer(ranks, task());
        const RenderBackend& backend = renderer.backend();
        if (backend.leads() && options_.shade) backend.session().warn_of_darkness();
        if (tree_) tree_->watch(backend.session().tracer());
        scene_ = &backend.session().scene();
        double seconds = 0;
        renderer.run([&] {
            const Stopwatch watch;
            put_header(backend.session().compiled().model());
            answer_all(renderer);
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
        statistics.render_seconds = seconds;
        save_statistics(std::move(statistics));
        return kSuccessStatus;
    }

    [[nodiscard]] RendererRequest task() {
        RendererRequest task = request();
        task.options.answers_rays = true;
        if (tree_) task.options.observer = &*tree_;
        task.options.record = [this](const RayQuery& query, const Ray& ray, const Hit& first,
                                     std::string& bytes) {
            if (tree_) bytes += tree_->take();
            const bool sensor = options_.sensor && length_squared(query.direction) > 0;
            if (records_) records_->append({ray, first, sensor}, *scene_, bytes);
        };
        return task;
    }

    [[nodiscard]] const RayReader& reader() const { return stream_.reader(); }
    [[nodiscard]] RenderOptions& light() { return command_.common.settings.light; }

    void answer_all(Renderer& renderer) {
        stream_.answer_all(
            renderer,
            [this](const std::string& bytes) {
                output_ += bytes;
                if (output_.size() >= kEnough) flush();
            },
            [this] { flush(); });
    }

    // Input and output.

    void prepare_output() {
        const OutputFields fields = parse_output_fields(command_.letters);
        const NumberFormat format = command_.formats.output;
        if (!fields.record.empty() || !fields.has_tree())
            records_.emplace(fields.record, format, command_.color);
        if (!fields.has_tree()) return;
        tree_.emplace(fields, format, command_.color, command_.tree, options_.sensor);
        command_.common.set_threads(1);  // trees are told one after the other
        command_.common.request.options.executor = ExecutorKind::serial;
    }

    [[nodiscard]] bool shades() const { return tree_ || records_->shades(); }

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
            output_ += tree_ ? tree_->header_end(text.size()) : records_->header_end(text.size());
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
    RayListOptions& options_;            ///< of the command
    std::optional<RayRecords> records_;  ///< not with trees alone
    std::optional<RayTree> tree_;        ///< -ot -oT
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
