#include "core/cloud/shown_materials.h"

#include "core/cloud/material_bits.h"
#include "core/error.h"
#include "core/scene/seen_material.h"

namespace lightwalk {
namespace {

/// Surfaces that a way may cross behind the first one. Where light goes through more, which is
/// rare, its bits may be missed.
constexpr int kMostCrossed = 3;
constexpr int kMostAbsent = 2;  // before the first surface that is seen

/// A modifier that a way may meet.
struct MetModifier {
    ModifierId id;
    bool wanted;
    bool cells;  ///< its panes have data by direction, whose cell is met beside it
};

/// Bits of ways so far.
struct Ways {
    std::bitset<kMaterialBits + 1> with, without;  ///< a wanted one

    void add(const Ways& other) {
        with |= other.with;
        without |= other.without;
    }
    [[nodiscard]] Ways on(const std::vector<MetModifier>& next) const {
        Ways result;
        for (std::uint32_t bits = 0; bits <= kMaterialBits; ++bits) {
            if (!with[bits] && !without[bits]) continue;
            for (const MetModifier& one : next) result.meet(*this, bits, one);
        }
        return result;
    }

  private:
    void meet(const Ways& before, std::uint32_t bits, const MetModifier& one) {
        const std::uint32_t met = met_material(bits, one.id);
        const std::uint32_t beside = one.cells ? met_material(met, kVoid) : met;
        for (const std::uint32_t now : {met, beside}) {
            if (before.with[bits] || one.wanted) with.set(now);
            if (before.without[bits] && !one.wanted) without.set(now);
        }
    }
};

/// All that begin so and cross up to so many of these.
Ways crossing(Ways ways, const std::vector<MetModifier>& crossed, int most) {
    Ways last = ways;
    for (int i = 0; i < most; ++i) {
        last = last.on(crossed);
        ways.add(last);
    }
    return ways;
}

struct Met {
    std::vector<MetModifier> absent;   ///< surfaces that are not seen at all
    std::vector<MetModifier> crossed;  ///< those, panes and mirrors
    std::vector<MetModifier> panes;
    std::vector<MetModifier> reflecting;  ///< that have an image beside what is seen ahead
    std::vector<MetModifier> all;         ///< and the background
};

Met modifiers_met(const Scene& scene, const std::vector<bool>& wanted) {
    Met met;
    met.all.push_back({kVoid, false, false});
    for (std::size_t i = 0; i < scene.modifier_count(); ++i) {
        const ModifierId id{static_cast<std::int32_t>(i)};
        const ModifierRecord& record = scene.modifier(id);
        if (!record.node || !(is_material(record.type) || is_mixture(record.type))) continue;
        const SeenMaterial seen = seen_material(scene, id);
        const Appearance appearance = seen.traits.appearance;
        const bool cells = seen.material && scene.modifier(*seen.material).node &&
                           scene.modifier(*seen.material).node->bsdf() != nullptr;
        const MetModifier one{id, i < wanted.size() && wanted[i], cells};
        met.all.push_back(one);
        const bool mirror = appearance == Appearance::mirror, pane = appearance == Appearance::pane;
        if (appearance == Appearance::absent) met.absent.push_back(one);
        if (pane) met.panes.push_back(one);
        if (mirror || pane || appearance == Appearance::absent) met.crossed.push_back(one);
        if (mirror || pane || appearance == Appearance::polished) met.reflecting.push_back(one);
    }
    return met;
}

}  // namespace

ShownMaterials::ShownMaterials(const Scene& scene, const std::vector<bool>& wanted) {
    const Met met = modifiers_met(scene, wanted);
    Ways begun;
    begun.without.set(0);
    const Ways first = crossing(begun, met.absent, kMostAbsent);
    const auto bits = [&](PointKind kind) -> Bits& {
        return bits_[static_cast<std::size_t>(kind)];
    };
    const Bits plain = first.on(met.all).with;
    bits(PointKind::plain) = plain;
    bits(PointKind::glossy) = plain;
    bits(PointKind::through) =
        crossing(first.on(met.panes), met.crossed, kMostCrossed).on(met.all).with;
    const Ways reflected = first.on(met.reflecting);
    // An image in a surface that is not flat has the bits of that surface.
    bits(PointKind::mirrored) =
        crossing(reflected, met.crossed, kMostCrossed - 1).on(met.all).with | reflected.with;
}

ShownMaterials::ShownMaterials(std::span<const std::uint8_t> flags) {
    if (flags.size() != bits_.size() * bits_[0].size())
        throw InputError("materials are told in another way than here");
    std::size_t next = 0;
    for (Bits& bits : bits_)
        for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = flags[next++] != 0;
}

std::vector<std::uint8_t> ShownMaterials::flags() const {
    std::vector<std::uint8_t> flags;
    for (const Bits& bits : bits_)
        for (std::size_t i = 0; i < bits.size(); ++i) flags.push_back(bits[i] ? 1 : 0);
    return flags;
}

void drop_points(const ShownMaterials& materials, std::vector<CloudPoint>& points,
                 std::vector<Rgb>& groups) {
    const std::size_t count = points.empty() ? 0 : groups.size() / points.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (materials.may_show(points[i])) continue;
        points[kept] = points[i];
        for (std::size_t g = 0; g < count; ++g) groups[kept * count + g] = groups[i * count + g];
        ++kept;
    }
    points.resize(kept);
    groups.resize(kept * count);
}

}  // namespace lightwalk
