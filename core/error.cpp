#include "core/error.h"

#include <array>
#include <cstddef>

namespace lightwalk {
namespace {

constexpr std::size_t kLongestWord = 1000;  ///< of a message [bytes]

/// Code point of the well-formed UTF-8 sequence of `size` bytes that begins `text`; 0: it is none.
char32_t decode_utf8(std::string_view text, std::size_t size) {
    constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};  // of so many bytes
    if (text.size() < size) return 0;
    auto code = static_cast<unsigned char>(text[0]) & (0x7fU >> size);
    for (std::size_t i = 1; i < size; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xc0U) != 0x80U) return 0;
        code = code << 6U | (byte & 0x3fU);
    }
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    return code < kLeast[size] || code > 0x10ffff || surrogate ? 0 : code;
}

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n';
}

/// How many bytes the printable character has that begins `text`; 0: none begins it.
std::size_t printable_size(std::string_view text) {
    constexpr char32_t kFirstPrintable = 0xa0;  // those before are control characters, too
    const auto lead = static_cast<unsigned char>(text[0]);
    if (lead < 0x80) return is_blank(text[0]) || (lead >= 0x20 && lead < 0x7f) ? 1 : 0;
    const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc0 || lead >= 0xf8) return 0;
    return decode_utf8(text, size) >= kFirstPrintable ? size : 0;
}

}  // namespace

std::string printable(std::string_view text) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string shown;
    std::size_t word = 0;  // bytes of the present word, as shown
    while (!text.empty()) {
        const std::size_t size = printable_size(text);
        if (is_blank(text[0])) word = 0;
        std::string character(text.substr(0, size));
        if (size == 0) {
            const auto byte = static_cast<unsigned char>(text[0]);
            character = {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 15U]};
        }
        if (word <= kLongestWord && word + character.size() > kLongestWord) shown += "...";
        word += character.size();
        if (word <= kLongestWord) shown += character;
        text.remove_prefix(size == 0 ? 1 : size);
    }
    return shown;
}

}  // namespace lightwalk
