#include "io/bsdf/xml_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "core/model/transform_args.h"
#include "io/language/number_text.h"

namespace lightwalk {
namespace {

constexpr std::string_view kBlank = " \t\r\n\f\v";
constexpr double kLargest = 1e30;  ///< no value of a BSDF is larger [1/sr]

/// A matrix has some 80,000 numbers; a search for characters of a list calls a function for each
/// character.
bool parts_numbers(char c) {
    return c == ' ' || c == ',' || (c >= '\t' && c <= '\r');
}
bool ends_number(char c) {
    return parts_numbers(c) || c == '{' || c == '}';
}

bool is_text(const pugi::xml_node& node) {
    return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

}  // namespace

XmlText::XmlText(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {
    // Nothing is replaced in texts, so that their offsets are those of the file.
    const pugi::xml_parse_result result =
        document_.load_buffer(bytes.data(), bytes.size(), pugi::parse_cdata, pugi::encoding_utf8);
    if (!result) throw error(result.offset, std::string("bad XML: ") + result.description());
}

std::int32_t XmlText::line(std::ptrdiff_t offset) const {
    const auto end = bytes_.begin() + std::clamp<std::ptrdiff_t>(
                                          offset, 0, static_cast<std::ptrdiff_t>(bytes_.size()));
    return static_cast<std::int32_t>(1 + std::count(bytes_.begin(), end, '\n'));
}

InputError XmlText::error(std::ptrdiff_t offset, const std::string& problem) const {
    return InputError({name_, line(offset)}, problem);
}

std::string_view trimmed_text(const pugi::xml_node& element) {
    std::string_view text = element.text().get();
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

bool same_word(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) ==
               std::tolower(static_cast<unsigned char>(y));
    });
}

XmlNumbers::XmlNumbers(const XmlText& document, const pugi::xml_node& element)
    : document_(document), element_(element), at_(element.offset_debug()) {
    for (piece_ = element.first_child(); piece_ && !is_text(piece_); piece_ = piece_.next_sibling())
        ;
    begin_piece();
}

void XmlNumbers::begin_piece() {
    text_ = piece_ ? std::string_view(piece_.value()) : std::string_view();
    text_at_ = piece_.offset_debug();
    rest_ = text_;
}

/// Texts with a comment between them are several pieces.
void XmlNumbers::next_piece() {
    do {
        piece_ = piece_.next_sibling();
    } while (piece_ && !is_text(piece_));
    begin_piece();
}

XmlNumbers::Token XmlNumbers::next() {
    while (piece_) {
        const auto token = std::ranges::find_if_not(rest_, parts_numbers);
        rest_.remove_prefix(static_cast<std::size_t>(token - rest_.begin()));
        if (!rest_.empty()) break;
        next_piece();
    }
    if (!piece_) return last_ = Token::end;
    at_ = text_at_ + (rest_.data() - text_.data());
    if (rest_[0] != '{' && rest_[0] != '}') return last_ = read_number();
    last_ = rest_[0] == '{' ? Token::open : Token::close;
    rest_.remove_prefix(1);
    return last_;
}

XmlNumbers::Token XmlNumbers::read_number() {
    const std::size_t simple = parse_simple_real(rest_, value_);
    if (simple > 0 && (simple == rest_.size() || ends_number(rest_[simple])) &&
        std::abs(value_) <= kLargest) {
        rest_.remove_prefix(simple);
        return Token::number;
    }
    return read_any_number();
}

XmlNumbers::Token XmlNumbers::read_any_number() {
    const auto end = std::ranges::find_if(rest_, ends_number);
    const std::string_view word = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    if (!parse_real(word, value_))
        throw error("found \"" + std::string(word.substr(0, 40)) + "\", expected a number");
    if (!(std::abs(value_) <= kLargest))
        throw error("the number " + std::string(word.substr(0, 40)) + " is out of range");
    rest_.remove_prefix(word.size());
    return Token::number;
}

InputError XmlNumbers::error(const std::string& problem) const {
    return document_.error(at_, problem);
}

std::size_t XmlNumbers::most_left() const {
    std::size_t bytes = rest_.size();
    for (pugi::xml_node other = piece_.next_sibling(); other; other = other.next_sibling())
        bytes += is_text(other) ? std::strlen(other.value()) : 0;
    return bytes / 2 + 1;
}

}  // namespace lightwalk
