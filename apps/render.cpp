// lightwalk render: pictures of a scene, as rpict makes them.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>

#include "apps/checkpoint.h"
#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/local_pictures.h"
#include "apps/progress.h"
#include "apps/rank_pictures.h"
#include "apps/rank_report.h"
#include "apps/rank_session.h"
#include "apps/render_command.h"
#include "apps/scene_session.h"
#include "apps/warnings.h"
#include "io/files/atomic_file.h"
#include "io/files/library_path.h"
#include "io/options/frame_name.h"
#include "io/options/view_text.h"
#include "parallel/overture.h"

namespace lightwalk {
namespace {

constexpr const char* kProgram = "lightwalk render";
constexpr std::array<double, 8> kStandardPrimaries{.64, .33, .29, .6, .15, .06, 1.0 / 3, 1.0 / 3};

std::string formatted(const char* format, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string primaries_line(const RenderCommand& command) {
    std::string line = "PRIMARIES=";
    for (const double value : command.primaries.value_or(kStandardPrimaries))
        line += formatted(" %.4f", value);
    return line;
}

PictureHeader picture_header(const RenderCommand& command, const Model& model, const View& view,
                             double pixel_aspect, int frame) {
    PictureHeader header{history_header(model.header, command.history)};
    if (frame > 0) header.lines.push_back("FRAME=" + std::to_string(frame));
    header.lines.push_back("VIEW= " + view_text(view));
    if (pixel_aspect < 0.995 || pixel_aspect > 1.005) {
        header.lines.push_back("PIXASPECT=" + formatted("%f", pixel_aspect));
    }
    for (const std::string& line : date_lines()) header.lines.push_back(line);
    if (!command.xyz) header.lines.push_back(primaries_line(command));
    header.xyz = command.xyz;
    return header;
}

void write_to_stdout(const std::string& bytes) {
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
    if (!whole || std::fflush(stdout) != 0) throw InputError("cannot write standard output");
}

class RenderRun {
  public:
    /// @param files  where standard input comes from
    RenderRun(RenderCommand command, Transport* transport, FileSource& files)
        : command_(std::move(command)), transport_(transport), warnings_(kProgram) {
        redirect_messages(command_.common, command_.history);
        const bool speaks = transport_ == nullptr || transport_->rank() == 0;
        warnings_.enable(command_.settings.warnings && !command_.common.quiet && speaks);
        check_render_settings(command_.settings);
        settle_spacing();
        if (command_.first_frame == 0)
            (void)Camera(command_.view);  // a bad view is told before the scene is read
        settle_scene_files(command_.common,
                           command_.first_frame > 0 ? "the views of the sequence (-S)" : "", files);
        // mpirun shows its processes a terminal, whatever becomes of their output.
        if (transport_ == nullptr && command_.output.empty() && isatty(STDOUT_FILENO) != 0) {
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
        LocalPictures pictures(*session_, overture(), *executor_, *contexts_, progress_options(),
                               warnings_, statistics_);
        open_checkpoint();
        if (!render_all(pictures)) return kInterruptedStatus;
        save_statistics();
        return kSuccessStatus;
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
        return {bar, command_.report_interval, kProgram};
    }

    [[nodiscard]] Overture overture() const {
        if (!session_->freezable) return Overture::none;
        if (command_.deterministic) return Overture::deterministic;
        return command_.overture ? Overture::quick : Overture::none;
    }

    void save_statistics() {
        statistics_.command = "render";
        statistics_.read_seconds = session_->read_seconds;
        statistics_.build_seconds = session_->build_seconds;
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
        link_ = link_ranks(transport_, command_.common, {kProgram, ambient, false});
        if (link_) statistics_.ranks = link_->ranks();
        return link_ != nullptr;
    }

    void prepare() {
        session_ =
            build_on_ranks(*link_, command_.common, command_.settings, command_.history, warnings_);
        // The rounds of all ranks begin with the same cache.
        if (overture() == Overture::deterministic)
            link_->spread(session_->known, *session_->ambient);
        make_threads();
    }

    [[nodiscard]] FrameOptions frame_options(const PictureSize& size) const {
        FrameOptions options;
        options.width = size.width;
        options.height = size.height;
        options.pixels = command_.pixels;
        options.seed = command_.settings.light.seed;
        options.use_distances = !command_.depth.empty();
        return options;
    }

    /// What rank 0 orders, until it says that no more comes.
    void trace_orders(RankPictures& pictures) {
        link_->trace(
            *executor_, [&](const JobStart& job) { return pictures.make(job); }, interrupt_flag());
    }

    int follow() {
        prepare();
        RankPictures pictures(session_->tracer(), frame_options({}), session_->freezable.get(),
                              *contexts_, link_->rounds(), warnings_, interrupt_flag());
        if (link_->traces())
            trace_orders(pictures);
        else
            link_->wait_for_end(interrupt_flag());
        link_->report(report(pictures));
        return kSuccessStatus;
    }

    int lead() {
        prepare();
        session_->warn_of_darkness();
        RankPictures pictures(session_->tracer(), frame_options({}), session_->freezable.get(),
                              *contexts_, link_->rounds(), warnings_, interrupt_flag());
        bool whole = false;
        lead_ranks(
            *link_, [&] { trace_orders(pictures); },
            [&] {
                LeadPictures all(*link_, session_->tracer(), overture(), *contexts_,
                                 progress_options());
                open_checkpoint();
                whole = render_all(all);
                statistics_.reports = link_->finish(interrupt_flag());
            });
        if (!whole) return kInterruptedStatus;
        statistics_.reports[0] = report(pictures);
        for (const auto& [rank, text] : statistics_.reports)
            add_report(text, statistics_.rays, statistics_.ambient);
        save_statistics();
        if (!command_.common.ranks.timeline.empty())
            write_file_atomically(command_.common.ranks.timeline,
                                  timeline_json(statistics_.reports));
        return kSuccessStatus;
    }

    [[nodiscard]] std::string report(const RankPictures& pictures) const {
        return rank_report(*link_, executor_->concurrency(), pictures.rays(), pictures.ambient());
    }

    // Pictures.

    void settle_spacing() {
        constexpr int kLargestSpacing = 16;
        int& spacing = command_.pixels.spacing;
        if (spacing > kLargestSpacing) {
            warnings_.warn("-ps reduced to 16");
            spacing = kLargestSpacing;
        }
        if (spacing < 1) spacing = 1;
        if (command_.pixels.samples > 1 && spacing > 1) {
            if (command_.spacing_given)
                warnings_.warn("-ps ignored: with --samples every pixel is traced");
            spacing = 1;
        }
    }

    struct Wanted {
        View view;
        std::optional<View> before;
        int frame = 0;  ///< number in a sequence; 0: the only picture
    };

    /// What is to be rendered; pictures of a sequence that are there already are left out.
    [[nodiscard]] std::vector<Wanted> wanted_pictures() {
        if (command_.first_frame == 0) return {{command_.view, std::nullopt, 0}};
        std::vector<Wanted> wanted;
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

    /// False: interrupted.
    bool render_all(PictureMaker& maker) {
        const std::vector<Wanted> wanted = wanted_pictures();
        std::deque<PictureSize> sizes;
        std::size_t ordered = 0;
        for (std::size_t taken = 0; taken < wanted.size(); ++taken) {
            for (; ordered < std::min(wanted.size(), taken + maker.ahead()); ++ordered)
                sizes.push_back(order(wanted[ordered], maker));
            const PictureSize size = sizes.front();
            sizes.pop_front();
            if (!finish(wanted[taken], size, maker)) return false;
        }
        if (checkpoint_) checkpoint_->remove();
        if (!kept_values_.empty()) std::filesystem::remove(kept_values_);
        return true;
    }

    PictureSize order(const Wanted& wanted, PictureMaker& maker) {
        const Camera camera(wanted.view);
        const PictureSize size =
            fit_picture(command_.x, command_.y, camera.aspect(), command_.pixel_aspect);
        check_size(size);
        if (wanted.frame > 0 && command_.report_interval > 0) {
            std::fprintf(stderr, "FRAME %d:%s\n", wanted.frame, view_text(wanted.view).c_str());
        }
        if (is_empty(size)) return size;
        const auto request = std::make_shared<PictureRequest>(
            wanted.view, wanted.before ? &*wanted.before : nullptr, frame_options(size));
        if (checkpoint_)
            request->keeper = checkpoint_->picture(wanted.frame, request->options.area());
        maker.order(request);
        return size;
    }

    /// False: interrupted.
    bool finish(const Wanted& wanted, const PictureSize& size, PictureMaker& maker) {
        set_interrupt_phase(InterruptPhase::request);
        const Stopwatch watch;
        const std::optional<Frame> frame = is_empty(size) ? Frame{} : maker.take();
        statistics_.render_seconds += watch.seconds();
        statistics_.width = size.width;
        statistics_.height = size.height;
        ++statistics_.frames;
        if (!frame) return false;
        set_interrupt_phase(InterruptPhase::finish);
        write(*frame,
              picture_header(command_, *session_->model, wanted.view, size.pixel_aspect,
                             wanted.frame),
              wanted.frame);
        if (checkpoint_) checkpoint_->forget(wanted.frame);
        if (interrupt_flag().requested()) return false;
        set_interrupt_phase(InterruptPhase::leave);
        return true;
    }

    static bool is_empty(const PictureSize& size) { return size.width <= 0 || size.height <= 0; }

    void check_size(const PictureSize& size) {
        constexpr double kMostPixels = 1 << 28;
        if (is_empty(size)) warnings_.warn("empty output picture");
        if (static_cast<double>(size.width) * size.height > kMostPixels) {
            throw UsageError("options -x and -y: more than " + formatted("%.0f", kMostPixels) +
                             " pixels");
        }
    }

    void write(const Frame& frame, const PictureHeader& header, int number) {
        const Picture picture{frame.width, frame.height, frame.radiance};
        if (!command_.depth.empty()) {
            write_depth(frame_name(command_.depth, number), frame.width, frame.height,
                        frame.distance);
        }
        if (command_.output.empty())
            write_to_stdout(encode_hdr(picture, header));
        else
            write_picture(frame_name(command_.output, number), picture, header, command_.tone);
    }

    RenderCommand command_;
    Transport* transport_;  ///< to the other ranks; null: there are none
    StderrWarnings warnings_;
    std::unique_ptr<RankLink> link_;
    std::unique_ptr<Checkpoint> checkpoint_;
    std::string kept_values_;  ///< file of ambient values that goes with the checkpoint; "": none
    std::unique_ptr<SceneSession> session_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<WorkerContexts> contexts_;
    RunStatistics statistics_;
};

}  // namespace

int run_render(const std::vector<std::string>& words, Transport* ranks) {
    std::unique_ptr<RenderRun> run;
    parse_on_ranks(ranks, kProgram, [&](const std::shared_ptr<FileSource>& files) {
        RenderCommand command = parse_render_command(words, files);
        if (!command.show_defaults)
            run = std::make_unique<RenderRun>(std::move(command), ranks, *files);
        else if (ranks == nullptr || ranks->rank() == 0)
            std::fputs(describe(command).c_str(), stdout);
    });
    return run ? run->run() : kSuccessStatus;
}

}  // namespace lightwalk
