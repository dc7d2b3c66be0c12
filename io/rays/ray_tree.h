#pragma once
// Trees of rays as rtrace prints them: the letters t and T of -o.
#include <string>
#include <string_view>
#include <vector>

#include "core/transport/tracer.h"
#include "io/rays/ray_records.h"

namespace lightwalk {

/// The letters of -o in their two parts.
struct OutputFields {
    std::string record;       ///< for each ray that was asked for
    std::string tree;         ///< for each ray that it needed; "" for no trees
    bool unshadowed = false;  ///< T: also rays that reach a light source unhindered
    [[nodiscard]] bool has_tree() const { return !tree.empty(); }
};
/// Fields before the first t or T are the record's, those after the last one the tree's; the last
/// letter of all is not looked at when it is t or T.
[[nodiscard]] OutputFields parse_output_fields(std::string_view letters);

/// Which rays of a tree are told, by the modifier of the surface that they meet (-te -ti -tE -tI).
struct TreeSelection {
    enum class Kind { all, include, exclude };
    Kind kind = Kind::all;
    std::vector<std::string> modifiers;

    /// Add names; names of the other kind are forgotten.
    void add(Kind kind_of_names, const std::vector<std::string>& names);
    /// Rays that meet nothing (null) are only told without an include list.
    [[nodiscard]] bool takes(const std::string* modifier) const;
};

/// Writes down the rays that one context traces, children before their parents: a line a ray,
/// behind a tab for each of its ancestors. Source: Radiance manual page rtrace(1).
/// Two kinds of shadow rays are left out. Those that an opaque surface stops, since Lightwalk asks
/// for the surface without tracing a ray. And, unless fields.unshadowed, those that meet nothing
/// but their source, with the reflections in mirrors that lead to it.
class RayTree final : public RayObserver {
  public:
    /// `sensor`: the primary ray is an irradiance at a point (rtrace -I), which is no ray to tell.
    /// Throws UsageError for unknown letters and for colours in four bytes.
    RayTree(const OutputFields& fields, NumberFormat format, ColorOutput color,
            TreeSelection selection, bool sensor);

    /// Whether V or W are asked for.
    [[nodiscard]] bool asks_for_coefficients() const { return records_.asks_for_coefficients(); }
    /// The end of the header of an output with trees, as RayRecords::header_end.
    [[nodiscard]] std::string header_end(std::size_t bytes_before) const {
        return records_.header_end(bytes_before, false);
    }

    /// Whose surfaces and lights the rays meet; they must live as long as rays are told.
    void watch(const Tracer& tracer) { tracer_ = &tracer; }
    void finished(const Ray& ray, const Hit& first) override;
    /// What the tree of the ray says that has been traced last; begins the next one.
    [[nodiscard]] std::string take();

  private:
    struct Line {
        std::size_t begin = 0;      ///< in text_
        int level = 0;              ///< how many ancestors the ray has
        bool meets_source = false;  ///< the one that it was sent to
    };
    [[nodiscard]] bool is_selected(const Ray& ray) const;
    [[nodiscard]] bool meets_source(const Ray& ray) const;
    void forget_unhindered(int level);

    RayRecords records_;
    TreeSelection selection_;
    bool unshadowed_, sensor_;
    const Tracer* tracer_ = nullptr;
    std::vector<Line> lines_;  ///< of the present tree, also of rays that are not told
    std::string text_;
};

}  // namespace lightwalk
