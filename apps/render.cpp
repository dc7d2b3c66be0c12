// lightwalk render and animate: pictures of a scene, as rpict makes them, one or the frames of a
// walk.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/progress_printer.h"
#include "apps/rank_report.h"
#include "apps/rank_session.h"
#include "apps/render_command.h"
#include "apps/renderer_request.h"
#include "apps/session/checkpoint.h"
#include "apps/session/film.h"
#include "apps/session/picture_series.h"
#include "apps/session/run_header.h"
#include "apps/warnings.h"
#include "io/files/atomic_file.h"
#include "io/options/frame_name.h"
#include "io/options/view_text.h"

namespace lightwalk {
namespace {

void write_to_stdout(const std::string& bytes) {
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
    if (!whole || std::fflush(stdout) != 0) throw InputError("cannot write standard output");
}

InterruptPhase phase_of(SeriesStage stage) {
    return stage == SeriesStage::rendering ? InterruptPhase::request
           : stage == SeriesStage::writing ? InterruptPhase::finish
                                           : InterruptPhase::leave;
}

class RenderRun {
  public:
    /// @param files  where standard input comes from
    RenderRun(RenderCommand command, Communicator* communicator, FileSource& files)
        : command_(std::move(command)),
          program_("lightwalk " + command_.name),
          communicator_(communicator),
          warnings_(program_),
          printer_(progress_options(), warnings_) {
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
        return link_->run([this] { return draw(); }, interrupt_flag());
    }

  private:
    /// On every rank, where there are several.
    int draw() {
        Renderer& renderer = renderer_.emplace(open_renderer(link_.get(), request(), warnings_));
        if (renderer.leads()) renderer.session().warn_of_darkness();
        bool whole = false;
        renderer.run([&] { whole = render_all(renderer); });
        if (!renderer.leads()) return kSuccessStatus;
        if (!whole) return kInterruptedStatus;
        save_statistics(renderer.statistics());
        return kSuccessStatus;
    }

    /// Whether there are others to share the work with.
    bool share_out() {
        // A deterministic run exchanges values in rounds, among all who trace.
        const bool ambient =
            caches_ambient_values(command_.settings.light) && !command_.deterministic;
        const bool reuses = command_.walk && command_.walk->reuse;
        const int projectors = reuses ? command_.walk->projectors : 0;
        link_ = link_ranks(communicator_, command_.common, {program_, ambient, false, projectors});
        return link_ != nullptr;
    }

    [[nodiscard]] RendererRequest request() {
        RendererRequest request = renderer_request(command_, warnings_);
        request.options.progress = [this](const RenderProgress& progress) {
            printer_.print(progress);
        };
        request.options.progress_interval = printer_.interval();
        return request;
    }

    /// With --checkpoint. What an earlier run has left must have been made of the same scene by the
    /// same options.
    void open_checkpoint(const SceneSession& session) {
        if (command_.checkpoint.empty()) return;
        if (!command_.resume && std::filesystem::exists(command_.checkpoint)) {
            throw InputError({command_.checkpoint, 0},
                             "this checkpoint is there already: continue its run with --resume, or "
                             "remove it");
        }
        RenderCommand same = command_;  // the number of threads changes nothing
        same.common.workers = 1;
        same.report_interval = 0;
        if (!kept_values_.empty()) same.settings.ambient_file.clear();
        std::string header = "SOFTWARE= Lightwalk " LIGHTWALK_VERSION "\n" + describe(same);
        header += "scene " + session.compiled().files().digest() + '\n';
        checkpoint_ = std::make_unique<Checkpoint>(command_.checkpoint, header, warnings_);
    }

    [[nodiscard]] ProgressOptions progress_options() const {
        const bool bar = !command_.common.quiet && command_.common.error_file.empty() &&
                         isatty(STDERR_FILENO) != 0;
        return {bar, command_.report_interval, program_};
    }

    void save_statistics(RunStatistics statistics) {
        statistics.command = command_.name;
        statistics.render_seconds = made_.seconds;
        statistics.width = made_.width;
        statistics.height = made_.height;
        statistics.frames = made_.frames;
        const CommonOptions& common = command_.common;
        if (!common.stats_file.empty())
            write_file_atomically(common.stats_file, statistics_json(statistics));
        if (link_ && !common.ranks.timeline.empty())
            write_file_atomically(common.ranks.timeline, timeline_json(statistics.reports));
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
    [[nodiscard]] std::vector<WantedPicture> wanted_pictures(const Scene& scene) {
        if (command_.walk) return frames_of_walk(scene);
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

    [[nodiscard]] std::vector<WantedPicture> frames_of_walk(const Scene& scene) const {
        std::vector<WantedPicture> wanted;
        std::optional<View> before;
        for (const View& view : walk_views(*command_.walk, command_.view, scene)) {
            wanted.push_back({view, before, static_cast<int>(wanted.size()) + 1});
            before = view;
        }
        return wanted;
    }

    [[nodiscard]] SeriesOutput output(const SceneSession& session) const {
        SeriesOutput output;
        output.picture = command_.output;
        output.depth = command_.depth;
        output.bytes = write_to_stdout;
        output.history = history_header(session.compiled().model().header, command_.history);
        output.primaries = command_.primaries;
        output.xyz = command_.xyz;
        output.tone = command_.tone;
        output.keep_exposure = command_.walk.has_value();
        if (command_.walk && is_film(command_.output)) output.film_rate = command_.walk->rate;
        return output;
    }

    [[nodiscard]] SeriesObserver observer() {
        SeriesObserver observer;
        observer.size_of = [this](const View& view) { return picture_size(view); };
        if (command_.report_interval > 0)
            observer.begins = [](const WantedPicture& wanted) {
                if (wanted.frame > 0)
                    std::fprintf(stderr, "FRAME %d:%s\n", wanted.frame,
                                 view_text(wanted.view).c_str());
            };
        observer.enters = [](SeriesStage stage) { set_interrupt_phase(phase_of(stage)); };
        observer.unfinished_file = set_interrupt_litter;
        return observer;
    }

    [[nodiscard]] PictureSize picture_size(const View& view) {
        constexpr int kMostPixels = 1 << 28;
        const Camera camera(view);
        const PictureSize size =
            fit_picture(command_.x, command_.y, camera.aspect(), command_.pixel_aspect);
        if (size.width <= 0 || size.height <= 0) warnings_.warn("empty output picture");
        if (static_cast<double>(size.width) * size.height > kMostPixels)
            throw UsageError("options -x and -y: more than " + std::to_string(kMostPixels) +
                             " pixels");
        return size;
    }

    /// False: interrupted.
    bool render_all(Renderer& renderer) {
        const SceneSession& session = renderer.session();
        open_checkpoint(session);
        PictureSeries series(output(session), observer(), interrupt_flag(), checkpoint_.get());
        const bool whole = series.make(wanted_pictures(session.scene()), renderer);
        made_ = series.result();
        if (whole && !kept_values_.empty()) std::filesystem::remove(kept_values_);
        return whole;
    }

    RenderCommand command_;
    std::string program_;         ///< how messages name it
    Communicator* communicator_;  ///< to the other ranks; null: there are none
    StderrWarnings warnings_;
    std::unique_ptr<RankLink> link_;
    std::unique_ptr<Checkpoint> checkpoint_;
    std::string kept_values_;  ///< file of ambient values that goes with the checkpoint; "": none
    ProgressPrinter printer_;
    SeriesResult made_;
    std::optional<Renderer> renderer_;  ///< lasts: values for its cache come until all ranks end
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
