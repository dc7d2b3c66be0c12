#pragma once
// Lookups of patterns, textures and mixtures in data tables and pictures.
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/model/resources.h"
#include "core/texture/function_binding.h"

namespace lightwalk {

inline constexpr std::size_t kMaxDataDimensions = 6;

/// A data file looked up at coordinates that are expressions: strings `func... data... file x1...
/// xform`. Holds `values` data tables (1, or 3 for colours and textures), each passed to its
/// function.
class DataLookup {
  public:
    /// @param first   index of the first function name in the string arguments
    /// @param values  number of functions and of data files: 1 or 3
    DataLookup(const ModifierBuild& build, std::size_t first, std::size_t values);

    enum class Order { forward, backward };
    /// Function results at the hit; nothing after a numeric error (the primitive is skipped).
    /// `own_datum_only`: functions of fewer than three parameters see their own datum (colordata).
    [[nodiscard]] std::optional<std::array<double, 3>> evaluate(const Ray& ray,
                                                                TraceContext& context, Order order,
                                                                bool test_each_coordinate) const;
    [[nodiscard]] const FunctionBinding& binding() const { return binding_; }

  private:
    static FunctionBinding bind(const ModifierBuild& build, std::size_t first, std::size_t values,
                                std::vector<std::shared_ptr<const DataArray>>& tables);
    std::vector<std::shared_ptr<const DataArray>> tables_;  ///< one a value; equal names share
    FunctionBinding binding_;      ///< outputs: the functions, then the coordinates
    std::vector<int> parameters_;  ///< how many values each function is called with
};

/// A picture looked up at (u, v): strings `func... picture file u v xform`.
class PictureLookup {
  public:
    PictureLookup(const ModifierBuild& build, std::size_t first, std::size_t values);
    [[nodiscard]] std::optional<std::array<double, 3>> evaluate(const Ray& ray,
                                                                TraceContext& context) const;

  private:
    std::shared_ptr<const PictureData> picture_;
    std::vector<int> parameters_;  ///< filled while binding_ is made
    FunctionBinding binding_;
};

}  // namespace lightwalk
