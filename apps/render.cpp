// lightwalk render: pictures of a scene, as rpict makes them.
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/progress.h"
#include "apps/rank_pictures.h"
#include "apps/render_command.h"
#include "apps/scene_session.h"
#include "apps/warnings.h"
#include "io/files/library_path.h"
#include "io/options/frame_name.h"
#include "io/options/view_text.h"
#include "parallel/frame.h"
#include "parallel/overture.h"
#include "parallel/ranks/piece_codec.h"
#include "parallel/time_estimate.h"

namespace lightwalk {
namespace {

constexpr const char* kProgram = "lightwalk render";
constexpr std::array<double, 8> kStandardPrimaries{.64, .33, .29, .6, .15, .06, 1.0 / 3, 1.0 / 3};

std::string formatted(const char* format, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string hexadecimal(std::uint64_t value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
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
    RenderRun(RenderCommand command, Transport* transport)
        : command_(std::move(command)), transport_(transport), warnings_(kProgram) {
        redirect_messages(command_.common, command_.history);
        const bool speaks = transport_ == nullptr || transport_->rank() == 0;
        warnings_.enable(command_.settings.warnings && !command_.common.quiet && speaks);
        check_render_settings(command_.settings);
        settle_spacing();
        if (command_.first_frame == 0)
            (void)Camera(command_.view);  // a bad view is told before the scene is read
        settle_scene_files(command_.common,
                           command_.first_frame > 0 ? "the views of the sequence (-S)" : "");
        if (command_.output.empty() && isatty(STDOUT_FILENO) != 0) {
            throw UsageError("standard output is a terminal: name the picture's file with -o");
        }
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
        if (!render_all()) return kInterruptedStatus;
        save_statistics();
        return kSuccessStatus;
    }

    bool render_all() {
        return command_.first_frame > 0 ? render_sequence()
                                        : render_picture(command_.view, nullptr, 0);
    }

    void make_threads() {
        executor_ = make_executor(command_.common.executor, command_.common.workers);
        contexts_ = std::make_unique<WorkerContexts>(session_->tracer(), warnings_,
                                                     executor_->concurrency());
        statistics_.threads = executor_->concurrency();
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

    // One of several ranks.

    /// Whether there are others to share the work with.
    bool share_out() {
        if (transport_ == nullptr) return false;
        const RenderOptions& light = command_.settings.light;
        const RankOptions& wanted = command_.common.ranks;
        // A deterministic run exchanges nothing: each rank computes the same values.
        const bool ambient = light.ambient_bounces > 0 && light.ambient_accuracy > kEpsilon &&
                             !command_.deterministic && wanted.ambient_batch > 0;
        const Variant variant =
            settle_variant(wanted, transport_->size(), command_.common.workers, ambient);
        if (variant == Variant::threads) return false;
        if (variant == Variant::ranks) command_.common.workers = 1;
        RankSettings settings;
        settings.slots = command_.common.workers;
        settings.ahead = std::max(1, settings.slots / 2);
        settings.block = wanted.block;
        settings.stride = wanted.stride;
        settings.ambient_batch = static_cast<std::size_t>(wanted.ambient_batch);
        settings.encode = encode_piece;
        link_ = std::make_unique<RankLink>(
            *transport_, make_topology(variant, transport_->size(), ambient, wanted.masters),
            settings, kProgram);
        statistics_.ranks = transport_->size();
        return true;
    }

    /// Every rank reads and builds the scene; all go on, or none.
    void prepare() {
        std::string problem;
        int status = kSuccessStatus;
        try {
            session_ = std::make_unique<SceneSession>(command_.common, warnings_);
            session_->build(command_.settings, &*link_);
        } catch (const UsageError& error) {
            problem = error.what();
            status = kUsageStatus;
        } catch (const std::exception& error) {
            problem = error.what();
            status = kFailureStatus;
        }
        std::vector<std::string> facts;
        if (problem.empty()) {
            facts = {"Lightwalk " LIGHTWALK_VERSION, "options: " + command_.history,
                     "scene " + hexadecimal(session_->digest())};
        }
        link_->agree(facts, problem, status);
        make_threads();
    }

    [[nodiscard]] RankPictures rank_pictures() {
        FrameOptions options;
        options.pixels = command_.pixels;
        options.seed = command_.settings.light.seed;
        options.use_distances = !command_.depth.empty();
        return {session_->tracer(), options,   session_->freezable.get(),
                *contexts_,         warnings_, interrupt_flag()};
    }

    int follow() {
        prepare();
        if (!link_->traces()) {
            link_->wait_for_end(interrupt_flag());
            link_->report(rank_report({}, {}));
            return kSuccessStatus;
        }
        RankPictures pictures = rank_pictures();
        link_->trace(
            *executor_, [&](const JobStart& job) { return pictures.make(job); }, interrupt_flag());
        link_->report(rank_report(pictures.rays(), pictures.ambient()));
        return kSuccessStatus;
    }

    int lead() {
        prepare();
        session_->warn_of_darkness();
        RankPictures pictures = rank_pictures();
        std::thread tracing([&] {
            if (!link_->traces()) return;
            try {
                link_->trace(
                    *executor_, [&](const JobStart& job) { return pictures.make(job); },
                    interrupt_flag());
            } catch (const std::exception& error) {
                link_->fail(error.what());
            }
        });
        const bool whole = render_all();
        const std::map<int, std::string> reports = link_->finish(interrupt_flag());
        tracing.join();
        if (!whole) return kInterruptedStatus;
        statistics_.rays += pictures.rays();
        statistics_.ambient += pictures.ambient();
        for (const auto& [rank, report] : reports) add_report(statistics_, report);
        save_statistics();
        return kSuccessStatus;
    }

    /// Nothing: interrupted.
    std::optional<Frame> trace_on_ranks(const Camera& camera, const FrameOptions& options,
                                        ProgressMeter& meter, std::size_t phase) {
        PictureOrder order;
        order.view = camera.view();
        if (options.previous != nullptr) order.previous = options.previous->view();
        order.width = options.width;
        order.height = options.height;
        if (overture() == Overture::quick) {
            PictureOrder coarse = order;
            coarse.step = kQuickStep;
            link_->submit(
                {next_job_++, quick_overture(options).whole(), 1, false, encode_order(coarse)});
        }
        order.deterministic = overture() == Overture::deterministic;
        const JobId job = next_job_++;
        const BlockRenderer renderer(session_->tracer(), camera, options, *contexts_,
                                     interrupt_flag());
        link_->submit({job, options.area(), renderer.alignment(), true, encode_order(order)});
        const std::optional<FinishedPicture> picture =
            link_->wait_for(job, interrupt_flag(), [&](double share) {
                meter.update(phase, {share, 0, 0});
            });
        if (!picture) return std::nullopt;
        return assemble(*picture, options.width, options.height);
    }

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

    /// False: interrupted.
    bool render_sequence() {
        const std::vector<View> views = read_view_sequence(read_standard_input(), command_.view);
        int frame = command_.first_frame;
        int made = 0;
        View before = command_.view;
        for (const View& view : views) {
            const bool skip = varies_by_frame(command_.output) &&
                              std::filesystem::exists(frame_name(command_.output, frame));
            if (!skip) {
                if (!render_picture(view, frame > 1 ? &before : nullptr, frame)) return false;
                ++made;
            }
            before = view;
            ++frame;
        }
        if (made == 0) warnings_.warn("no output produced");
        return true;
    }

    /// False: interrupted.
    bool render_picture(const View& view, const View* before, int frame_number) {
        const Camera camera(view);
        const std::optional<Camera> previous = usable_camera(before);
        const PictureSize size =
            fit_picture(command_.x, command_.y, camera.aspect(), command_.pixel_aspect);
        check_size(size);
        if (frame_number > 0 && command_.report_interval > 0) {
            std::fprintf(stderr, "FRAME %d:%s\n", frame_number, view_text(view).c_str());
        }
        FrameOptions options;
        options.width = size.width;
        options.height = size.height;
        options.pixels = command_.pixels;
        options.seed = command_.settings.light.seed;
        options.use_distances = !command_.depth.empty();
        options.previous = previous ? &*previous : nullptr;
        set_interrupt_phase(InterruptPhase::request);
        const std::optional<Frame> frame = trace(camera, options);
        if (!frame) return false;
        set_interrupt_phase(InterruptPhase::finish);
        write(*frame,
              picture_header(command_, *session_->model, view, size.pixel_aspect, frame_number),
              frame_number);
        if (interrupt_flag().requested()) return false;
        set_interrupt_phase(InterruptPhase::leave);
        return true;
    }

    static std::optional<Camera> usable_camera(const View* view) {
        if (view == nullptr || Camera::problem(*view)) return std::nullopt;
        return Camera(*view);
    }

    void check_size(const PictureSize& size) {
        constexpr double kMostPixels = 1 << 28;
        if (size.width <= 0 || size.height <= 0) warnings_.warn("empty output picture");
        if (static_cast<double>(size.width) * size.height > kMostPixels) {
            throw UsageError("options -x and -y: more than " + formatted("%.0f", kMostPixels) +
                             " pixels");
        }
    }

    static Frame empty_frame() {
        Frame frame;
        frame.complete = true;
        return frame;
    }

    /// Nothing: interrupted.
    std::optional<Frame> trace(const Camera& camera, const FrameOptions& options) {
        if (options.width <= 0 || options.height <= 0) return empty_frame();
        const bool bar = !command_.common.quiet && command_.common.error_file.empty() &&
                         isatty(STDERR_FILENO) != 0;
        const std::vector<WorkPhase> phases =
            plan_picture(options, overture(), executor_->concurrency());
        const std::size_t picture = phases.size() - 1;
        ProgressMeter meter({bar, command_.report_interval, kProgram}, phases);
        warnings_.use_terminal_line(bar);
        const Stopwatch watch;
        const RayCounters before = statistics_.rays;
        Frame frame;
        if (link_) {
            frame = trace_on_ranks(camera, options, meter, picture).value_or(Frame{});
        } else if (play_overture(camera, options, meter)) {
            frame = render_frame(
                session_->tracer(), camera, options, *executor_, *contexts_, interrupt_flag(),
                [&](const FrameProgress& progress) { meter.update(picture, progress); });
        }
        statistics_.rays += frame.rays;
        statistics_.render_seconds += watch.seconds();
        meter.finish(frame.complete, statistics_.rays.total() - before.total());
        warnings_.use_terminal_line(false);
        statistics_.ambient += frame.ambient;
        statistics_.width = options.width;
        statistics_.height = options.height;
        ++statistics_.frames;
        if (!frame.complete) return std::nullopt;
        return frame;
    }

    [[nodiscard]] Overture overture() const {
        if (!session_->freezable) return Overture::none;
        if (command_.deterministic) return Overture::deterministic;
        return command_.overture ? Overture::quick : Overture::none;
    }

    /// False: interrupted.
    bool play_overture(const Camera& camera, const FrameOptions& options, ProgressMeter& meter) {
        if (!session_->freezable) return true;
        const OvertureResult played =
            fill_ambient_cache(session_->tracer(), camera, options, overture(),
                               *session_->freezable, *executor_, *contexts_, interrupt_flag(),
                               [&](const FrameProgress& progress) { meter.update(0, progress); });
        statistics_.rays += played.rays;
        statistics_.ambient += played.ambient;
        return played.complete;
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
    JobId next_job_ = 0;
    std::unique_ptr<SceneSession> session_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<WorkerContexts> contexts_;
    RunStatistics statistics_;
};

}  // namespace

int run_render(const std::vector<std::string>& words, Transport* ranks) {
    RenderCommand command = parse_render_command(words);
    if (command.show_defaults) {
        if (ranks == nullptr || ranks->rank() == 0) std::fputs(describe(command).c_str(), stdout);
        return kSuccessStatus;
    }
    return RenderRun(std::move(command), ranks).run();
}

}  // namespace lightwalk
