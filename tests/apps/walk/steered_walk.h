#pragma once
// A walk without a server, for tests: its loop, and what its pages get.
#include <doctest/doctest.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "apps/session/lightwalk/renderer.h"
#include "apps/session/local_backend.h"
#include "apps/session/render_backend.h"
#include "apps/walk/render_loop.h"
#include "apps/walk/scene_changer.h"
#include "core/cloud/cloud_frame.h"
#include "tests/apps/walk/recorded_clients.h"
#include "tests/test_scene.h"

namespace lightwalk::test {

inline const std::string kRoom = R"(
void plastic grey 0 0 5 .5 .5 .5 0 0
void light lamp 0 0 3 40 40 40
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey sphere ball 0 0 4 -1 2 .7 .7
lamp polygon panel 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
)";
inline constexpr ClientId kDriver{1}, kWatcher{2};

inline RendererOptions options_of(bool steered, bool groups = false) {
    RendererOptions options;
    if (groups) options.light_groups.emplace();
    options.threads = 2;
    options.steered = steered;
    options.pixels.spacing = 1;
    CloudOptions cloud = *default_reuse();
    cloud.samples = 1;  // also at edges, as in a picture
    if (steered) options.reuse = std::make_shared<const CloudOptions>(cloud);
    return options;
}

inline SceneSource room(const std::string& text = kRoom) {
    SceneSource source;
    source.bytes = text;
    return source;
}

/// A walk without a server: two pages that are one step away.
struct Walk {
    explicit Walk(const LoadedScene& scene, double rate = 30, bool groups = false)
        : Walk(scene, options_of(true, groups), rate) {}
    /// One whose pages may see denoised pictures, and are told luminances.
    Walk(const LoadedScene& scene, PictureCleaner::Denoise denoise)
        : Walk(scene.compiled(), options_of(true), 30, true, std::move(denoise)) {}
    /// @param changes  whether its scene may be changed
    Walk(const LoadedScene& scene, const RendererOptions& renderer_options, double rate = 30,
         bool changes = true)
        : Walk(scene.compiled(), renderer_options, rate, changes) {}
    Walk(const std::shared_ptr<const CompiledScene>& scene, const RendererOptions& renderer_options,
         double rate = 30, bool changes = true, PictureCleaner::Denoise denoise = {})
        : renderer(std::make_unique<LocalBackend>(scene, renderer_options)) {
        inbox.attach(clients);
        for (const ClientId client : {kDriver, kWatcher})
            inbox.message(client,
                          hello("0123456789abcde" + std::to_string(static_cast<int>(client))));
        View home;
        home.position = {0, -4, 1.5};
        RenderLoopOptions options{rate, 1, "lightwalk walk"};
        options.denoise = std::move(denoise);
        if (changes) {
            options.change = scene_changer(renderer.backend());
            options.replace = scene_replacer(renderer.backend());
        }
        loop.emplace(std::move(options), renderer.backend().session(), home,
                     renderer.backend().frames(), *executor, warnings, inbox, screen);
    }
    /// Until the driver's view is as good as it gets, and on its screen.
    void rest() {
        for (int i = 0; i < 2000; ++i) {
            loop->step(stop);
            for (const ClientId client : {kDriver, kWatcher}) acknowledge(client);
            if (clients.frames_of(kDriver) > 0 &&
                (frame_flags(*clients.frames[kDriver].back()) & 4) != 0)
                return;
        }
        FAIL("the view does not come to rest");
    }
    void acknowledge(ClientId client) {
        if (clients.frames_of(client) == acked[client]) return;
        acked[client] = clients.frames_of(client);
        inbox.message(client, R"({"type":"ack","frame":)" +
                                  std::to_string(frame_number(*clients.frames[client].back())) +
                                  "}");
    }
    [[nodiscard]] std::string saved(const std::string& name = "picture.hdr") {
        std::string bytes;
        inbox.save("/save/" + name, WebReply([&](WebAnswer answer) { bytes = answer.bytes; }));
        loop->step(stop);
        return bytes;
    }

    Silence warnings;
    Renderer renderer;
    RecordedClients clients;
    std::map<ClientId, std::size_t> acked;
    ClientInbox inbox{WelcomeReply{}};
    std::unique_ptr<Executor> executor = make_executor(kDefaultExecutor, 2);
    WalkScreen screen{*executor};
    std::optional<RenderLoop> loop;
    StopFlag stop;
};

/// A floor and a ball under the sky of an hour of the 21st of September.
inline std::string sunlit(const std::string& hour, const std::string& colour = ".5 .5 .5") {
    return "!gensky 9 21 " + hour + " +s -a 46 -o -7 -m -15\n" + R"(
skyfunc glow sky_glow 0 0 4 1 1 1 0
sky_glow source sky 0 0 4 0 0 1 180
void plastic grey 0 0 5 )" +
           colour + R"( 0 0
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey sphere ball 0 0 4 -1 2 .7 .7
)";
}

}  // namespace lightwalk::test
