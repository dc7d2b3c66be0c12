#include "apps/walk/depth_piece.h"

#include <doctest/doctest.h>

#include <cstring>
#include <random>

using namespace lightwalk;

namespace {

constexpr int kWidth = 320, kHeight = 200;

/// The step of a piece [1/m].
float step_of(const std::string& bytes) {
    float step = 0;
    std::memcpy(&step, bytes.data(), sizeof step);
    return step;
}

}  // namespace

TEST_CASE(
    "depth piece: what is too rough for a link gets coarser steps, and finer ones again later") {
    const std::unique_ptr<Executor> executor = make_executor(ExecutorKind::serial, 1);
    LivePicture rough, smooth;
    for (LivePicture* picture : {&rough, &smooth}) {
        picture->width = kWidth;
        picture->height = kHeight;
        picture->radiance.resize(std::size_t{kWidth} * kHeight);
        picture->distance.assign(picture->radiance.size(), 5);
    }
    std::mt19937 random(1);
    for (float& distance : rough.distance)
        distance = std::uniform_real_distribution<float>(4.9f, 5.1f)(random);
    DepthPiece piece;
    const auto bytes = [&](const LivePicture& picture) -> const std::string& {
        piece.keep(picture, View{}, 1.6, *executor);
        return piece.bytes(*executor);
    };
    const float finest = step_of(bytes(smooth));
    std::size_t first = bytes(rough).size(), last = first;
    for (int k = 0; k < 4; ++k) last = bytes(rough).size();
    CHECK(last < first / 4);
    CHECK(step_of(bytes(rough)) > 1.9f * finest);
    CHECK(step_of(bytes(rough)) < 8.1f * finest);
    for (int k = 0; k < 100; ++k) {
        smooth.distance[0] += 0.01f;  // a piece is coded once only
        (void)bytes(smooth);
    }
    CHECK(step_of(bytes(smooth)) == finest);
}

TEST_CASE("depth piece: its content changes with the distances and with the view's angles alone") {
    const std::unique_ptr<Executor> executor = make_executor(ExecutorKind::serial, 1);
    LivePicture picture;
    picture.width = kWidth;
    picture.height = kHeight;
    picture.radiance.resize(std::size_t{kWidth} * kHeight);
    picture.distance.assign(picture.radiance.size(), 5);
    DepthPiece piece;
    const auto content = [&](const View& view) {
        piece.keep(picture, view, 1.6, *executor);
        return piece.content();
    };
    View view;
    const std::uint64_t first = content(view);
    CHECK(first != 0);
    view.position = {1, 2, 3};
    CHECK(content(view) == first);
    picture.distance.back() = 6;
    CHECK(content(view) != first);
    picture.distance.back() = 5;
    view.horizontal = 50;
    CHECK(content(view) != first);
    for (const char type : {'l', 'a', 'c'}) {
        view.type = type;
        CHECK(content(view) == 0);
        CHECK(piece.bytes(*executor).empty());
    }
    view.type = 'v';
    view.fore = 1;
    CHECK(content(view) == 0);
}
