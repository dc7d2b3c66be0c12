// lightwalk trace: single rays, as rtrace answers them.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/rank_report.h"
#include "apps/rank_session.h"
#include "apps/scene_session.h"
#include "apps/trace_command.h"
#include "apps/warnings.h"
#include "io/files/atomic_file.h"
#include "parallel/ray_list.h"

namespace lightwalk {
namespace {

constexpr const char* kProgram = "lightwalk trace";
constexpr std::size_t kBatch = 16384;     ///< rays read ahead when nobody asks for a flush
constexpr std::size_t kEnough = 1 << 16;  ///< bytes of output that are worth writing

class TraceRun {
  public:
    TraceRun(TraceCommand command, Communicator* communicator, FileSource& files)
        : command_(std::move(command)),
          communicator_(communicator),
          warnings_(kProgram),
          reader_(STDIN_FILENO, command_.formats.input) {
        prepare_output();
        redirect_messages(command_.common, command_.history);
        const bool speaks = communicator_ == nullptr || communicator_->rank() == 0;
        warnings_.enable(command_.settings.warnings && !command_.common.quiet && speaks);
        check_render_settings(command_.settings);
        check(files);
        options_ = {shades() || command_.sensor, command_.sensor, command_.limit_by_length,
                    command_.settings.light.seed};
        if (!options_.shade) {  // nothing is lit: do not prepare light sources
            command_.settings.light.redirections = 0;
            command_.settings.light.shadow_threshold = 0;
        }
    }

    int run() {
        // Values that are not computed are not exchanged. Trees are told one after the other: rank
        // 0 has all the work, the others wait.
        const bool ambient =
            options_.shade && caches_ambient_values(command_.settings.light) && !tree_;
        link_ = link_ranks(communicator_, command_.common, {kProgram, ambient, true, 0});
        if (!link_) return trace_alone();
        const auto body = [this] {
            if (tree_) return link_->leads() ? lead_trees() : wait();
            return link_->leads() ? lead() : follow();
        };
        return link_->run(body, interrupt_flag());
    }

  private:
    // This process by itself.

    int trace_alone() {
        session_ = std::make_unique<SceneSession>(command_.common, warnings_);
        session_->build(command_.settings);
        if (options_.shade) session_->warn_of_darkness();
        make_threads();
        if (tree_) {
            tree_->watch(session_->tracer());
            (*contexts_)[0].observer = &*tree_;
        }
        const Stopwatch watch;
        put_header();
        while (read_batch(tree_ ? 1 : kBatch)) answer_batch();  // trees may be large
        finish();
        statistics_.render_seconds = watch.seconds();
        statistics_.rays = contexts_->rays();
        statistics_.ambient = contexts_->ambient();
        save_statistics();
        return kSuccessStatus;
    }

    void make_threads() {
        executor_ = make_executor(command_.common.executor, command_.common.workers);
        contexts_ = std::make_unique<WorkerContexts>(session_->tracer(), warnings_,
                                                     executor_->concurrency());
    }

    // One of several ranks.

    void prepare() {
        session_ =
            build_on_ranks(*link_, command_.common, command_.settings, command_.history, warnings_);
        make_threads();
    }

    void trace_chunks() {
        link_->trace_rays(
            *executor_,
            [this](const RayChunk& chunk, int worker) { return answer_chunk(chunk, worker); },
            interrupt_flag());
    }

    int follow() {
        prepare();
        if (link_->traces())
            trace_chunks();
        else
            link_->wait_for_end(interrupt_flag());
        link_->report(report());
        return kSuccessStatus;
    }

    [[nodiscard]] std::string report() const {
        return rank_report(*link_, executor_->concurrency(), contexts_->rays(),
                           contexts_->ambient());
    }

    /// While rank 0 works alone.
    int wait() {
        link_->wait_for_end(interrupt_flag());
        link_->report(rank_report(*link_, 1, {}, {}));
        return kSuccessStatus;
    }

    int lead_trees() {
        const int status = trace_alone();
        (void)link_->finish(interrupt_flag());
        return status;
    }

    int lead() {
        prepare();
        if (options_.shade) session_->warn_of_darkness();
        lead_ranks(
            *link_, [this] { trace_chunks(); },
            [&] {
                const Stopwatch watch;
                put_header();
                share_rays();
                finish();
                statistics_.render_seconds = watch.seconds();
                statistics_.reports = link_->finish(interrupt_flag());
            });
        statistics_.ranks = link_->ranks();
        statistics_.reports[0] = report();
        for (const auto& [rank, text] : statistics_.reports)
            add_report(text, statistics_.rays, statistics_.ambient);
        save_statistics();
        if (!command_.common.ranks.timeline.empty())
            write_file_atomically(command_.common.ranks.timeline,
                                  timeline_json(statistics_.reports));
        return kSuccessStatus;
    }

    /// All rays to the ranks, as many at a time as the master asks for; their answers to the
    /// output.
    void share_rays() {
        bool more = true;
        while (!interrupt_flag().requested() && (more || chunks_out_ > 0)) {
            const bool can_read = more && chunks_wanted_ > 0;
            take_news(!can_read);
            if (!can_read) continue;
            more = read_batch(chunk_rays_);
            if (!more) continue;
            give_chunk();
            if (!flush_due_) continue;
            while (chunks_out_ > 0 && !interrupt_flag().requested()) take_news(true);
            flush();
        }
    }

    void take_news(bool wait) {
        const RankLink::RayNews news = link_->ray_news(wait, interrupt_flag());
        chunks_wanted_ += news.chunks;
        if (news.rays > 0) chunk_rays_ = news.rays;
        for (const RayAnswer& answer : news.answers) {
            output_ += answer.bytes;
            --chunks_out_;
            if (output_.size() >= kEnough) flush();
        }
    }

    void give_chunk() {
        RayChunk chunk{next_chunk_++, read_ - queries_.size(), {}};
        chunk.numbers.reserve(6 * queries_.size());
        for (const RayQuery& query : queries_) {
            for (const Vec3& v : {query.origin, query.direction})
                chunk.numbers.insert(chunk.numbers.end(), {v.x, v.y, v.z});
        }
        link_->submit(std::move(chunk));
        --chunks_wanted_;
        ++chunks_out_;
    }

    [[nodiscard]] std::string answer_chunk(const RayChunk& chunk, int worker) const {
        std::vector<RayQuery> queries(chunk.rays());
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const double* const v = &chunk.numbers[6 * i];
            queries[i] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
        }
        std::string text;
        trace_rays(session_->tracer(), (*contexts_)[worker], queries, chunk.first, options_,
                   [&](std::size_t i, const Ray& ray, const Hit& first) {
                       append_record(queries[i], ray, first, text);
                   });
        return text;
    }

    // Input and output.

    void prepare_output() {
        const OutputFields fields = parse_output_fields(command_.letters);
        const NumberFormat format = command_.formats.output;
        if (!fields.record.empty() || !fields.has_tree())
            records_.emplace(fields.record, format, command_.color);
        if (!fields.has_tree()) return;
        tree_.emplace(fields, format, command_.color, command_.tree, command_.sensor);
        command_.common.workers = 1;  // trees are told one after the other
        command_.common.executor = ExecutorKind::serial;
    }

    [[nodiscard]] bool shades() const { return tree_ || records_->shades(); }

    void check(FileSource& files) {
        resolve_scene_files(command_.common, "the rays", files);
        const bool irradiance = command_.sensor || command_.settings.light.irradiance;
        if (irradiance && !shades())
            throw UsageError("-I+ and -i+ options require some value output");
        if (irradiance && records_ && records_->splits())
            warnings_.warn("-or -oR -ox -oX say nothing with -i or -I");
        if (records_ && records_->asks_for_coefficients())
            warnings_.warn("-oVW options require trace mode");
        if (tree_) check_coefficients();
        if (command_.y > 0) {
            expected_ =
                static_cast<std::uint64_t>(command_.y) *
                (command_.x > 1 && command_.y > 1 ? static_cast<std::uint64_t>(command_.x) : 1);
        }
    }

    /// Values from the cache or by differences are not the sum of what the rays brought.
    void check_coefficients() {
        const RenderOptions& light = command_.settings.light;
        const bool exact = light.ambient_bounces <= 0 ||
                           (light.ambient_accuracy <= kEpsilon && light.ambient_super_samples <= 0);
        if (!exact && tree_->asks_for_coefficients())
            warnings_.warn("-otV and -otW are only accurate with -aa 0 -as 0");
    }

    void put_header() {
        if (command_.header) {
            std::string text = "#?RADIANCE\n";
            for (const std::string& line :
                 history_header(session_->model->header, command_.history))
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

    void answer_batch() {
        texts_.assign((queries_.size() + kRaysPerTask - 1) / kRaysPerTask, {});
        trace_ray_list(session_->tracer(), *contexts_, queries_, read_ - queries_.size(), options_,
                       *executor_, [&](std::size_t i, const Ray& ray, const Hit& first) {
                           std::string& text = texts_[i / kRaysPerTask];
                           if (tree_) text += tree_->take();
                           append_record(queries_[i], ray, first, text);
                       });
        for (const std::string& text : texts_) output_ += text;
        if (flush_due_ || output_.size() >= kEnough) flush();
    }

    void append_record(const RayQuery& query, const Ray& ray, const Hit& first,
                       std::string& text) const {
        const bool sensor = options_.sensor && length_squared(query.direction) > 0;
        if (records_) records_->append({ray, first, sensor}, session_->scene(), text);
    }

    void finish() {
        if (expected_ > 0 && read_ < expected_) warnings_.warn("unexpected EOF on input");
        flush();
    }

    void flush() {
        const bool whole = std::fwrite(output_.data(), 1, output_.size(), stdout) == output_.size();
        if (!whole || std::fflush(stdout) != 0) throw InputError("cannot write standard output");
        output_.clear();
    }

    void save_statistics() {
        if (command_.common.stats_file.empty()) return;
        statistics_.command = "trace";
        statistics_.scene = session_->cost;
        if (session_->ambient) {
            statistics_.ambient_values = session_->ambient->size();
            statistics_.ambient_bytes = session_->ambient->memory_bytes();
        }
        statistics_.threads = executor_->concurrency();
        write_statistics(command_.common.stats_file, statistics_);
    }

    TraceCommand command_;
    Communicator* communicator_;  ///< to the other ranks; null: there are none
    StderrWarnings warnings_;
    std::optional<RayRecords> records_;  ///< not with trees alone
    std::optional<RayTree> tree_;        ///< -ot -oT
    RayReader reader_;
    RayListOptions options_;
    std::unique_ptr<RankLink> link_;
    std::unique_ptr<SceneSession> session_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<WorkerContexts> contexts_;
    std::vector<RayQuery> queries_;
    std::vector<std::string> texts_;  ///< answers, by task
    std::string output_;
    std::uint64_t read_ = 0, expected_ = 0;
    int in_row_ = 0;
    bool flush_due_ = false;
    // On rank 0, of several:
    std::uint64_t next_chunk_ = 0;
    std::size_t chunks_wanted_ = 0, chunks_out_ = 0, chunk_rays_ = 0;
    RunStatistics statistics_;
};

}  // namespace

int run_trace(const std::vector<std::string>& words, Communicator* ranks) {
    std::unique_ptr<TraceRun> run;
    parse_on_ranks(ranks, kProgram, [&](const std::shared_ptr<FileSource>& files) {
        TraceCommand command = parse_trace_command(words, files);
        if (!command.show_defaults)
            run = std::make_unique<TraceRun>(std::move(command), ranks, *files);
        else if (ranks == nullptr || ranks->rank() == 0)
            std::fputs(describe(command).c_str(), stdout);
    });
    return run ? run->run() : kSuccessStatus;
}

}  // namespace lightwalk
