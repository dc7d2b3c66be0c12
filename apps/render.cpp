// lightwalk render and animate: pictures of a scene, as rpict makes them, one or the frames of a
// walk.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/checkpoint.h"
#include "apps/cloud_pictures.h"
#include "apps/commands.h"
#include "apps/film.h"
#include "apps/interrupt.h"
#include "apps/local_pictures.h"
#include "apps/picture_series.h"
#include "apps/progress.h"
#include "apps/rank_pictures.h"
#include "apps/rank_report.h"
#include "apps/rank_session.h"
#include "apps/rank_walk.h"
#include "apps/render_command.h"
#include "apps/scene_session.h"
#include "apps/warnings.h"
#include "io/files/atomic_file.h"
#include "io/files/library_path.h"
#include "io/options/frame_name.h"
#include "io/options/view_text.h"
#include "parallel/cache_prepass.h"

namespace lightwalk {
namespace {

class RenderRun {
  public:
    /// @param files  where standard input comes from
    RenderRun(RenderCommand command, Communicator* communicator, FileSource& files)
        : command_(std::move(command)),
          program_("lightwalk " + command_.name),
          communicator_(communicator),
          warnings_(program_) {
        redirect_messages(command_.common, command_.history);
        const bool speaks = communicator_ == nullptr || communicator_->rank() == 0;
        warnings_.enable(command_.settings.warnings && !command_.common.quiet && speaks);
        check_render_settings(command_.settings);
        choose_spacing();
        if (command_.first_frame == 0)
            (void)Camera(command_.view);  // a bad view is told before the scene is read
        resolve_scene_files(command_.common,
                            command_.first_frame > 0 ? "the views of the sequence (-S)" : "",
                            files);
        // mpirun shows its processes a terminal, whatever becomes of their output.
        if (communicator_ == nullptr && command_.output.empty() && isatty(STDOUT_FILENO) != 0) {
            throw UsageError("standard output is a terminal: name the picture's file with -o");
        }
        keep_ambient_values(speaks);
    }

    int run() {
        handle_interrupts();
        if (!share_out()) return draw();
        const auto body = [this] { return link_->leads() ? lead() : follow(); };
        return link_->run(body, interrupt_flag());
    }

  private:
    /// This process by itself.
    int draw() {
        session_ = std::make_unique<SceneSession>(command_.common, warnings_);
        session_->build(command_.settings);
        session_->warn_of_darkness();
        make_threads();
        open_checkpoint();
        if (!render_all(*local_pictures())) return kInterruptedStatus;
        save_statistics();
        return kSuccessStatus;
    }

    std::unique_ptr<PictureMaker> local_pictures() {
        if (reuses())
            return std::make_unique<CloudPictures>(
                *session_, prepass(), command_.walk->cloud, walk_length(*command_.walk), *executor_,
                *contexts_, progress_options(), warnings_, statistics_);
        return std::make_unique<LocalPictures>(*session_, prepass(), *executor_, *contexts_,
                                               progress_options(), warnings_, statistics_);
    }

    void make_threads() {
        executor_ = make_executor(command_.common.executor, command_.common.workers);
        contexts_ = std::make_unique<WorkerContexts>(session_->tracer(), warnings_,
                                                     executor_->concurrency());
        statistics_.threads = executor_->concurrency();
    }

    /// With --checkpoint. What an earlier run has left must have been made of the same scene by the
    /// same options.
    void open_checkpoint() {
        if (command_.checkpoint.empty()) return;
        RenderCommand same = command_;  // the number of threads changes nothing
        same.common.workers = 1;
        same.report_interval = 0;
        if (!kept_values_.empty()) same.settings.ambient_file.clear();
        std::string header = "SOFTWARE= Lightwalk " LIGHTWALK_VERSION "\n" + describe(same);
        header += "scene " + session_->digest() + '\n';
        checkpoint_ =
            std::make_unique<Checkpoint>(command_.checkpoint, command_.resume, header, warnings_);
    }

    [[nodiscard]] ProgressOptions progress_options() const {
        const bool bar = !command_.common.quiet && command_.common.error_file.empty() &&
                         isatty(STDERR_FILENO) != 0;
        return {bar, command_.report_interval, program_};
    }

    [[nodiscard]] CachePrepass prepass() const {
        if (!session_->freezable) return CachePrepass::none;
        if (command_.deterministic) return CachePrepass::deterministic;
        return command_.prepass ? CachePrepass::quick : CachePrepass::none;
    }

    void save_statistics() {
        statistics_.command = command_.name;
        statistics_.scene = session_->cost;
        if (session_->ambient) {
            statistics_.ambient_values = session_->ambient->size();
            statistics_.ambient_bytes = session_->ambient->memory_bytes();
        }
        if (!command_.common.stats_file.empty())
            write_statistics(command_.common.stats_file, statistics_);
    }

    /// With --checkpoint and cached ambient light: the values are kept beside it, as with -af. Not
    /// where the same are found again, which others would disturb.
    void keep_ambient_values(bool leads) {
        std::string& file = command_.settings.ambient_file;
        if (command_.checkpoint.empty() || !file.empty() || command_.deterministic ||
            !caches_ambient_values(command_.settings.light))
            return;
        file = kept_values_ = command_.checkpoint + "-ambient";
        if (leads && !command_.resume && std::filesystem::exists(file)) {
            throw InputError({file, 0},
                             "values of a checkpoint are there already: continue its run with "
                             "--resume, or remove them");
        }
    }

    // One of several ranks.

    /// Whether there are others to share the work with.
    bool share_out() {
        // A deterministic run exchanges values in rounds, among all who trace.
        const bool ambient =
            caches_ambient_values(command_.settings.light) && !command_.deterministic;
        const int projectors = reuses() ? command_.walk->projectors : 0;
        link_ = link_ranks(communicator_, command_.common, {program_, ambient, false, projectors});
        if (link_) statistics_.ranks = link_->ranks();
        return link_ != nullptr;
    }

    void prepare() {
        session_ =
            build_on_ranks(*link_, command_.common, command_.settings, command_.history, warnings_);
        // The rounds of all ranks begin with the same cache.
        if (prepass() == CachePrepass::deterministic)
            link_->spread(session_->known, *session_->ambient);
        make_threads();
    }

    /// Whether points of frames before serve the next ones.
    [[nodiscard]] bool reuses() const { return command_.walk && command_.walk->reuse; }

    std::unique_ptr<RankWork> rank_work() {
        const FrameOptions options = frame_options(command_, {});
        if (reuses())
            return std::make_unique<RankWalk>(*link_, *session_, prepass(), options,
                                              command_.walk->cloud, command_.walk->projectors,
                                              *contexts_, warnings_, interrupt_flag());
        return std::make_unique<RankPictures>(*link_, session_->tracer(), options,
                                              session_->freezable.get(), *contexts_, warnings_,
                                              interrupt_flag());
    }

    std::unique_ptr<PictureMaker> lead_pictures() {
        if (reuses())
            return std::make_unique<LeadWalk>(*link_, session_->tracer(), command_.walk->cloud,
                                              walk_length(*command_.walk), progress_options(),
                                              warnings_, statistics_);
        return std::make_unique<LeadPictures>(*link_, session_->tracer(), prepass(), *contexts_,
                                              progress_options());
    }

    int follow() {
        prepare();
        const std::unique_ptr<RankWork> work = rank_work();
        if (link_->traces())
            work->serve(*executor_);
        else
            link_->wait_for_end(interrupt_flag());
        link_->report(report(*work));
        return kSuccessStatus;
    }

    int lead() {
        prepare();
        session_->warn_of_darkness();
        const std::unique_ptr<RankWork> rays = rank_work();
        bool whole = false;
        lead_ranks(
            *link_, [&] { rays->serve(*executor_); },
            [&] {
                const std::unique_ptr<PictureMaker> all = lead_pictures();
                open_checkpoint();
                whole = render_all(*all);
                statistics_.reports = link_->finish(interrupt_flag());
            });
        if (!whole) return kInterruptedStatus;
        statistics_.reports[0] = report(*rays);
        for (const auto& [rank, text] : statistics_.reports)
            add_report(text, statistics_.rays, statistics_.ambient);
        save_statistics();
        if (!command_.common.ranks.timeline.empty())
            write_file_atomically(command_.common.ranks.timeline,
                                  timeline_json(statistics_.reports));
        return kSuccessStatus;
    }

    [[nodiscard]] std::string report(const RankWork& work) const {
        return rank_report(*link_, executor_->concurrency(), work.rays(), work.ambient());
    }

    // Pictures.

    void choose_spacing() {
        constexpr int kLargestSpacing = 16;
        int& spacing = command_.pixels.spacing;
        if (spacing > kLargestSpacing) {
            warnings_.warn("-ps reduced to 16");
            spacing = kLargestSpacing;
        }
        if (spacing < 1) spacing = 1;
        if (command_.walk && command_.walk->reuse && spacing > 1) {
            if (command_.spacing_given)
                warnings_.warn("-ps ignored: every pixel that is not reused is traced");
            spacing = 1;
        }
        if (command_.pixels.samples > 1 && spacing > 1) {
            if (command_.spacing_given)
                warnings_.warn("-ps ignored: with --samples every pixel is traced");
            spacing = 1;
        }
    }

    /// What is to be rendered; pictures of a sequence that are there already are left out.
    [[nodiscard]] std::vector<WantedPicture> wanted_pictures() {
        if (command_.walk) return frames_of_walk();
        if (command_.first_frame == 0) return {{command_.view, std::nullopt, 0}};
        std::vector<WantedPicture> wanted;
        int frame = command_.first_frame;
        View before = command_.view;
        for (const View& view : read_view_sequence(read_standard_input(), command_.view)) {
            const bool skip = varies_by_frame(command_.output) &&
                              std::filesystem::exists(frame_name(command_.output, frame));
            if (!skip)
                wanted.push_back({view, frame > 1 ? std::optional(before) : std::nullopt, frame});
            before = view;
            ++frame;
        }
        if (wanted.empty()) warnings_.warn("no output produced");
        return wanted;
    }

    [[nodiscard]] std::vector<WantedPicture> frames_of_walk() const {
        std::vector<WantedPicture> wanted;
        std::optional<View> before;
        for (const View& view : walk_views(*command_.walk, command_.view, session_->scene())) {
            wanted.push_back({view, before, static_cast<int>(wanted.size()) + 1});
            before = view;
        }
        return wanted;
    }

    /// False: interrupted.
    bool render_all(PictureMaker& maker) {
        PictureSeries series(command_, *session_->model, warnings_, statistics_, checkpoint_.get());
        if (command_.walk) series.keep_exposure();
        if (!series.make(wanted_pictures(), maker)) return false;
        if (!kept_values_.empty()) std::filesystem::remove(kept_values_);
        return true;
    }

    RenderCommand command_;
    std::string program_;         ///< how messages name it
    Communicator* communicator_;  ///< to the other ranks; null: there are none
    StderrWarnings warnings_;
    std::unique_ptr<RankLink> link_;
    std::unique_ptr<Checkpoint> checkpoint_;
    std::string kept_values_;  ///< file of ambient values that goes with the checkpoint; "": none
    std::unique_ptr<SceneSession> session_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<WorkerContexts> contexts_;
    RunStatistics statistics_;
};

int run_pictures(const std::string& name, const std::vector<std::string>& words,
                 Communicator* ranks) {
    std::unique_ptr<RenderRun> run;
    parse_on_ranks(ranks, "lightwalk " + name, [&](const std::shared_ptr<FileSource>& files) {
        RenderCommand command = parse_render_command(name, words, files);
        const bool writes = ranks == nullptr || ranks->rank() == 0;
        if (command.walk && !command.show_defaults && writes && is_film(command.output))
            (void)film_encoder();  // before anything is drawn
        if (!command.show_defaults)
            run = std::make_unique<RenderRun>(std::move(command), ranks, *files);
        else if (writes)
            std::fputs(describe(command).c_str(), stdout);
    });
    return run ? run->run() : kSuccessStatus;
}

}  // namespace

int run_render(const std::vector<std::string>& words, Communicator* ranks) {
    return run_pictures("render", words, ranks);
}

int run_animate(const std::vector<std::string>& words, Communicator* ranks) {
    return run_pictures("animate", words, ranks);
}

}  // namespace lightwalk
