#include "parallel/work_queue/message.h"

#include <doctest/doctest.h>

#include <random>

#include "core/error.h"

using namespace lightwalk;

namespace {

AmbientRecord some_record(float x) {
    AmbientRecord record;
    record.position = {x, 2 * x, -x};
    record.normal = 12345;
    record.axis = 0xfedcba98;
    record.radius = {.1F, .2F};
    record.translation = {1e-7F, -3};
    record.rotation = {.5F, -.25F};
    record.value = {.1F, 1.0F / 3, 7e20F};
    record.weight = .7F;
    record.corral = 0x80000001;
    record.level = 3;
    return record;
}

CloudPoint some_point() {
    CloudPoint point;
    point.position = {1, -2, 1e10F};
    point.radiance = {.1F, 1.0F / 3, 7e20F};
    point.surface = 0x80000001;
    point.direction = 77;
    point.kind = PointKind::mirrored;
    point.age = 255;
    point.paired = true;
    point.pattern = 3;
    return point;
}

/// Every kind of message, with every alternative that it may hold.
std::vector<Message> some_messages() {
    const JobBlock work{7, {8, 16, 24, 20}};
    std::vector<PixelValue> values(64);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = {{static_cast<float>(i), 1.0F / static_cast<float>(i + 1), -0.0F}, 1e10F};
    const TracedPixelResult one{values[1], {{some_point()}, 1}};
    const TracedPixelResult two{values[2], {{some_point(), some_point()}, 2}};
    FrameOrder order;
    order.number = 9;
    order.width = 640;
    order.rules = {3, false, .5};
    order.payload = "a view";
    order.budget = .25;
    order.rests = order.tells_origins = true;
    order.refined = {{1, 2}};
    order.mixture.levels = {{.5F, 1, 2}, {0, 0, 0}};
    FramePart part;
    part.frame = 3;
    part.area = work.block;
    part.pixels = "pixels";
    part.unknown = {3, 77};
    part.report.uncached[2] = 5;
    part.report.audit_errors = {.5F, 1e-9F, 0};
    part.origins = {{PixelOrigin::Kind::traced, 3, 0}, {PixelOrigin::Kind::reused, 0, 255}};
    part.refined = {values[3], std::nullopt};
    part.refined_groups = {{1, 2, 3}, {4, 5, 6}};
    FramePart plain = part;
    plain.pixels = values;
    AmbientValues news{
        {some_record(1)}, AmbientValues::Direction::news, {{1, 2, 3}, {4, 5, 6}}, 12};
    return {Announcement{PictureJob{3, {0, 0, 640, 480}, 4, true, "a view", {{0, 0, 8, 8}}, true}},
            Announcement{order},
            Announcement{ChangeOrder{12, ChangeOrder::Step::prepare, "a sky", {0, 1, 1}}},
            Announcement{ChangeOrder{12, ChangeOrder::Step::drop, {}, {}}},
            WorkRequest{2, {{FinishedWork::Payload::rays, 7, 64, .125, 3}, {}}},
            WorkGrant{{work, RayChunk{5, 1ULL << 40, {1, -0.0, 1e-300, .1, 0, 2}},
                       PixelRun{3, 1, 7, true, false, {{1, 2}}}},
                      std::nullopt},
            WorkGrant{{}, FrameNumber{4}},
            WorkResult{Pixels{work, values}},
            WorkResult{Pixels{work, values, {{1, -0.0F, 1e-30F}}}},
            WorkResult{LoggedPixels{{work, {}}}},
            WorkResult{RayAnswer{5, std::string("\0\xff", 2)}},
            WorkResult{TracedRun{3, 1, 7, 3, {{values[0], {}}, one, two}}},
            WorkResult{TracedRun{3, 1, 7, 3, {}}},
            WorkResult{TracedRun{3, 1, 7, 3, {one}, {{1, 2, 3}}, {{4, 5, 6}}}},
            FinishedPart{PicturePart{work, std::string("\0\xff bytes", 8)}},
            FinishedPart{PicturePart{work, "bytes", {"a", "", "ccc"}}},
            FinishedPart{part},
            FinishedPart{plain},
            UncachedPixels{3, 1, {{1, 2}, {1, 2}}},
            PointExchange{3, SharedPoints{{some_point(), CloudPoint{}}}},
            PointExchange{3, SharedPoints{{some_point()}, {{1, 2, 3}, {4, 5, 6}}}},
            PointExchange{3, UsedPixels{{{1, 2}, {3, 4}}, {{5, 6}}}},
            AmbientValues{{some_record(1), some_record(-1e-30F)}},
            news,
            Collective{Collective::Group::owners, 9, true, {"a", "", "ccc"}, {1, ~0ULL}},
            Notice{Failure{"node17", "room.rad:3: what is wrong"}},
            Notice{Finish{}},
            Notice{Report{"{}"}},
            Notice{PreparedChange{12, "room.rad:3: what is wrong", 1ULL << 40, 7}}};
}

}  // namespace

TEST_CASE("a message is the same after its way over the wire") {
    std::vector<bool> seen(kMessageKinds);
    for (const Message& message : some_messages()) {
        CAPTURE(message.index());
        seen[message.index()] = true;
        const std::string bytes = encode_message(message);
        CHECK(bytes.size() == message_bytes(message));
        const Message got = decode_message(bytes);
        REQUIRE(got.index() == message.index());
        // What is equal to the bit has the same bytes.
        CHECK(encode_message(got) == bytes);
    }
    for (std::size_t kind = 0; kind < kMessageKinds; ++kind) CHECK(seen[kind]);
    CHECK(kMessageKinds <= 10);
}

TEST_CASE("an ambient record takes 65 bytes and arrives to the bit") {
    const std::string bytes = encode_message(AmbientValues{{some_record(3)}});
    CHECK(bytes.size() == 2 + 8 + 65 + 1 + 8 + 8);
    const auto got = std::get<AmbientValues>(decode_message(bytes));
    const AmbientRecord record = got.records.at(0);
    const AmbientRecord expected = some_record(3);
    CHECK(record.position == expected.position);
    CHECK(record.normal == expected.normal);
    CHECK(record.axis == expected.axis);
    CHECK(record.radius == expected.radius);
    CHECK(record.translation == expected.translation);
    CHECK(record.rotation == expected.rotation);
    CHECK(record.value == expected.value);
    CHECK(record.weight == expected.weight);
    CHECK(record.corral == expected.corral);
    CHECK(record.level == expected.level);
}

TEST_CASE("a point takes 41 bytes and arrives to the bit, and its kind is checked") {
    std::string bytes = encode_message(PointExchange{9, SharedPoints{{some_point()}}});
    CHECK(bytes.size() == 2 + 8 + 1 + 8 + 41 + 8);
    const auto got = std::get<PointExchange>(decode_message(bytes));
    CHECK(std::get<SharedPoints>(got.points).points.at(0) == some_point());
    bytes[bytes.size() - 8 - 5] = static_cast<char>(kPointKinds);
    CHECK_THROWS_AS((void)decode_message(bytes), InputError);
}

TEST_CASE("bytes of another version of the program are refused") {
    std::string bytes = encode_message(Notice{Finish{}});
    ++bytes[0];
    CHECK_THROWS_WITH_AS((void)decode_message(bytes), doctest::Contains("version"), InputError);
}

TEST_CASE("bytes that are no message are refused, whatever they are") {
    std::mt19937 random(1);
    for (const Message& message : some_messages()) {
        const std::string sound = encode_message(message);
        for (std::size_t size = 0; size < sound.size(); ++size)
            CHECK_THROWS_AS((void)decode_message(sound.substr(0, size)), InputError);
        CHECK_THROWS_AS((void)decode_message(sound + '\0'), InputError);
        for (int mutant = 0; mutant < 300; ++mutant) {
            std::string bytes = sound;
            for (int k = 0; k < 3; ++k)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            try {  // it may still be one, with other numbers in it
                const std::size_t size = encode_message(decode_message(bytes)).size();
                CHECK(size == bytes.size());
            } catch (const InputError&) {
            }
        }
    }
}
