#include "io/scene/frozen_file.h"

#include <doctest/doctest.h>

#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "io/files/library_path.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;

namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span<const char>(text));
}
std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

const std::string kLong(1000, 'l');

std::vector<FrozenPart> sample_parts() {
    return {{1, 0, bytes_of("first")}, {2, 0, {}}, {1, 7, bytes_of(kLong)}};
}

FrozenFile in_memory(const std::string& bytes) {
    auto words = std::make_shared<std::vector<std::uint64_t>>(bytes.size() / 8 + 1);
    std::memcpy(words->data(), bytes.data(), bytes.size());
    const auto all = std::as_bytes(std::span(*words)).first(bytes.size());
    return {std::move(words), all, "a.lwz"};
}

/// What is said of bytes that are not taken; "" where all parts are.
std::string refusal(const std::string& bytes) {
    try {
        const FrozenFile file = in_memory(bytes);
        for (const FrozenPart& part : sample_parts()) (void)file.part(part.kind, part.owner);
        return {};
    } catch (const InputError& error) {
        return error.what();
    }
}

}  // namespace

TEST_CASE("a frozen file gives back its parts, each from a multiple of 64 bytes on") {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("a.lwz");
    write_frozen_file(path, sample_parts());
    CHECK(read_file(path) == frozen_file_bytes(sample_parts()));
    const FrozenFile file(std::make_shared<const MappedFile>(path));
    CHECK(file.name() == path);
    for (const FrozenPart& part : sample_parts()) {
        REQUIRE(file.has(part.kind, part.owner));
        const auto found = file.part(part.kind, part.owner);
        CHECK(text_of(found) == text_of(part.bytes));
        CHECK(reinterpret_cast<std::uintptr_t>(found.data()) % kFrozenAlignment == 0);
    }
    CHECK_FALSE(file.has(2, 7));
    CHECK_THROWS_WITH_AS((void)file.part(2, 7),
                         (path + ": damaged: part 2 of 7 is missing").c_str(), InputError);
    CHECK(folder.files() == std::vector<std::string>{"a.lwz"});
    CHECK(refusal(frozen_file_bytes(sample_parts())).empty());
}

TEST_CASE("the digest of a frozen file tells other contents") {
    std::vector<FrozenPart> parts = sample_parts();
    const std::uint64_t digest = in_memory(frozen_file_bytes(parts)).digest();
    CHECK(in_memory(frozen_file_bytes(parts)).digest() == digest);
    parts[0].bytes = bytes_of("First");
    CHECK(in_memory(frozen_file_bytes(parts)).digest() != digest);
}

TEST_CASE("a frozen file that is cut short anywhere, or too long, is refused") {
    const std::string whole = frozen_file_bytes(sample_parts());
    for (std::size_t size = 1; size < whole.size(); ++size) {
        CAPTURE(size);
        const std::string said = refusal(whole.substr(0, size));
        CHECK(said ==
              (size < 8 ? "a.lwz: is no frozen scene" : "a.lwz: truncated: its end is missing"));
    }
    CHECK(refusal(whole + 'x') == "a.lwz: damaged: there are bytes after its end");
}

TEST_CASE("every changed bit of header, table and parts is noticed") {
    const std::string whole = frozen_file_bytes(sample_parts());
    const auto is_padding = [](std::size_t at) {
        return (at >= 64 + 3 * 32 && at < 192) || (at >= 192 + 5 && at < 256);
    };
    for (std::size_t at = 0; at < whole.size(); ++at) {
        if (is_padding(at)) continue;
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ (1 << (at % 8)));
        CAPTURE(at);
        CHECK_FALSE(refusal(changed).empty());
        CHECK(refusal(changed).starts_with("a.lwz: "));
    }
}

TEST_CASE("versions and machines of another kind are told") {
    const std::string whole = frozen_file_bytes(sample_parts());
    std::string other = whole;
    std::swap(other[8], other[11]);
    std::swap(other[9], other[10]);
    CHECK(refusal(other) ==
          "a.lwz: frozen on another kind of machine: freeze the scene again here");
    other = whole;
    other.replace(16, 6, std::string("0.0.1\0", 6));
    CHECK(refusal(other).starts_with(
        "a.lwz: frozen by another version of Lightwalk, 0.0.1, this is "));
    other = whole;
    ++other[12];
    CHECK(refusal(other).find("another version") != std::string::npos);
    CHECK(refusal("#?RADIANCE\n" + kLong) == "a.lwz: is no frozen scene");
}

TEST_CASE("resealed bytes are taken with what was changed in them") {
    std::string bytes = frozen_file_bytes(sample_parts());
    CHECK(resealed(bytes) == bytes);
    bytes[192] = 'F';
    CHECK_FALSE(refusal(bytes).empty());
    CHECK(refusal(resealed(bytes)).empty());
    CHECK(text_of(in_memory(resealed(bytes)).part(1)) == "First");
    CHECK(resealed("short") == "short");
}
