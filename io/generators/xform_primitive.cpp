#include "io/generators/xform_primitive.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lightwalk {
namespace {

constexpr int kMediumDigits =
    6;  ///< Radiance writes dielectric, interface and mist with fewer digits

class PrimitiveTransformer {
  public:
    PrimitiveTransformer(const PrimitiveText& original, const XformStep& step)
        : p_(original), step_(step) {}

    void write(std::string& out) {
        if (is_surface(p_.type)) {
            name_surface();
            transform_surface();
        } else {
            transform_modifier();
        }
        try {
            write_primitive(p_, digits_, out);
        } catch (const InputError& error) {
            throw InputError(p_.where, describe() + ": " + error.what());
        }
    }

  private:
    [[nodiscard]] std::string describe() const {
        return std::string(to_string(p_.type)) + " \"" + p_.name + "\"";
    }

    void need(bool condition) const {
        if (!condition)
            throw InputError(p_.where, "bad " + describe() + ": wrong number of arguments");
    }

    void need_reals(std::size_t count) const { need(p_.reals.size() == count); }

    [[nodiscard]] Vec3 triple(std::size_t at) const {
        return {p_.reals[at], p_.reals[at + 1], p_.reals[at + 2]};
    }

    void set_triple(std::size_t at, const Vec3& v) {
        p_.reals[at] = v.x;
        p_.reals[at + 1] = v.y;
        p_.reals[at + 2] = v.z;
    }

    void move_point(std::size_t at) { set_triple(at, step_.transform.forward.point(triple(at))); }
    void move_vector(std::size_t at) { set_triple(at, step_.transform.forward.vector(triple(at))); }
    void scale(std::size_t at) { p_.reals[at] *= step_.transform.size(); }

    void set_type(PrimitiveType type) {
        p_.type = type;
        p_.type_word = to_string(type);
    }

    /// Under inversion the first type becomes the second, and the other way round.
    void swap_types(PrimitiveType a, PrimitiveType b) {
        if (step_.invert) set_type(p_.type == a ? b : a);
    }

    void name_surface() {
        if (!step_.prefix.empty()) p_.name = step_.prefix + "." + p_.name;
        if (!step_.surface_modifier.empty()) p_.modifier = step_.surface_modifier;
    }

    void append_words() {
        if (step_.words.empty()) return;
        if (step_.words[0] != "-i") {
            p_.strings.emplace_back("-i");
            p_.strings.emplace_back("1");
        }
        p_.strings.insert(p_.strings.end(), step_.words.begin(), step_.words.end());
    }

    void transform_polygon() {
        need(p_.reals.size() >= 9 && p_.reals.size() % 3 == 0);
        const std::size_t vertices = p_.reals.size() / 3;
        for (std::size_t i = 0; i < vertices; ++i) move_point(3 * i);
        const bool mirrored = step_.transform.scale < 0;
        if (mirrored == step_.invert) return;
        for (std::size_t low = 0, high = vertices - 1; low < high; ++low, --high) {
            std::swap_ranges(p_.reals.begin() + static_cast<std::ptrdiff_t>(3 * low),
                             p_.reals.begin() + static_cast<std::ptrdiff_t>(3 * low + 3),
                             p_.reals.begin() + static_cast<std::ptrdiff_t>(3 * high));
        }
    }

    void transform_axis(std::size_t radii) {
        need_reals(6 + radii);
        move_point(0);
        move_point(3);
        for (std::size_t i = 0; i < radii; ++i) scale(6 + i);
    }

    void transform_ring() {
        need_reals(8);
        move_point(0);
        move_vector(3);
        if (step_.invert) set_triple(3, -triple(3));
        scale(6);
        scale(7);
    }

    void transform_surface() {
        switch (p_.type) {
            case PrimitiveType::source:
                need_reals(4);
                move_vector(0);
                break;
            case PrimitiveType::sphere:
            case PrimitiveType::bubble:
                need_reals(4);
                move_point(0);
                scale(3);
                swap_types(PrimitiveType::sphere, PrimitiveType::bubble);
                break;
            case PrimitiveType::polygon:
                transform_polygon();
                break;
            case PrimitiveType::cone:
            case PrimitiveType::cup:
                transform_axis(2);
                swap_types(PrimitiveType::cone, PrimitiveType::cup);
                break;
            case PrimitiveType::cylinder:
            case PrimitiveType::tube:
                transform_axis(1);
                swap_types(PrimitiveType::cylinder, PrimitiveType::tube);
                break;
            case PrimitiveType::ring:
                transform_ring();
                break;
            default:  // instance, mesh
                need(!p_.strings.empty());
                append_words();
        }
    }

    /// Transmission over a unit length: c for one unit is c^(1/s) for one of the new, s times as
    /// many.
    void scale_transmission(std::size_t at) {
        for (std::size_t i = at; i < at + 3; ++i) {
            p_.reals[i] = std::pow(p_.reals[i], 1 / step_.transform.size());
        }
    }

    void transform_mist() {
        digits_ = kMediumDigits;
        for (std::size_t i = 0; i < 3 && p_.reals.size() >= 3; ++i) {
            p_.reals[i] /= step_.transform.size();
        }
        if (step_.prefix.empty()) return;
        for (std::string& path : p_.strings) path = prefixed_path(path);
    }

    /// "surface>source" names surfaces, and they are renamed.
    [[nodiscard]] std::string prefixed_path(const std::string& path) const {
        std::string result = step_.prefix + ".";
        for (const char c : path) {
            result.push_back(c);
            if (c == '>') result += step_.prefix + ".";
        }
        return result;
    }

    void transform_text() {
        need(p_.reals.size() >= 9);
        move_point(0);
        move_vector(3);
        move_vector(6);
    }

    void transform_modifier() {
        switch (p_.type) {
            case PrimitiveType::glow:
                need_reals(4);
                scale(3);
                break;
            case PrimitiveType::spotlight:
                need_reals(7);
                move_vector(4);
                break;
            case PrimitiveType::dielectric:
                need_reals(5);
                digits_ = kMediumDigits;
                scale_transmission(0);
                break;
            case PrimitiveType::interface:
                need_reals(8);
                digits_ = kMediumDigits;
                scale_transmission(0);
                scale_transmission(4);
                break;
            case PrimitiveType::mist:
                transform_mist();
                break;
            case PrimitiveType::brighttext:
            case PrimitiveType::colortext:
            case PrimitiveType::mixtext:
                transform_text();
                break;
            case PrimitiveType::light:
            case PrimitiveType::illum:
            case PrimitiveType::mirror:
            case PrimitiveType::plastic:
            case PrimitiveType::metal:
            case PrimitiveType::trans:
            case PrimitiveType::glass:
            case PrimitiveType::antimatter:
            case PrimitiveType::spectrum:
            case PrimitiveType::specfile:
            case PrimitiveType::alias:
                break;
            default:
                append_words();  // all others name a function file
        }
    }

    PrimitiveText p_;
    const XformStep& step_;
    int digits_ = kFullDigits;
};

}  // namespace

void write_transformed(const PrimitiveText& primitive, const XformStep& step, std::string& out) {
    PrimitiveTransformer(primitive, step).write(out);
}

}  // namespace lightwalk
