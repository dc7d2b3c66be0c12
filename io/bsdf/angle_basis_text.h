#pragma once
// Bases of matrices as XML files of BSDF data name and describe them.
#include <map>
#include <string>
#include <string_view>

#include "core/bsdf/angle_basis.h"
#include "io/bsdf/xml_text.h"

namespace lightwalk {

/// The bases that a file may use: those that it describes, and Klems', whose descriptions count for
/// nothing.
class NamedBases {
  public:
    /// @param definition  the element DataDefinition. Throws InputError for bad descriptions.
    NamedBases(const XmlText& document, const pugi::xml_node& definition);
    /// The basis that an element names; throws InputError where there is none of this name.
    [[nodiscard]] const AngleBasis& find(const XmlText& document,
                                         const pugi::xml_node& element) const;

  private:
    std::map<std::string, AngleBasis, std::less<>> own_;
};

}  // namespace lightwalk
