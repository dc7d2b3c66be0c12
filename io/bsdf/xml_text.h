#pragma once
// XML documents whose errors name the line of the file.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace lightwalk {

/// A document, and the bytes that it was read from.
class XmlText {
  public:
    /// Throws InputError `name:line: ...` for bytes that are no well-formed XML. Entities are not
    /// replaced.
    /// @param bytes  must outlive this
    XmlText(std::string_view bytes, const std::string& name);

    [[nodiscard]] pugi::xml_node root() const { return document_.document_element(); }
    /// The line of a byte, from 1.
    [[nodiscard]] std::int32_t line(std::ptrdiff_t offset) const;
    [[nodiscard]] InputError error(std::ptrdiff_t offset, const std::string& problem) const;
    [[nodiscard]] InputError error(const pugi::xml_node& at, const std::string& problem) const {
        return error(at.offset_debug(), problem);
    }

  private:
    std::string_view bytes_;
    FileName name_;
    pugi::xml_document document_;
};

/// An element's text without the white space around it.
[[nodiscard]] std::string_view trimmed_text(const pugi::xml_node& element);

/// Whether two words differ in the case of ASCII letters at most.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

/// Reads numbers and braces from an element's text. White space and commas part them.
class XmlNumbers {
  public:
    enum class Token { number, open, close, end };

    /// @param document, element  must outlive this
    XmlNumbers(const XmlText& document, const pugi::xml_node& element);

    /// Read the next token; a number is in value() then. Throws InputError for anything else.
    Token next();
    /// What next() returned last.
    [[nodiscard]] Token last() const { return last_; }
    [[nodiscard]] double value() const { return value_; }
    /// At the last token.
    [[nodiscard]] InputError error(const std::string& problem) const;
    /// An upper bound of the count of numbers that follow.
    [[nodiscard]] std::size_t most_left() const;

  private:
    void next_piece();
    void begin_piece();
    Token read_number();
    Token read_any_number();

    const XmlText& document_;
    pugi::xml_node element_, piece_;
    std::string_view text_, rest_;  ///< of the piece, and what is left of it
    std::ptrdiff_t text_at_ = 0;    ///< offset of the piece in the file
    std::ptrdiff_t at_ = 0;         ///< offset of the last token in the file
    Token last_ = Token::end;
    double value_ = 0;
};

}  // namespace lightwalk
