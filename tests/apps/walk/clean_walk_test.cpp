// A view that rests is shown without noise where the page wants it; all else is as traced.
#include <doctest/doctest.h>
#include <turbojpeg.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "io/picture/picture.h"
#include "tests/apps/walk/steered_walk.h"

using namespace lightwalk;
using namespace lightwalk::test;

namespace {

constexpr int kRests = 2, kFinal = 4, kDenoised = 8;  // flags of a frame

std::string display_message(bool clean, bool false_colour = false) {
    return std::string(R"({"type":"display","mode":")") + (false_colour ? "false" : "tone") +
           R"(","exposure":{"auto":false,"ev":1},"human":false,"clean":)" +
           (clean ? "true" : "false") + R"(,"scale":{"low":1,"high":10000,"log":true}})";
}

/// Every pixel becomes this.
PictureCleaner::Denoise flat(float value, std::atomic<int>& times) {
    return [value, &times](Picture& picture, const std::function<bool()>&) {
        ++times;
        std::ranges::fill(picture.pixels, Rgb::grey(value));
        return true;
    };
}

/// Bytes of a frame's pieces of a codec, see io/net/README.md.
std::vector<std::string> pieces_of(const std::string& frame, int codec) {
    std::vector<std::string> pieces;
    std::size_t at = 48;
    for (int i = 0; i < frame_pieces(frame); ++i) {
        const auto size = number_at<std::uint32_t>(frame, at + 12);
        if (frame[at + 8] == codec) pieces.push_back(frame.substr(at + 16, size));
        at += 16 + size;
    }
    return pieces;
}

/// Difference of the darkest and the brightest pixel of a JPEG image.
int contrast(const std::string& jpeg) {
    const tjhandle handle = tjInitDecompress();
    std::vector<unsigned char> bytes(jpeg.begin(), jpeg.end());
    std::vector<unsigned char> grey(32 * 24);
    CHECK(tjDecompress2(handle, bytes.data(), bytes.size(), grey.data(), 32, 0, 24, TJPF_GRAY, 0) ==
          0);
    tjDestroy(handle);
    const auto [least, most] = std::ranges::minmax_element(grey);
    return *most - *least;
}

const std::string& last_frame(const Walk& walk) {
    return *walk.clients.frames.at(kDriver).back();
}

/// The newest picture that the driver has got: a frame that only says that it is the last has none.
int contrast_seen(const Walk& walk) {
    const auto& frames = walk.clients.frames.at(kDriver);
    for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame)
        if (const auto pieces = pieces_of(**frame, 1); !pieces.empty())
            return contrast(pieces.front());
    return -1;
}

/// Steps until the driver's last frame is as good as it gets, and has been since the message.
void finish_after(Walk& walk, const std::string& message) {
    const std::size_t frames = walk.clients.frames_of(kDriver);
    walk.inbox.message(kDriver, message);
    for (int i = 0; i < 2000; ++i) {
        walk.loop->step(walk.stop);
        for (const ClientId client : {kDriver, kWatcher}) walk.acknowledge(client);
        if (walk.clients.frames_of(kDriver) > frames && (frame_flags(last_frame(walk)) & kFinal))
            return;
    }
    FAIL("the view does not come to rest");
}

/// What the program answers to a pick in the middle of the picture.
nlohmann::json light_told(Walk& walk, int id) {
    walk.inbox.message(kDriver,
                       R"({"type":"pick","id":)" + std::to_string(id) + R"(,"x":0.5,"y":0.2})");
    walk.loop->step(walk.stop);
    for (const std::string& text : walk.clients.texts[kDriver]) {
        nlohmann::json told = nlohmann::json::parse(text);
        if (told["type"] == "picked" && told["id"] == id) {
            told.erase("id");
            return told;
        }
    }
    return {};
}

std::size_t times_told(const Walk& walk, const std::string& words) {
    return static_cast<std::size_t>(std::ranges::count_if(
        walk.clients.texts.at(kDriver),
        [&](const std::string& text) { return text.find(words) != std::string::npos; }));
}

}  // namespace

TEST_CASE("clean walk: a view that rests is shown clean, but is measured and saved as traced") {
    const LoadedScene scene(room());
    std::atomic<int> times{0};
    Walk walk(scene, flat(.1F, times));
    walk.inbox.message(kDriver, display_message(false));
    finish_after(walk, view_message(1, 0.25));
    CHECK((frame_flags(last_frame(walk)) & kDenoised) == 0);
    CHECK(times == 0);
    CHECK(contrast_seen(walk) > 20);
    const std::vector<Rgb> traced = read_hdr(walk.saved(), "saved").pixels;
    const nlohmann::json before = light_told(walk, 11);
    CHECK(before["luminance"] > 0);

    const std::size_t first = walk.clients.frames_of(kDriver);
    finish_after(walk, display_message(true));
    CHECK(times == 1);  // it was done
    CHECK((frame_flags(last_frame(walk)) & kDenoised) != 0);
    CHECK(contrast_seen(walk) < 3);
    CHECK(contrast_seen(walk) >= 0);
    for (std::size_t i = first; i < walk.clients.frames_of(kDriver); ++i)  // nor its luminance
        CHECK(pieces_of(*walk.clients.frames[kDriver][i], 4).empty());
    CHECK(read_hdr(walk.saved(), "saved").pixels == traced);
    CHECK(light_told(walk, 12) == before);

    SUBCASE("and as traced again") {
        finish_after(walk, display_message(false));
    }
    SUBCASE("false colours tell luminance: that of what was traced") {
        finish_after(walk, display_message(true, true));
    }
    CHECK((frame_flags(last_frame(walk)) & kDenoised) == 0);
    CHECK(contrast_seen(walk) > 20);
    CHECK(times == 1);
}

TEST_CASE("clean walk: an eye that moves sees what was traced, and what was begun is given up") {
    const LoadedScene scene(room());
    std::atomic<int> begun{0}, given_up{0};
    Walk walk(scene, [&](Picture& picture, const std::function<bool()>& goes_on) {
        if (++begun == 1) {
            while (goes_on()) std::this_thread::yield();
            ++given_up;
            return false;
        }
        std::ranges::fill(picture.pixels, Rgb::grey(.1F));
        return true;
    });
    walk.inbox.message(kDriver, display_message(true));
    walk.inbox.message(kDriver, view_message(1, 0));
    for (int i = 0; i < 2000 && begun == 0; ++i) {
        walk.loop->step(walk.stop);
        walk.acknowledge(kDriver);
    }
    REQUIRE(begun == 1);  // as soon as the picture is whole
    finish_after(walk, view_message(2, 0.5));
    CHECK(given_up == 1);
    CHECK(begun >= 2);
    CHECK(begun <= 3);  // once whole, once done
    CHECK((frame_flags(last_frame(walk)) & kDenoised) != 0);
    CHECK(number_at<std::uint32_t>(last_frame(walk), 8) == 2);
    bool clean = false;
    for (const auto& frame : walk.clients.frames[kDriver]) {
        const bool is_clean = (frame_flags(*frame) & kDenoised) != 0;
        if (is_clean) CHECK((frame_flags(*frame) & kRests) != 0);
        if (is_clean) CHECK(number_at<std::uint32_t>(*frame, 8) == 2);
        CHECK_FALSE((clean && !is_clean));  // noise does not come back
        clean = is_clean;
    }
    // The next view begins as it was traced.
    const std::size_t frames = walk.clients.frames_of(kDriver);
    finish_after(walk, view_message(3, 0));
    REQUIRE(walk.clients.frames_of(kDriver) > frames);
    CHECK((frame_flags(*walk.clients.frames[kDriver][frames]) & kDenoised) == 0);
}

TEST_CASE("clean walk: a denoiser that fails is told once, and the walk goes on") {
    const LoadedScene scene(room());
    Walk walk(scene, [](Picture&, const std::function<bool()>&) -> bool {
        throw InputError("Open Image Denoise: no memory");
    });
    walk.inbox.message(kDriver, display_message(true));
    finish_after(walk, view_message(1, 0));
    finish_after(walk, view_message(2, 0.5));
    for (const bool clean : {false, true}) {  // which changes nothing, so no frame comes
        walk.inbox.message(kDriver, display_message(clean));
        for (int i = 0; i < 3; ++i) walk.loop->step(walk.stop);
    }
    CHECK(times_told(walk, "Open Image Denoise: no memory") == 1);
    for (const auto& frame : walk.clients.frames[kDriver])
        CHECK((frame_flags(*frame) & kDenoised) == 0);
    CHECK(contrast_seen(walk) > 20);
}

TEST_CASE("clean walk: without a denoiser the page may wish what it wants") {
    const LoadedScene scene(room());
    Walk walk(scene);
    walk.inbox.message(kDriver, display_message(true));
    finish_after(walk, view_message(1, 0));
    CHECK((frame_flags(last_frame(walk)) & kDenoised) == 0);
}

TEST_CASE("clean view: what is not all there is left alone, what is not seen any more given up") {
    std::atomic<int> times{0};
    CleanView view([&times](Picture&, const std::function<bool()>& goes_on) {
        ++times;
        while (goes_on()) std::this_thread::yield();
        return false;
    });
    LivePicture picture;
    picture.width = picture.height = 1;
    picture.radiance = {Rgb::grey(1)};
    DisplayRequest display;
    display.clean = true;
    for (const WalkPhase phase : {WalkPhase::moving, WalkPhase::filling, WalkPhase::ambient}) {
        picture.phase = phase;
        CHECK_FALSE(view.follow(picture, display, true));
        CHECK_FALSE(view.is_coming());
    }
    for (const WalkPhase phase : {WalkPhase::refining, WalkPhase::done}) {
        picture.phase = phase;
        CHECK_FALSE(view.follow(picture, display, true));
        CHECK(view.is_coming());
        CHECK_FALSE(view.follow(picture, display, false));  // before another picture is drawn
        CHECK_FALSE(view.is_coming());
        CHECK(view.radiance().empty());
    }
    display.clean = false;
    CHECK_FALSE(view.follow(picture, display, true));
    CHECK_FALSE(view.is_coming());
    CHECK(times <= 2);
    CHECK(view.take_problem().empty());
}
