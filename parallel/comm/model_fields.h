#pragma once
// The fields of a change of a model on the wire (see wire.h).
#include "core/model/model_change.h"
#include "parallel/comm/wire.h"

namespace lightwalk {

// The alias is the last one.
template <>
inline constexpr int wire::kEnumerators<PrimitiveType> = static_cast<int>(PrimitiveType::alias) + 1;

template <class Wire>
void visit_fields(Wire& wire, SourceLocation& where) {
    std::string file = where.file.text();
    wire(file, where.line);
    if constexpr (Wire::kReads) where.file = FileName(std::move(file));
}
template <class Wire>
void visit_fields(Wire& wire, Primitive& p) {
    wire(p.type, p.modifier, p.name, p.strings, p.reals, p.references, p.where);
}
template <class Wire>
void visit_fields(Wire& wire, PlacedSource& placed) {
    wire(placed.before, placed.source);
}
/// Whoever reads one has to check_sound() it.
template <class Wire>
void visit_fields(Wire& wire, ModelChange& change) {
    wire(change.modifiers, change.sources);
}

}  // namespace lightwalk
