#include "parallel/ranks/message.h"

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
    return point;
}

std::vector<Message> some_messages() {
    const JobBlock work{7, {8, 16, 24, 20}};
    std::vector<PixelValue> values(64);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = {{static_cast<float>(i), 1.0F / static_cast<float>(i + 1), -0.0F}, 1e10F};
    const TracedPixelResult one{values[1], {{some_point()}, 1}};
    const TracedPixelResult two{values[2], {{some_point(), some_point()}, 2}};
    CloudPart part;
    part.frame = 3;
    part.area = work.block;
    part.pixels = "pixels";
    part.report.uncached[2] = 5;
    part.report.audit_errors = {.5F, 1e-9F, 0};
    part.ages[25] = 77;
    part.origins = {{PixelOrigin::Kind::traced, 3, 0}, {PixelOrigin::Kind::reused, 0, 255}};
    part.refined = {values[3]};
    return {JobStart{3, {0, 0, 640, 480}, 4, true, "a view", {{0, 0, 8, 8}}, true},
            AskBlocks{2, {{work, .125}, {{7, {0, 0, 1, 1}}, 1e-9}}},
            GiveBlocks{{work, {8, {-4, 0, 4, 1}}}},
            Pixels{work, values},
            BlockDone{{work, {}}, 2.5},
            PicturePiece{work, std::string("\0\xff bytes", 8)},
            FinishedPicture{7, {PicturePiece{work, "one"}, PicturePiece{work, ""}}},
            AmbientValues{{some_record(1), some_record(-1e-30F)}},
            Failure{"node17", "room.rad:3: what is wrong"},
            Finish{},
            Report{"{}"},
            Gather{9, {"a", "", "ccc"}},
            Progress{7, .5},
            AskChunks{3, 4096},
            RayChunk{5, 1ULL << 40, {1, -0.0, 1e-300, .1, 0, 2}},
            ChunkAnswer{5, 1, .25, std::string("\0\xff", 2)},
            CloudOrder{
                640, 480, {3, false, .5, {25, 1000}}, "a view", .25, true, true, true, 2, {{1, 2}}},
            CloudPoints{3, {some_point(), {}}},
            CloudUsed{3, {{{1, 2}, {3, 4}}, {{5, 6}}}},
            UncachedPixels{3, 1, {{1, 2}, {1, 2}}},
            AskUncachedPixels{2},
            GiveUncachedPixels{3, 1, 7, true, false, {{1, 2}}},
            TracedPixelResults{3, 7, 3, {{values[0], {}}, one, two}},
            CloudStage{3, CloudStage::Kind::pixels},
            part,
            FinishedFrame{3, {part, part}}};
}

}  // namespace

TEST_CASE("a message is the same after its way over the wire") {
    const std::vector<Message> messages = some_messages();
    REQUIRE(messages.size() == kMessageKinds);
    for (std::size_t kind = 0; kind < messages.size(); ++kind) {
        CAPTURE(kind);
        REQUIRE(messages[kind].index() == kind);
        const Envelope sent{{4, Role::worker}, {0, Role::master}, messages[kind]};
        const std::string bytes = encode_message(sent);
        CHECK(bytes.size() == message_bytes(sent.message));
        const Envelope got = decode_message(bytes, 4, 0);
        CHECK(got.from == sent.from);
        CHECK(got.to == sent.to);
        REQUIRE(got.message.index() == kind);
        // What is equal to the bit has the same bytes.
        CHECK(encode_message(got) == bytes);
    }
}

TEST_CASE("an ambient record takes 68 bytes and arrives to the bit") {
    const Envelope sent{
        {1, Role::ambient_client}, {0, Role::ambient_master}, AmbientValues{{some_record(3)}, 5}};
    const std::string bytes = encode_message(sent);
    CHECK(bytes.size() == 4 + 8 + 68 + 4);
    const Envelope got = decode_message(bytes, 1, 0);
    CHECK(std::get<AmbientValues>(got.message).scene == 5);
    const AmbientRecord record = std::get<AmbientValues>(got.message).records.at(0);
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

TEST_CASE("a point takes 40 bytes and arrives to the bit, and its kind is checked") {
    const Envelope sent{{1, Role::tracer}, {2, Role::worker}, CloudPoints{9, {some_point()}}};
    std::string bytes = encode_message(sent);
    CHECK(bytes.size() == 4 + 8 + 8 + 40);
    const Envelope got = decode_message(bytes, 1, 2);
    CHECK(std::get<CloudPoints>(got.message).points.at(0) == some_point());
    bytes[bytes.size() - 4] = static_cast<char>(kPointKinds);
    CHECK_THROWS_AS((void)decode_message(bytes, 1, 2), InputError);
}

TEST_CASE("bytes that are no message are refused, whatever they are") {
    std::mt19937 random(1);
    for (const Message& message : some_messages()) {
        const std::string sound = encode_message({{1, Role::worker}, {0, Role::master}, message});
        for (std::size_t size = 0; size < sound.size(); ++size)
            CHECK_THROWS_AS((void)decode_message(sound.substr(0, size), 1, 0), InputError);
        CHECK_THROWS_AS((void)decode_message(sound + '\0', 1, 0), InputError);
        for (int mutant = 0; mutant < 300; ++mutant) {
            std::string bytes = sound;
            for (int k = 0; k < 3; ++k)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            try {  // it may still be one, with other numbers in it
                const std::size_t size = encode_message(decode_message(bytes, 1, 0)).size();
                CHECK(size == bytes.size());
            } catch (const InputError&) {
            }
        }
    }
}
