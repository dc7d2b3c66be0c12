// lightwalk walk: light in the browser. A web server on a thread of its own, and the frames.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <thread>

#include "apps/command_run.h"
#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/render_command.h"
#include "apps/session/render_backend.h"
#include "apps/walk/comparison.h"
#include "apps/walk/pages.h"
#include "apps/walk/render_loop.h"
#include "apps/walk/scene_changer.h"
#include "apps/walk/scene_follower.h"
#include "apps/walk/walk_reception.h"
#include "io/files/watched_files.h"
#include "io/formats/words.h"
#include "io/net/web_rules.h"
#include "io/picture/denoiser.h"
#include "io/rad/rad_file.h"

namespace lightwalk {
namespace {

constexpr std::chrono::milliseconds kLookAtFiles{500};
// Editors empty a file before they write it.
constexpr std::chrono::milliseconds kWriting{200};

/// A message with many lines, each a problem.
FailedReply failed_reply(std::string_view text) {
    FailedReply reply;
    while (!text.empty()) reply.messages.emplace_back(take_line(text));
    return reply;
}

/// Where nobody says where to stand: in the middle, looking along the longer side.
View view_of(const Scene& scene) {
    const Bounds bounds = scene.geometry().bounds();
    View view;
    if (bounds.empty()) return view;
    const Vec3 size = bounds.upper - bounds.lower;
    constexpr double kEyeHeight = 1.6, kHalf = 0.5;
    view.position = kHalf * (bounds.lower + bounds.upper);
    view.position.z = bounds.lower.z + std::min(kEyeHeight, kHalf * size.z);
    view.direction = size.x > size.y ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    view.horizontal = 60;
    view.vertical = 45;
    return view;
}

WebServerOptions server_options(const ServeCommand& serve) {
    WebServerOptions options = serve.server;
    options.limits.close_timeout = std::chrono::milliseconds(300);  // Ctrl-C is soon over
    const char* const head = std::getenv(kWalkHead);                // NOLINT(concurrency-mt-unsafe)
    if (head != nullptr) {
        std::array<char, 256> here{};
        (void)gethostname(here.data(), here.size() - 1);
        options.address = std::string(here.data()) == head ? "127.0.0.1" : "0.0.0.0";
        options.port = 0;
    } else if (is_loopback(options.address)) {
        return options;
    }
    // That of `lightwalk launch`, so that the head is let in.
    constexpr std::size_t kDigits = 32;
    const char* const given = std::getenv(kWalkToken);  // NOLINT(concurrency-mt-unsafe)
    const std::string token = given != nullptr ? given : "";
    const bool good =
        token.size() == kDigits && token.find_first_not_of("0123456789abcdef") == std::string::npos;
    options.token = good ? token : make_token();
    return options;
}

WelcomeReply welcome(const RenderCommand& command) {
    WelcomeReply welcome = command.serve->page;
    welcome.version = LIGHTWALK_VERSION;
    for (const std::string& file : command.common.scene_files())
        welcome.scene += (welcome.scene.empty() ? "" : " ") + file;
    welcome.denoises = command.serve->denoise;
    if (command.common.settings.light.ambient_bounces <= 0)
        welcome.settings.ambient = WalkAmbient::off;
    return welcome;
}

/// Opens the library when it is first needed.
PictureCleaner::Denoise denoise_function() {
    return [denoiser = std::make_shared<std::optional<Denoiser>>()](
               Picture& picture, const std::function<bool()>& goes_on) {
        if (!*denoiser) denoiser->emplace();
        return (**denoiser)(picture, goes_on);
    };
}

/// The page: its server, which works on a thread of its own while this lives, and what comes from
/// browsers and goes to them.
class Page {
  public:
    explicit Page(const RenderCommand& command)
        : executor(make_executor(*command.common.request.options.executor,
                                 command.common.request.options.threads)),
          inbox(welcome(command)),
          screen(*executor),
          reception(inbox),
          server_(server_options(*command.serve), viewer_pages(), reception) {
        reception.attach(server_);
        thread_ = std::thread([this] { run_server(); });
    }
    ~Page() {
        server_.stop();
        thread_.join();
    }
    Page(const Page&) = delete;
    Page& operator=(const Page&) = delete;

    [[nodiscard]] std::string url() const { return server_.url(); }
    /// Until an interrupt, or a failure of the server.
    [[nodiscard]] bool goes_on() const {
        return !interrupt_flag().requested() && !ended_.requested();
    }
    /// Throws what ended the server, if it has ended.
    void raise() const {
        if (ended_.requested() && failure_) std::rethrow_exception(failure_);
    }

    const std::unique_ptr<Executor> executor;
    ClientInbox inbox;
    WalkScreen screen;
    WalkReception reception;

  private:
    void run_server() {
        try {
            server_.run();
        } catch (...) {
            failure_ = std::current_exception();
        }
        ended_.request();
    }

    WebServer server_;
    std::exception_ptr failure_;
    StopFlag ended_;
    std::thread thread_;
};

// What rank 0 tells the others to do next. Behind kLoad stands what it has read of a command line
// with a rad file (FileRecorder::take).
constexpr const char *kLoad = "load", *kEnd = "end";
constexpr std::size_t kLoadSize = 4;

class WalkRun final : CommandRun {
  public:
    WalkRun(RenderCommand& command, Communicator* communicator, FileSource& files)
        : CommandRun(command.common, communicator), command_(command) {
        check(files);
        if (speaks() && command_.serve->denoise) (void)Denoiser();  // before the page is served
    }

    int run() {
        handle_interrupts();
        join(task().options);
        if (ranks() == nullptr) set_interrupt_phase(InterruptPhase::request);
        return share_out([this] { return speaks() ? run_page() : follow(); });
    }

  private:
    using Files = std::shared_ptr<WatchedFiles>;

    /// The ranks but rank 0: scene after scene.
    int follow() {
        for (std::string told = ranks()->tell(); told.starts_with(kLoad); told = ranks()->tell()) {
            try {
                if (from_rad_file()) {
                    const auto recorded = std::string_view(told).substr(kLoadSize);
                    read_command(std::make_shared<FileReplay>(recorded));
                }
                ranks()->open(task()).run([] {});
            } catch (const InputError&) {
                continue;  // until its files change
            }
        }
        return kSuccessStatus;
    }

    /// The process that serves the page: this one, or rank 0.
    int run_page() {
        Page page(command_);
        std::printf("%s\n", page.url().c_str());
        std::fflush(stdout);
        while (page.goes_on()) {
            const Files files = std::make_shared<WatchedFiles>();
            try {
                enter(page, files);
            } catch (const InputError& error) {
                std::fprintf(stderr, "%s\n", error.what());
                page.inbox.announce(walk_text(failed_reply(error.what())));
            }
            wait_for_change(page, *files);
            if (!interrupt_flag().requested()) std::this_thread::sleep_for(kWriting);
        }
        // Nothing is drawn any more: what is left is short, and is not cut off.
        if (ranks() == nullptr)
            set_interrupt_phase(InterruptPhase::finish);
        else
            (void)ranks()->tell(kEnd);
        page.raise();
        return kSuccessStatus;
    }

    void check(FileSource& files) {
        check_render_command(command_, files);
        (void)Camera(command_.view);  // a bad view is told before the scene is read
        resolve_scene_files(command_.common, "", files);
    }

    /// Whether what the command line says stands in a file that may change.
    [[nodiscard]] bool from_rad_file() const {
        return std::ranges::any_of(command_.common.words, is_rad_file_name);
    }
    /// Read the command line again. What the server and the ranks have begun with stays. Throws
    /// InputError, and leaves the command as it was.
    void read_command(const std::shared_ptr<FileSource>& files) {
        const RenderCommand before = command_;
        try {
            command_ = RenderCommand("walk");
            (void)take_command_line(command_, before.common.words, files);
            check(*files);
            check_render_settings(command_.common.settings);
        } catch (const std::exception& error) {
            command_ = before;
            throw InputError(error.what());
        }
        command_.common.words = before.common.words;
        if (ranks() != nullptr) command_.common.set_threads(ranks()->threads());
    }

    [[nodiscard]] RendererRequest task() {
        RendererRequest task = request();
        CloudOptions cloud = command_.walk->cloud;
        cloud.budget = 1 / command_.serve->page.fps;
        cloud.samples = command_.serve->edge_samples;
        task.options.reuse = std::make_shared<const CloudOptions>(cloud);
        task.options.steered = true;
        return task;
    }

    /// Read the scene, and draw until its files change. Throws InputError for what is wrong with
    /// the scene.
    void enter(Page& page, const Files& files) {
        const auto announce = [&page](const std::string& step, double share) {
            page.inbox.announce(walk_text(LoadingReply{step, share}));
        };
        announce("reading " + welcome(command_).scene, 0.1);
        std::string load = kLoad;
        if (from_rad_file()) {
            const auto recorder = std::make_shared<FileRecorder>(files, true);
            read_command(recorder);
            load += recorder->take();
        }
        if (ranks() != nullptr) (void)ranks()->tell(load);
        RendererRequest request = task();
        request.files = files;
        std::set<std::string> texts;
        request.when_read = [&] {
            announce("building the scene", 0.5);
            for (const auto& [path, state] : files->recorded()) texts.insert(path);
        };
        Renderer renderer = open_renderer(ranks(), request);
        renderer.backend().session().warn_of_darkness();
        renderer.run([&] {
            LoadedFiles read{request.source, request.options.warn,
                             renderer.backend().session().shared_compiled(), files, texts};
            draw(page, std::move(read), renderer);
        });
    }

    /// Of a scene beside the walk's.
    [[nodiscard]] ComparisonOptions comparison_options(const View& home) {
        ComparisonOptions options;
        options.loop = {command_.serve->page.fps, command_.serve->edge_samples,
                        command_.common.request.history};
        if (command_.serve->denoise) options.loop.denoise = denoise_function();
        options.request = task();
        options.home = home;
        options.scene = command_.serve->beside;
        std::string_view rest = options.scene;
        std::vector<std::string>& files = options.request.source.files;
        if (!rest.empty()) files.clear();
        for (std::string_view file = take_word(rest); !file.empty(); file = take_word(rest))
            files.emplace_back(file);
        return options;
    }

    /// What is drawn, in steps.
    struct Drawn {
        RenderLoop& loop;
        Comparison* comparison;  ///< null: nothing can be compared
        void step() const {
            comparison ? comparison->step(interrupt_flag()) : loop.step(interrupt_flag());
        }
    };

    /// Draw until the scene's files change.
    void draw(Page& page, LoadedFiles read, Renderer& renderer) {
        const SceneSession& session = renderer.backend().session();
        LoadedReply loaded;
        loaded.views = command_.serve->page.views;
        const View home = !loaded.views.empty() ? loaded.views.front().view
                          : command_.view_given ? command_.view
                                                : view_of(session.scene());
        if (loaded.views.empty()) loaded.views.push_back({"start", home});
        page.inbox.set_views(home, loaded.views);
        RenderLoopOptions options{command_.serve->page.fps, command_.serve->edge_samples,
                                  command_.common.request.history,
                                  ranks() != nullptr ? ranks()->size() : 1};
        options.change = scene_changer(renderer.backend());
        if (command_.serve->denoise) options.denoise = denoise_function();
        if (ranks() == nullptr) options.replace = scene_replacer(renderer.backend());
        if (ranks() != nullptr && !reads_standard_input())
            options.kept = kept_picture(read.files->recorded());
        RenderLoop loop(std::move(options), session, home, renderer.backend().frames(),
                        *page.executor, warnings(), page.inbox, page.screen);
        loaded.eye_height = loop.eye_height();
        loaded.time = loop.time_place();
        std::optional<Comparison> comparison;
        loaded.beside.emplace();
        if (ranks() == nullptr) {
            loaded.beside->scene = command_.serve->beside;
            comparison.emplace(
                comparison_options(home), page.reception, welcome(command_), loop, page.screen,
                [&renderer]() -> const SceneSession& { return renderer.backend().session(); },
                *page.executor, warnings());
        } else {
            loaded.beside->refused = "many processes draw this walk, and one state of its scene";
            page.reception.close(loaded.beside->refused);
        }
        if (const auto& groups = renderer.backend().frames().light_groups())
            loaded.lights = groups->names;
        page.inbox.announce(walk_text(loaded));
        const Drawn drawn{loop, comparison ? &*comparison : nullptr};
        if (!command_.serve->watch) {
            while (page.goes_on()) drawn.step();
        } else if (ranks() != nullptr || reads_standard_input()) {
            draw_until_change(page, *read.files, drawn);
        } else {
            SceneFollower follower(std::move(read));
            draw_and_follow(page, follower, drawn, loaded);
        }
    }

    /// Where the scene cannot be read again beside the frames.
    static void draw_until_change(Page& page, const WatchedFiles& files, const Drawn& drawn) {
        auto looked = std::chrono::steady_clock::now();
        while (page.goes_on()) {
            drawn.step();
            const auto now = std::chrono::steady_clock::now();
            if (now - looked < kLookAtFiles) continue;
            looked = now;
            if (files.have_changed()) return;
        }
    }

    /// Until the walk has to begin anew.
    /// @param loaded  what the page was told of the scene
    static void draw_and_follow(Page& page, SceneFollower& follower, const Drawn& drawn,
                                LoadedReply loaded) {
        while (page.goes_on()) {
            drawn.step();
            const std::optional<SceneNews> news = follower.take();
            if (!news) continue;
            if (news->begins_anew) return;
            FollowedReply reply;
            if (news->scene)
                reply = drawn.loop.follow(*news);
            else
                reply.problems = news->problems;
            const bool follows = news->scene && reply.problems.empty();
            follower.settle(follows);
            if (follows) {
                if (drawn.comparison) drawn.comparison->follow();
                loaded.lights = reply.lights;
                loaded.time = reply.time;
            }
            for (const std::string& problem : reply.problems)
                std::fprintf(stderr, "%s\n", problem.c_str());
            page.inbox.announce_files(walk_text(reply), !reply.problems.empty(),
                                      follows ? walk_text(loaded) : std::string());
        }
    }

    [[nodiscard]] bool reads_standard_input() const {
        return std::ranges::find(command_.common.request.source.files, "-") !=
               command_.common.request.source.files.end();
    }

    /// After a scene that cannot be read. What comes meanwhile is of no use any more.
    static void wait_for_change(Page& page, WatchedFiles& files) {
        while (!files.have_changed() && page.goes_on()) {
            const InboxContents inbox = page.inbox.pop(kLookAtFiles);
            page.screen.update_clients(inbox);
            page.inbox.refuse(inbox, "there is no scene");
        }
    }

    RenderCommand& command_;
};

}  // namespace

int run_walk(const std::vector<std::string>& words, Communicator* ranks) {
    return run_command<WalkRun>(RenderCommand("walk"), words, ranks);
}

}  // namespace lightwalk
