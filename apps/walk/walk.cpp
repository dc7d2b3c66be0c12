// lightwalk walk: light in the browser. A web server on a thread of its own, and the frames.
#include <cstdio>
#include <exception>
#include <thread>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/render_command.h"
#include "apps/walk/pages.h"
#include "apps/walk/walk_room.h"
#include "apps/warnings.h"
#include "io/files/watched_files.h"
#include "io/net/web_rules.h"

namespace lightwalk {
namespace {

constexpr std::chrono::milliseconds kLookAtFiles{500};
// Editors empty a file before they write it.
constexpr std::chrono::milliseconds kWriting{200};

/// Lines of a message, each a problem.
std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

WalkAmbient ambient_of(AmbientUse use) {
    return use == AmbientUse::always ? WalkAmbient::always
           : use == AmbientUse::rest ? WalkAmbient::rest
                                     : WalkAmbient::off;
}

/// Where nobody says where to stand: in the middle, looking along the longer side.
View view_of(const Scene& scene) {
    const Bounds bounds = scene.geometry().bounds();
    View view;
    if (bounds.empty()) return view;
    const Vec3 size = bounds.upper - bounds.lower;
    constexpr double kUsualEyeHeight = 1.6, kHalf = 0.5;
    view.position = kHalf * (bounds.lower + bounds.upper);
    view.position.z = bounds.lower.z + std::min(kUsualEyeHeight, kHalf * size.z);
    view.direction = size.x > size.y ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    view.horizontal = 60;
    view.vertical = 45;
    return view;
}

WebServerOptions web_options(const ServeCommand& serve) {
    WebServerOptions options;
    options.address = serve.address;
    options.port = static_cast<std::uint16_t>(serve.port);
    if (!is_loopback(serve.address)) options.token = make_token();
    options.limits.clients = serve.clients;
    options.limits.farewell = std::chrono::milliseconds(300);  // Ctrl-C is soon over
    return options;
}

/// A server that works while this lives.
class ServerThread {
  public:
    explicit ServerThread(WebServer& server)
        : server_(server), thread_([this] {
              try {
                  server_.run();
              } catch (...) {
                  failure_ = std::current_exception();
              }
              ended_.request();
          }) {}
    ~ServerThread() {
        server_.stop();
        thread_.join();
    }
    ServerThread(const ServerThread&) = delete;
    ServerThread& operator=(const ServerThread&) = delete;

    [[nodiscard]] bool ended() const { return ended_.requested(); }
    /// What ended it. After ended().
    void raise() const {
        if (failure_) std::rethrow_exception(failure_);
    }

  private:
    WebServer& server_;
    std::exception_ptr failure_;
    StopFlag ended_;
    std::thread thread_;
};

class WalkProgram {
  public:
    explicit WalkProgram(RenderCommand command)
        : command_(std::move(command)),
          warnings_("lightwalk walk"),
          executor_(make_executor(command_.common.executor, command_.common.workers)),
          desk_(welcome()),
          server_(web_options(*command_.serve), viewer_pages(), desk_),
          screen_(*executor_) {
        warnings_.enable(command_.settings.warnings && !command_.common.quiet);
        desk_.attach(server_);
    }

    int run() {
        handle_interrupts();
        set_interrupt_phase(InterruptPhase::request);
        std::printf("%s\n", server_.url().c_str());
        std::fflush(stdout);
        const ServerThread serving(server_);
        while (!interrupt_flag().requested() && !serving.ended()) {
            watched_ = std::make_shared<WatchedFiles>();
            try {
                enter(serving);
            } catch (const InputError& error) {
                std::fprintf(stderr, "%s\n", error.what());
                desk_.announce(FailedReply{lines_of(error.what())});
            }
            wait_for_change(serving);
            std::this_thread::sleep_for(kWriting);
        }
        if (serving.ended()) serving.raise();
        return kSuccessStatus;
    }

  private:
    [[nodiscard]] WelcomeReply welcome() const {
        WelcomeReply welcome;
        welcome.version = LIGHTWALK_VERSION;
        for (const std::string& file : command_.common.scene_files)
            welcome.scene += (welcome.scene.empty() ? "" : " ") + file;
        welcome.max_size = command_.serve->max_size;
        welcome.fps = command_.walk->rate;
        welcome.views = command_.serve->views;
        welcome.settings.ambient = command_.settings.light.ambient_bounces > 0
                                       ? ambient_of(command_.serve->ambient)
                                       : WalkAmbient::off;
        return welcome;
    }

    /// Read the scene, and draw until its files change. Throws InputError for what is wrong with
    /// it.
    void enter(const ServerThread& serving) {
        desk_.announce(LoadingReply{"reading " + welcome().scene, 0.1});
        SceneSession session(command_.common, warnings_, std::make_shared<FileRecorder>(watched_));
        desk_.announce(LoadingReply{"building the scene", 0.5});
        session.build(command_.settings);
        session.warn_of_darkness();
        const View home = !command_.serve->views.empty() ? command_.serve->views.front().view
                          : command_.view_given          ? command_.view
                                                         : view_of(session.scene());
        desk_.set_home(home);
        WalkRoom room(command_, session, home, *executor_, warnings_, desk_, screen_);
        LoadedReply loaded;
        loaded.views = command_.serve->views;
        if (loaded.views.empty()) loaded.views.push_back({"start", home});
        loaded.eye_height = room.eye_height();
        desk_.announce(loaded);
        auto looked = std::chrono::steady_clock::now();
        while (!interrupt_flag().requested() && !serving.ended()) {
            room.step(interrupt_flag());
            const auto now = std::chrono::steady_clock::now();
            if (now - looked < kLookAtFiles) continue;
            looked = now;
            if (watched_->have_changed()) return;
        }
    }

    /// After a scene that cannot be read. What comes meanwhile is of no use any more.
    void wait_for_change(const ServerThread& serving) {
        while (!watched_->have_changed() && !interrupt_flag().requested() && !serving.ended()) {
            const WalkInbox inbox = desk_.take(kLookAtFiles);
            for (const ClientId client : inbox.joined) screen_.join(client);
            for (const ClientId client : inbox.left) screen_.leave(client);
            for (const WebReply& reply : inbox.saves)
                reply({503, "text/plain; charset=utf-8", "there is no scene\n", {}});
            for (const WalkQuestion& question : inbox.questions) {
                const auto id = std::visit([](const auto& ask) { return ask.id; }, question.ask);
                desk_.tell(question.client, walk_text(RefusedReply{"there is no scene", id}));
            }
        }
    }

    RenderCommand command_;
    StderrWarnings warnings_;
    std::unique_ptr<Executor> executor_;
    WalkDesk desk_;
    WebServer server_;
    WalkScreen screen_;
    std::shared_ptr<WatchedFiles> watched_;
};

}  // namespace

int run_walk(const std::vector<std::string>& words, Transport*) {
    RenderCommand command = parse_render_command("walk", words, real_files());
    if (command.show_defaults) {
        std::fputs(describe(command).c_str(), stdout);
        return kSuccessStatus;
    }
    check_render_settings(command.settings);
    (void)Camera(command.view);
    settle_scene_files(command.common, "", *real_files());
    WalkProgram program(std::move(command));
    return program.run();
}

}  // namespace lightwalk
