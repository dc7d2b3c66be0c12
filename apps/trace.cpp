// lightwalk trace: single rays, as rtrace answers them.
#include <unistd.h>

#include <cstdio>
#include <deque>
#include <optional>

#include "apps/command_run.h"
#include "apps/interrupt.h"
#include "apps/session/render_backend.h"
#include "apps/session/run_header.h"
#include "apps/session/stopwatch.h"
#include "apps/trace_command.h"

namespace lightwalk {
namespace {

constexpr std::size_t kEnough = 1 << 16;  ///< bytes of output that are worth writing

class TraceRun final : CommandRun {
  public:
    TraceRun(TraceCommand& command, Communicator* communicator, FileSource& files)
        : CommandRun(command.common, communicator),
          command_(command),
          options_(command.common.request.options.rays),
          reader_(STDIN_FILENO, command.formats.input) {
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
        join(task().options);
        int status = kSuccessStatus;
        if (!tree_)
            status = share_out([this] { return trace(ranks()); });
        else if (speaks())
            status = trace(nullptr);  // trees are told one after the other
        // After the answers to all rays before it, and when no rank waits for another any more.
        if (speaks() && !reader_.problem().empty()) throw InputError(reader_.problem());
        return status;
    }

  private:
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
            if (expected_ > 0 && read_ < expected_) warnings().warn("unexpected EOF on input");
            if (reader_.misaligned_line() > 0)
                warnings().warn("standard input:" + std::to_string(reader_.misaligned_line()) +
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

    [[nodiscard]] RenderOptions& light() { return command_.common.settings.light; }

    /// All rays to the renderer, as many at a time as it asks for; their answers to the output.
    void answer_all(Renderer& renderer) {
        bool more = true, wanted = true;
        while (!interrupt_flag().requested() && (more || !lists_.empty())) {
            // Where there is nothing to read for, something else has to come.
            const RayDemand demand = renderer.ray_demand(!(more && wanted));
            wanted = demand.lists > 0;
            if (demand.answered) {
                if (!put_answer(renderer)) return;
            } else if (more && wanted) {
                more = read_batch(demand.rays);
                if (more) give_batch(renderer);
            }
        }
    }

    void give_batch(Renderer& renderer) {
        const std::uint64_t first = read_ - queries_.size();
        lists_.push_back(renderer.start(RayTask{std::move(queries_), first}));
        if (!flush_due_) return;
        while (!lists_.empty() && put_answer(renderer)) {
        }
        flush();
    }

    /// Of the oldest list. False: stopped.
    bool put_answer(Renderer& renderer) {
        const std::optional<RayBytes> answer = renderer.finish(lists_.front());
        lists_.pop_front();
        if (!answer) return false;
        output_ += answer->bytes;
        if (output_.size() >= kEnough) flush();
        return true;
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
        if (command_.y > 0)
            expected_ =
                static_cast<std::uint64_t>(command_.y) *
                (command_.x > 1 && command_.y > 1 ? static_cast<std::uint64_t>(command_.x) : 1);
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

    /// Read rays until the batch is full or an answer is due. False: there are no more.
    bool read_batch(std::size_t most) {
        queries_.clear();
        flush_due_ = false;
        while (queries_.size() < most && !flush_due_ && (expected_ == 0 || read_ < expected_)) {
            const std::optional<InputRay> ray = reader_.next();
            if (!ray) break;
            queries_.push_back({ray->origin, ray->direction});
            ++read_;
            const bool row_ends = command_.x > 0 && ++in_row_ >= command_.x;
            if (row_ends) in_row_ = 0;
            // Who sends rays through a pipe and waits for answers does so at a row's end or with a
            // zero direction.
            flush_due_ = (ray->is_flush() || row_ends) && reader_.drained();
        }
        return !queries_.empty();
    }

    void flush() {
        write_to_stdout(output_);
        output_.clear();
    }

    TraceCommand& command_;
    RayListOptions& options_;            ///< of the command
    std::optional<RayRecords> records_;  ///< not with trees alone
    std::optional<RayTree> tree_;        ///< -ot -oT
    RayReader reader_;
    const Scene* scene_ = nullptr;  ///< that records name parts of
    std::vector<RayQuery> queries_;
    std::deque<Ticket<RayBytes>> lists_;  ///< that were started
    std::string output_;
    std::uint64_t read_ = 0, expected_ = 0;
    int in_row_ = 0;
    bool flush_due_ = false;
};

}  // namespace

int run_trace(const std::vector<std::string>& words, Communicator* ranks) {
    return run_command<TraceRun>(TraceCommand{}, words, ranks);
}

}  // namespace lightwalk
