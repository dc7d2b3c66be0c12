#pragma once
// The fields of a change of a model on the wire (see wire.h).
#include "core/model/model_change.h"
#include "parallel/comm/wire.h"

namespace lightwalk {

template <>
inline constexpr int wire::kEnumerators<PrimitiveType> = 0
#define PRIMITIVE(id, word, kind) +1
#include "core/model/primitive_types.def"
    ;

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
