#pragma once
// Decodes XML files of BSDF data.
#include <string>
#include <string_view>

#include "core/bsdf/bsdf_data.h"

namespace lightwalk {

/// Decode an XML file as LBNL WINDOW, genBSDF and others write it: matrices over Klems' bases or
/// bases of the file's own, or tensor trees of rank 3 or 4, of the wavelengths Visible, CIE-X and
/// CIE-Z, CIE-u and CIE-v. Other wavelengths, and layers after the first, are skipped; a later
/// block replaces an earlier one of its kind. Throws InputError `name:line: ...` for damaged files,
/// and allocates no more than the size of the file justifies. Sources: WINDOW's XML schema
/// BSDF-v1.4.xsd; Radiance's genBSDF(1).
[[nodiscard]] BsdfData decode_bsdf(std::string_view bytes, const std::string& name);

}  // namespace lightwalk
