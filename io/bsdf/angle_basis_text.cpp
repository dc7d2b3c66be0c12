#include "io/bsdf/angle_basis_text.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMostOwnBases = 4;
constexpr double kAngleTolerance = 0.01;  // [degrees]

double number_of(const XmlText& document, const pugi::xml_node& element, const char* what,
                 const pugi::xml_node& parent) {
    double value = 0;
    if (!element) throw document.error(parent, std::string("AngleBasisBlock without ") + what);
    if (!parse_real(trimmed_text(element), value) || !std::isfinite(value))
        throw document.error(element, std::string(what) + " is no number");
    return value;
}

/// @param before  the largest angle of the ring before; 0 for the first
AngleRing read_ring(const XmlText& document, const pugi::xml_node& block, double before) {
    const pugi::xml_node bounds = block.child("ThetaBounds");
    const double upper = number_of(document, bounds.child("UpperTheta"), "UpperTheta", block);
    if (const pugi::xml_node lower = bounds.child("LowerTheta")) {
        const double from = number_of(document, lower, "LowerTheta", block);
        if (std::abs(from - before) > kAngleTolerance)
            throw document.error(lower, "LowerTheta is not the UpperTheta of the ring before");
    }
    if (!(upper > before + kAngleTolerance) || upper > 90 + kAngleTolerance)
        throw document.error(block, "the angles of an AngleBasis do not rise to 90 degrees");
    const double sectors = number_of(document, block.child("nPhis"), "nPhis", block);
    if (!(sectors >= 1) || sectors > double{AngleBasis::kMostSectors} ||
        sectors != std::floor(sectors) || (sectors == 1 && before > 0))
        throw document.error(block, "bad nPhis in an AngleBasis");
    return {upper, static_cast<std::size_t>(sectors)};
}

AngleBasis read_basis(const XmlText& document, const pugi::xml_node& element) {
    std::vector<AngleRing> rings;
    for (const pugi::xml_node block : element.children("AngleBasisBlock")) {
        if (rings.size() == AngleBasis::kMostRings)
            throw document.error(block, "an AngleBasis has too many rings");
        rings.push_back(read_ring(document, block, rings.empty() ? 0 : rings.back().upper));
    }
    if (rings.empty() || std::abs(rings.back().upper - 90) > kAngleTolerance)
        throw document.error(element, "the rings of an AngleBasis do not reach 90 degrees");
    rings.back().upper = 90;
    return AngleBasis(std::move(rings));
}

}  // namespace

NamedBases::NamedBases(const XmlText& document, const pugi::xml_node& definition) {
    for (const std::string name : {"LBNL/Klems Full", "LBNL/Klems Half", "LBNL/Klems Quarter"})
        own_.emplace(name, *klems_basis(name));
    const std::size_t known = own_.size();
    for (const pugi::xml_node element : definition.children("AngleBasis")) {
        const std::string name(trimmed_text(element.child("AngleBasisName")));
        if (name.empty()) throw document.error(element, "AngleBasis without AngleBasisName");
        if (klems_basis(name)) continue;
        if (own_.size() == known + kMostOwnBases)
            throw document.error(element, "too many bases, expected at most 4");
        own_.insert_or_assign(name, read_basis(document, element));
    }
}

const AngleBasis& NamedBases::find(const XmlText& document, const pugi::xml_node& element) const {
    const auto found = own_.find(trimmed_text(element));
    if (found != own_.end()) return found->second;
    throw document.error(element, "undefined angle basis \"" +
                                      std::string(trimmed_text(element).substr(0, 60)) + "\"");
}

}  // namespace lightwalk
