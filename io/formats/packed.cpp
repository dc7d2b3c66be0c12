#include "io/formats/packed.h"

#include <utility>

#include "core/error.h"

namespace lightwalk {

void PackedWriter::text(std::string_view text) {
    count(text.size());
    bytes_.append(text);
}

void PackedWriter::texts(std::span<const std::string> texts) {
    count(texts.size());
    for (const std::string& one : texts) text(one);
}

PackedReader::PackedReader(std::span<const std::byte> bytes, std::string name, std::string what)
    : bytes_(bytes), name_(std::move(name)), what_(std::move(what)) {}

void PackedReader::fail() const {
    throw InputError({name_, 0}, "damaged: " + what_);
}

const std::byte* PackedReader::take(std::size_t size) {
    if (size > bytes_.size()) fail();
    const std::byte* const begin = bytes_.data();
    bytes_ = bytes_.subspan(size);
    return begin;
}

bool PackedReader::boolean() {
    const auto value = number<std::uint8_t>();
    if (value > 1) fail();
    return value == 1;
}

std::size_t PackedReader::count(std::size_t least) {
    const auto value = number<std::uint64_t>();
    if (value > bytes_.size() / least) fail();
    return static_cast<std::size_t>(value);
}

std::string PackedReader::text() {
    const std::size_t size = count(1);
    return {reinterpret_cast<const char*>(take(size)), size};
}

std::vector<std::string> PackedReader::texts() {
    std::vector<std::string> result(count(sizeof(std::uint64_t)));
    for (std::string& one : result) one = text();
    return result;
}

void PackedReader::end() const {
    if (!bytes_.empty()) fail();
}

}  // namespace lightwalk
