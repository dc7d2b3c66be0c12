// lightwalk walk: light in the browser. A web server on a thread of its own, and the frames.
#include <cstdio>
#include <exception>
#include <optional>
#include <thread>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/rank_session.h"
#include "apps/render_command.h"
#include "apps/renderer_request.h"
#include "apps/walk/pages.h"
#include "apps/walk/render_loop.h"
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
    constexpr double kEyeHeight = 1.6, kHalf = 0.5;
    view.position = kHalf * (bounds.lower + bounds.upper);
    view.position.z = bounds.lower.z + std::min(kEyeHeight, kHalf * size.z);
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
    options.limits.close_timeout = std::chrono::milliseconds(300);  // Ctrl-C is soon over
    return options;
}

/// The server, as the inbox knows it.
class ServerSender final : public ClientSender {
  public:
    explicit ServerSender(WebServer& server) : server_(server) {}
    void send_text(ClientId client, std::string text) override {
        server_.send_text(client, std::move(text));
    }
    void send_binary(ClientId client, std::shared_ptr<const std::string> bytes) override {
        server_.send_binary(client, std::move(bytes));
    }

  private:
    WebServer& server_;
};

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

// What rank 0 tells the others to do next.
constexpr const char *kLoad = "load", *kEnd = "end";

/// The other ranks: scene after scene.
int follow_walk(RankLink& link, const RenderCommand& command) {
    StderrWarnings warnings("lightwalk walk");
    warnings.enable(false);  // rank 0 has the same
    while (link.next_command() == kLoad) {
        try {
            Renderer renderer = open_renderer(&link, renderer_request(command, warnings), warnings);
            renderer.run([] {});
        } catch (const AgreedProblem&) {
            continue;  // until its files change
        }
    }
    return kSuccessStatus;
}

/// What serves the page: this process, or rank 0.
class WalkProgram {
  public:
    /// @param link  to the other ranks; null: there are none
    WalkProgram(const RenderCommand& command, RankLink* link)
        : command_(command),
          link_(link),
          warnings_("lightwalk walk"),
          executor_(make_executor(command_.common.executor, command_.common.workers)),
          client_inbox_(welcome()),
          server_(web_options(*command_.serve), viewer_pages(), client_inbox_),
          sender_(server_),
          screen_(*executor_) {
        warnings_.enable(command_.settings.warnings && !command_.common.quiet);
        client_inbox_.attach(sender_);
    }

    int run() {
        std::printf("%s\n", server_.url().c_str());
        std::fflush(stdout);
        const ServerThread serving(server_);
        while (!interrupt_flag().requested() && !serving.ended()) {
            watched_ = std::make_shared<WatchedFiles>();
            try {
                enter(serving);
            } catch (const InputError& error) {
                std::fprintf(stderr, "%s\n", error.what());
                client_inbox_.announce(FailedReply{lines_of(error.what())});
            } catch (const AgreedProblem& problem) {
                client_inbox_.announce(FailedReply{lines_of(problem.text)});
            }
            wait_for_change(serving);
            if (!interrupt_flag().requested()) std::this_thread::sleep_for(kWriting);
        }
        // Nothing is drawn any more: what is left is short, and is not cut off.
        if (link_ == nullptr)
            set_interrupt_phase(InterruptPhase::finish);
        else
            (void)link_->next_command(kEnd);
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

    /// Throws InputError for what is wrong with the scene, or AgreedProblem.
    [[nodiscard]] Renderer open() {
        client_inbox_.announce(LoadingReply{"reading " + welcome().scene, 0.1});
        if (link_ != nullptr) (void)link_->next_command(kLoad);
        RendererRequest request = renderer_request(command_, warnings_);
        request.files = watched_;
        request.when_read = [this] {
            client_inbox_.announce(LoadingReply{"building the scene", 0.5});
        };
        return open_renderer(link_, request, warnings_);
    }

    /// Read the scene, and draw until its files change. Throws as open().
    void enter(const ServerThread& serving) {
        Renderer renderer = open();
        renderer.session().warn_of_darkness();
        renderer.run([&] { stay(renderer.session(), renderer.frames(), serving); });
    }

    [[nodiscard]] RenderLoopOptions loop_options() const {
        return {command_.walk->rate, command_.serve->edge_samples, command_.history};
    }

    /// Draw until the scene's files change.
    void stay(const SceneSession& session, LiveFrames& frames, const ServerThread& serving) {
        const View home = !command_.serve->views.empty() ? command_.serve->views.front().view
                          : command_.view_given          ? command_.view
                                                         : view_of(session.scene());
        client_inbox_.set_home(home);
        RenderLoop loop(loop_options(), session, home, frames, *executor_, warnings_, client_inbox_,
                        screen_);
        if (link_ != nullptr) loop.set_company(link_->ranks(), command_.common.workers);
        LoadedReply loaded;
        loaded.views = command_.serve->views;
        if (loaded.views.empty()) loaded.views.push_back({"start", home});
        loaded.eye_height = loop.eye_height();
        client_inbox_.announce(loaded);
        auto looked = std::chrono::steady_clock::now();
        while (!interrupt_flag().requested() && !serving.ended()) {
            loop.step(interrupt_flag());
            const auto now = std::chrono::steady_clock::now();
            if (now - looked < kLookAtFiles) continue;
            looked = now;
            if (watched_->have_changed()) return;
        }
    }

    /// After a scene that cannot be read. What comes meanwhile is of no use any more.
    void wait_for_change(const ServerThread& serving) {
        while (!watched_->have_changed() && !interrupt_flag().requested() && !serving.ended()) {
            const InboxContents inbox = client_inbox_.pop(kLookAtFiles);
            for (const ClientId client : inbox.joined) screen_.join(client);
            for (const ClientId client : inbox.left) screen_.leave(client);
            for (const WebReply& reply : inbox.saves)
                reply({503, "text/plain; charset=utf-8", "there is no scene\n", {}});
            for (const WalkQuestion& question : inbox.questions) {
                const auto id = std::visit([](const auto& ask) { return ask.id; }, question.ask);
                client_inbox_.tell(question.client,
                                   walk_text(RefusedReply{"there is no scene", id}));
            }
        }
    }

    const RenderCommand& command_;
    RankLink* link_;
    StderrWarnings warnings_;
    std::unique_ptr<Executor> executor_;
    ClientInbox client_inbox_;
    WebServer server_;
    ServerSender sender_;
    WalkScreen screen_;
    std::shared_ptr<WatchedFiles> watched_;
};

}  // namespace

int run_walk(const std::vector<std::string>& words, Communicator* ranks) {
    std::optional<RenderCommand> command;
    parse_on_ranks(ranks, "lightwalk walk", [&](const std::shared_ptr<FileSource>& files) {
        RenderCommand parsed = parse_render_command("walk", words, files);
        if (parsed.show_defaults) {
            if (ranks == nullptr || ranks->rank() == 0)
                std::fputs(describe(parsed).c_str(), stdout);
            return;
        }
        check_render_settings(parsed.settings);
        (void)Camera(parsed.view);
        resolve_scene_files(parsed.common, "", *files);
        command = std::move(parsed);
    });
    if (!command) return kSuccessStatus;
    handle_interrupts();
    const std::unique_ptr<RankLink> link =
        link_ranks(ranks, command->common,
                   {"lightwalk walk", caches_ambient_values(command->settings.light), false,
                    command->walk->projectors});
    if (!link) {
        set_interrupt_phase(InterruptPhase::request);
        return WalkProgram(*command, nullptr).run();
    }
    const auto body = [&] {
        return link->leads() ? WalkProgram(*command, link.get()).run()
                             : follow_walk(*link, *command);
    };
    return link->run(body, interrupt_flag());
}

}  // namespace lightwalk
