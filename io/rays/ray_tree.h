#pragma once
// Ray trees in rtrace's output format, which the letters t and T of -o ask for.
#include <string>
#include <string_view>
#include <vector>

#include "core/trace/tracer.h"
#include "io/rays/ray_records.h"

namespace lightwalk {

/// The letters of -o, divided into fields of the records and of the trees.
struct OutputFields {
    std::string record;       ///< fields of each ray of the input
    std::string tree;         ///< fields of each ray that was traced for it; "" for no trees
    bool unshadowed = false;  ///< T: trees include shadow rays that reach their light source
    [[nodiscard]] bool has_tree() const { return !tree.empty(); }
};
/// Fields before the first t or T are those of the record, fields after the last one those of the
/// tree; a t or T as the very last letter is ignored.
[[nodiscard]] OutputFields parse_output_fields(std::string_view letters);

/// Which rays of a tree are written, by the modifier of the surface that they hit (-te -ti -tE
/// -tI).
struct TreeSelection {
    enum class Kind { all, include, exclude };
    Kind kind = Kind::all;
    std::vector<std::string> modifiers;

    /// Add names to the list of a kind; names of the other kind are removed.
    void add(Kind kind_of_names, const std::vector<std::string>& names);
    /// Whether a ray is written; `modifier` is null for a ray that hits nothing, which an include
    /// list leaves out.
    [[nodiscard]] bool takes(const std::string* modifier) const;
};

/// Records the rays that one context traces as text, children before their parents: a line for each
/// ray, with a tab for each of its ancestors. Source: Radiance manual page rtrace(1).
/// Two kinds of shadow rays are left out: those that an opaque surface stops, as Lightwalk tests
/// for occlusion without tracing a ray; and, unless fields.unshadowed, those that reach their
/// source, with the reflections in mirrors that lead to it.
class RayTree final : public RayObserver {
  public:
    /// `sensor`: the primary ray is an irradiance at a point (rtrace -I), which is not written as a
    /// ray. Throws UsageError for unknown letters and for the format rgbe.
    RayTree(const OutputFields& fields, NumberFormat format, ColorOutput color,
            TreeSelection selection, bool sensor);

    /// Whether V or W are among the fields.
    [[nodiscard]] bool asks_for_coefficients() const { return records_.asks_for_coefficients(); }
    /// The last lines of the header of an output with trees; see RayRecords::header_end.
    [[nodiscard]] std::string header_end(std::size_t bytes_before) const {
        return records_.header_end(bytes_before, false);
    }

    /// Set the tracer, whose surfaces and lights the rays hit; it must live as long as rays are
    /// recorded.
    void watch(const Tracer& tracer) { tracer_ = &tracer; }
    void finished(const Ray& ray, const Hit& first) override;
    /// Removes and returns the text of the tree recorded so far; the next ray begins a new tree.
    [[nodiscard]] std::string take();

  private:
    struct Line {
        std::size_t begin = 0;      ///< offset of the line in text_
        int level = 0;              ///< number of the ray's ancestors
        bool meets_source = false;  ///< the ray reaches the light source that it was sent to
    };
    [[nodiscard]] bool is_selected(const Ray& ray) const;
    [[nodiscard]] bool meets_source(const Ray& ray) const;
    void forget_unhindered(int level);

    RayRecords records_;
    TreeSelection selection_;
    bool unshadowed_, sensor_;
    const Tracer* tracer_ = nullptr;
    std::vector<Line> lines_;  ///< the rays of the present tree, also those that are not written
    std::string text_;
};

}  // namespace lightwalk
