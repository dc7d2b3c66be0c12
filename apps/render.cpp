// lightwalk render and animate: pictures of a scene, as rpict makes them, one or the frames of a
// walk.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "apps/command_run.h"
#include "apps/interrupt.h"
#include "apps/progress_printer.h"
#include "apps/render_command.h"
#include "apps/session/checkpoint.h"
#include "apps/session/picture_series.h"
#include "apps/session/render_backend.h"
#include "apps/session/run_header.h"
#include "io/files/atomic_file.h"
#include "io/options/frame_name.h"
#include "io/options/view_text.h"
#include "io/picture/film.h"

namespace lightwalk {
namespace {

InterruptPhase phase_of(SeriesStage stage) {
    return stage == SeriesStage::rendering ? InterruptPhase::request
           : stage == SeriesStage::writing ? InterruptPhase::finish
                                           : InterruptPhase::leave;
}

class RenderRun final : CommandRun {
  public:
    /// @param files  where standard input comes from
    RenderRun(RenderCommand& command, Communicator* communicator, FileSource& files)
        : CommandRun(command.common, communicator),
          command_(command),
          printer_(progress_options(), warnings()) {
        check_render_command(command_, files);
        if (command_.walk && speaks() && is_film(command_.output.picture))
            (void)film_encoder();  // before anything is drawn
        settle_render_command(command_, warnings());
        if (command_.first_frame == 0)
            (void)Camera(command_.view);  // a bad view is told before the scene is read
        resolve_scene_files(command_.common,
                            command_.first_frame > 0 ? "the views of the sequence (-S)" : "",
                            files);
        if (speaks() && command_.output.picture.empty()) check_standard_output();
        if (speaks()) check_outputs();
        if (speaks() && command_.output.denoise) (void)Denoiser();  // before anything is drawn
        keep_ambient_values();
        if (options().deterministic && command_.resume && !command_.checkpoint.empty() && speaks())
            options().ambient_beginning = Checkpoint::beginning_of(command_.checkpoint);
    }

    int run() {
        handle_interrupts();
        join(task().options);
        return share_out([this] { return draw(); });
    }

  private:
    /// On every rank, where there are several.
    int draw() {
        Renderer renderer = open_renderer(ranks(), task());
        const RenderBackend& backend = renderer.backend();
        if (backend.leads()) backend.session().warn_of_darkness();
        bool whole = false;
        renderer.run([&] { whole = render_all(renderer); });
        if (!backend.leads()) return kSuccessStatus;
        if (!whole) return kInterruptedStatus;
        RunStatistics statistics = backend.statistics();
        statistics.render_seconds = made_.seconds;
        statistics.width = made_.width;
        statistics.height = made_.height;
        statistics.frames = made_.frames;
        save_statistics(std::move(statistics));
        return kSuccessStatus;
    }

    [[nodiscard]] RendererRequest task() {
        RendererRequest task = request();
        if (reuses()) task.options.frames = walk_length(*command_.walk) - frames_there();
        task.options.progress = [this](const RenderProgress& progress) {
            printer_.print(progress);
        };
        task.options.progress_interval = printer_.interval();
        return task;
    }

    [[nodiscard]] RendererOptions& options() const { return command_.common.request.options; }
    [[nodiscard]] const RenderOptions& light() const { return command_.common.settings.light; }
    [[nodiscard]] bool reuses() const { return reuses_frames(command_); }

    [[nodiscard]] ProgressOptions progress_options() const {
        const CommonOptions& common = command_.common;
        const bool bar = !common.quiet && common.error_file.empty() && isatty(STDERR_FILENO) != 0;
        return {bar, command_.report_interval, common.program()};
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
        same.common.set_threads(1);
        same.report_interval = 0;
        if (!kept_values_.empty()) same.common.settings.ambient_file.clear();
        std::string header = "SOFTWARE= Lightwalk " LIGHTWALK_VERSION "\n" +
                             option_table(same, real_files()).defaults();
        header += "scene " + session.compiled().files().digest() + '\n';
        checkpoint_ = std::make_unique<Checkpoint>(command_.checkpoint, header, warnings(),
                                                   options().deterministic && session.ambient_store
                                                       ? session.ambient_store->beginning()
                                                       : std::string());
    }

    /// With --checkpoint and cached ambient light: the values are kept beside it, as with -af. Not
    /// where the same are found again, which others would disturb.
    void keep_ambient_values() {
        std::string& file = command_.common.settings.ambient_file;
        if (command_.checkpoint.empty() || !file.empty() || options().deterministic ||
            !caches_ambient_values(light()))
            return;
        file = kept_values_ = command_.checkpoint + "-ambient";
        if (speaks() && !command_.resume && std::filesystem::exists(file)) {
            throw InputError({file, 0},
                             "values of a checkpoint are there already: continue its run with "
                             "--resume, or remove them");
        }
    }

    // Pictures.

    /// Throws InputError where they cannot be written, before they are drawn. Those of a sequence
    /// are looked at by the pattern of their names, unless it is their folders that differ.
    void check_outputs() const {
        for (const std::string& file : {command_.output.picture, command_.output.depth}) {
            const std::string folder = std::filesystem::path(file).parent_path().string();
            if (!file.empty() && folder.find('%') == std::string::npos) check_writable(file);
        }
    }

    void check_standard_output() {
        // mpirun shows its processes a terminal, whatever becomes of their output.
        if (!output_is_forwarded() && isatty(STDOUT_FILENO) != 0)
            throw UsageError("standard output is a terminal: name the picture's file with -o");
        use_standard_output();
    }

    /// Whether a frame is not to be drawn again.
    [[nodiscard]] bool is_there(int frame) const {
        const SeriesOutput& output = command_.output;
        // Its values are those that the next picture's rounds begin with; all of it is kept.
        if (checkpoint_ && checkpoint_->has_rounds(frame)) return false;
        if (command_.walk ? !command_.resume : output.layers || !varies_by_frame(output.picture))
            return false;
        return std::filesystem::exists(frame_name(output.picture, frame)) &&
               (!command_.walk || output.depth.empty() ||
                std::filesystem::exists(frame_name(output.depth, frame)));
    }

    /// Of a walk, how many.
    [[nodiscard]] std::size_t frames_there() const {
        std::size_t count = 0;
        for (std::size_t frame = 1; frame <= walk_length(*command_.walk); ++frame)
            count += is_there(static_cast<int>(frame)) ? 1 : 0;
        return count;
    }

    /// What is to be rendered; pictures of a sequence that are there already are left out.
    [[nodiscard]] std::vector<WantedPicture> wanted_pictures(const Scene& scene) {
        int frame = command_.walk ? 1 : command_.first_frame;
        if (frame == 0) return {{command_.view, std::nullopt, 0}};
        std::optional<View> before;
        if (frame > 1) before = command_.view;
        std::vector<WantedPicture> wanted;
        for (const View& view : command_.walk
                                    ? walk_views(*command_.walk, command_.view, scene)
                                    : read_view_sequence(read_standard_input(), command_.view)) {
            if (!is_there(frame)) wanted.push_back({view, before, frame});
            before = view;
            ++frame;
        }
        if (wanted.empty()) warnings().warn("no output produced");
        return wanted;
    }

    [[nodiscard]] SeriesOutput output(const Model& model) const {
        SeriesOutput output = command_.output;
        output.bytes = write_to_stdout;
        output.history = history_header(model.header, command_.common.request.history);
        output.keep_exposure = command_.walk.has_value();
        if (command_.walk && is_film(output.picture)) output.film_rate = command_.walk->rate;
        return output;
    }

    [[nodiscard]] SeriesObserver observer() {
        SeriesObserver observer;
        observer.size_of = [this](const View& view) {
            return picture_size(command_, view, warnings());
        };
        if (command_.report_interval > 0)
            observer.begins = [](const WantedPicture& wanted) {
                if (wanted.frame > 0)
                    std::fprintf(stderr, "FRAME %d:%s\n", wanted.frame,
                                 view_text(wanted.view).c_str());
            };
        observer.enters = [](SeriesStage stage) { set_interrupt_phase(phase_of(stage)); };
        observer.unfinished_file = set_interrupt_litter;
        if (!command_.common.quiet)
            observer.denoised = [this](const Denoiser::Errors& errors) {
                std::fprintf(
                    stderr,
                    "%s: noise of %.2g %% of the screen's white, denoised at most %.2g %%\n",
                    command_.common.program().c_str(), 100 * errors.noisy, 100 * errors.denoised);
            };
        return observer;
    }

    /// False: interrupted.
    bool render_all(Renderer& renderer) {
        const SceneSession& session = renderer.backend().session();
        open_checkpoint(session);
        PictureSeries series(output(session.compiled().model()), observer(), interrupt_flag(),
                             checkpoint_.get());
        const bool whole = series.make(wanted_pictures(session.scene()), renderer);
        made_ = series.result();
        if (whole && !kept_values_.empty()) std::filesystem::remove(kept_values_);
        return whole;
    }

    RenderCommand& command_;
    std::unique_ptr<Checkpoint> checkpoint_;
    std::string kept_values_;  ///< file of ambient values that goes with the checkpoint; "": none
    ProgressPrinter printer_;
    SeriesResult made_;
};

}  // namespace

int run_render(const std::vector<std::string>& words, Communicator* ranks) {
    return run_command<RenderRun>(RenderCommand("render"), words, ranks);
}

int run_animate(const std::vector<std::string>& words, Communicator* ranks) {
    return run_command<RenderRun>(RenderCommand("animate"), words, ranks);
}

int run_rpict(const std::vector<std::string>& words, Communicator* ranks) {
    RenderCommand command("render");
    command.common.called = "rpict";
    command.common.request.source.allow_commands = true;
    return run_command<RenderRun>(std::move(command), words, ranks);
}

}  // namespace lightwalk
