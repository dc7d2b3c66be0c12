#pragma once
// Manual pages, for man(1), from the same tables and texts as --help.
#include <string>

#include "io/options/option_rows.h"

namespace lightwalk {

/// What a manual page says beside its options.
struct ManualText {
    std::string name;      ///< of the page: "lightwalk-render"
    std::string call;      ///< what is typed: "lightwalk render"
    std::string operands;  ///< behind it: "OPTIONS SCENE..."
    std::string summary;   ///< one line, without a full stop
    std::string
        about;  ///< paragraphs between empty lines; indented lines stand as they are written
    std::string example;   ///< likewise; may be empty
    std::string see_also;  ///< "lightwalk(1)"; may be empty
};

/// A manual page of section 1, in the macros of man(7). All rows that are offered are explained.
/// @param options  null: it has none
/// @param version  of the program, in the page's foot
[[nodiscard]] std::string manual_page(const ManualText& text, const OptionTable* options,
                                      const std::string& version);

}  // namespace lightwalk
