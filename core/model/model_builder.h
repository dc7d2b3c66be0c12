#pragma once
// The name space of a scene while it is read: definitions, and what names mean at each point of the
// file.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/model/primitive.h"

namespace lightwalk {

/// Collects primitives in order of definition and resolves the names they use, as Radiance does:
/// a name means the latest definition so far; a later one changes nothing that was read before.
/// Surfaces have no entry in the name space. Source: "The Radiance 6.x Scene Description Language"
/// (ray.pdf).
class ModelBuilder {
  public:
    ModelBuilder() = default;
    /// Goes on where a model ends: later primitives find its modifiers by their names, and may
    /// define them anew for those behind them. Its cube may not hold all of them.
    /// @param model  one whose surfaces are in the process's own memory
    explicit ModelBuilder(std::shared_ptr<Model> model);

    /// What `name` means as a modifier: an index, or kVoidIndex for `void`. Throws InputError
    /// "undefined modifier ..., did you mean ..." for a name that nothing has defined.
    [[nodiscard]] std::int32_t modifier(const std::string& name, const SourceLocation& where) const;

    /// Whether something has defined a modifier of this name.
    [[nodiscard]] bool is_defined(const std::string& name) const { return names_.contains(name); }

    /// Add a primitive whose `modifier` is an index into this model's modifiers (or void) and whose
    /// `references` are still empty; returns its index among the modifiers or the surfaces. Throws
    /// InputError for an illegal name, and for a modifier that is none. A modifier that equals the
    /// current one of its name is added, but the name keeps its older meaning. An alias goes
    /// through add_alias.
    std::int32_t add(Primitive primitive);
    /// Add a surface whose `modifier` is an index into this model's modifiers (or void); returns
    /// its index. Throws InputError for a modifier that is none.
    std::int32_t add(const SurfacePrimitive& surface);

    /// Add `modifier alias name`, standing for the modifier with index `target`: its type and
    /// arguments with `modifier` in place of its own modifier; returns its index. The alias is a
    /// modifier of its own, and is what messages and rtrace call a surface's modifier. Its
    /// reference is never itself an alias.
    std::int32_t add_alias(std::int32_t modifier, const std::string& name, std::int32_t target,
                           const SourceLocation& where);

    /// Add `inherit alias name`: all of the modifier with index `target` under another name.
    std::int32_t rename(const std::string& name, std::int32_t target, const SourceLocation& where);

    /// The modifier an alias names, latest definition; throws InputError "bad reference ..." when
    /// there is none.
    [[nodiscard]] std::int32_t alias_target(const std::string& name,
                                            const SourceLocation& where) const;

    /// Note what has written a sky.
    void add_sky(GeneratedPart part) { model_->skies.push_back(std::move(part)); }

    [[nodiscard]] const Model& model() const { return *model_; }

    /// Hand over the model; the builder is empty afterwards.
    [[nodiscard]] std::shared_ptr<Model> release();

  private:
    [[nodiscard]] std::int32_t reference(const std::string& name) const;
    [[nodiscard]] std::vector<std::int32_t> references(const Primitive& primitive) const;
    [[nodiscard]] bool equal(std::int32_t a, std::int32_t b) const;
    void enter_name(std::int32_t index);
    void check_modifier(std::int32_t modifier, const SourceLocation& where) const;
    [[nodiscard]] std::string suggestion(std::string_view name) const;

    std::shared_ptr<Model> model_ = std::make_shared<Model>();
    std::unordered_map<std::string, std::int32_t> names_;
};

/// A copy in the process's own memory, which a builder can go on with.
[[nodiscard]] std::shared_ptr<Model> growable_copy(const Model& model);

/// ", did you mean "X"?" for the nearest of `known`, or "" when nothing is near.
[[nodiscard]] std::string did_you_mean(std::string_view name,
                                       const std::vector<std::string_view>& known);

}  // namespace lightwalk
