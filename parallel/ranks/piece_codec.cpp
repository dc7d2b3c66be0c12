#include "parallel/ranks/piece_codec.h"

#include <zstd.h>

#include <cstring>
#include <type_traits>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr std::size_t kPixelBytes = sizeof(PixelValue);
static_assert(kPixelBytes == 16 && std::is_trivially_copyable_v<PixelValue>);
constexpr int kFastest = 1;  ///< Zstandard's level: a hundredth of the time that tracing takes

}  // namespace

std::string encode_piece(const PixelRectangle& block, const std::vector<PixelValue>& values) {
    const std::size_t count = block.pixels();
    if (values.size() != count) throw InputError("a part of a picture lacks pixels");
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    std::string sorted(count * kPixelBytes, '\0');
    for (std::size_t k = 0; k < kPixelBytes; ++k) {
        for (std::size_t i = 0; i < count; ++i) sorted[k * count + i] = bytes[i * kPixelBytes + k];
    }
    std::string packed(ZSTD_compressBound(sorted.size()), '\0');
    const std::size_t size =
        ZSTD_compress(packed.data(), packed.size(), sorted.data(), sorted.size(), kFastest);
    if (ZSTD_isError(size) != 0) throw InputError("cannot compress a part of a picture");
    packed.resize(size);
    return packed;
}

std::vector<PixelValue> decode_piece(const PixelRectangle& block, std::string_view bytes) {
    const std::size_t count = block.pixels();
    std::string sorted(count * kPixelBytes, '\0');
    const std::size_t size =
        ZSTD_decompress(sorted.data(), sorted.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(size) != 0 || size != sorted.size())
        throw InputError("a part of a picture is damaged");
    std::vector<PixelValue> values(count);
    auto* to = reinterpret_cast<char*>(values.data());
    for (std::size_t k = 0; k < kPixelBytes; ++k) {
        for (std::size_t i = 0; i < count; ++i) to[i * kPixelBytes + k] = sorted[k * count + i];
    }
    return values;
}

}  // namespace lightwalk
