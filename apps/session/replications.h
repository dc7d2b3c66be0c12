#pragma once
// Renderers that answer the same questions independently of each other, so that the spread of their
// answers tells how well the mean is known.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/session/compiled_scene.h"
#include "apps/session/lightwalk/renderer.h"

namespace lightwalk {

/// Of answer `replication`, from 0 on: random numbers of its own, made of options.light.seed.
/// Warnings are those of the first one's alone, as all find the same.
/// Throws InputError where an ambient file would give all of them the same values.
[[nodiscard]] RendererOptions replication_options(RendererOptions options, int replication);

/// `count` renderers of a scene. What is made by chance for a scene's light (the cache of indirect
/// light, which lights are tested first, where mirrors show lights) each makes by itself; they
/// share what is read and compiled.
/// @param count  at least 1
[[nodiscard]] std::vector<Renderer> open_replications(
    const std::shared_ptr<const CompiledScene>& scene, const RendererOptions& options, int count);

/// The answers of each renderer to the same rays, as RayTask has them; nothing: stopped.
[[nodiscard]] std::optional<std::vector<RayBytes>> answer_by_all(std::span<Renderer> renderers,
                                                                 const RayTask& rays);

}  // namespace lightwalk
