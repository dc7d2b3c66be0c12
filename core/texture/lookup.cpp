#include "core/texture/lookup.h"

#include "core/function/environment.h"
#include "core/texture/arguments.h"
#include "core/texture/interpolate.h"
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

/// Number of values that function `k` of a colour is called with: three; but one for the second and
/// third function where it has fewer than three parameters.
int called_with(const ModifierBuild& build, const std::string& file, const std::string& function,
                std::size_t k) {
    if (k == 0) return 3;
    const int known = build.functions.parameters(file, function);
    return known > 0 && known < 3 ? 1 : 3;
}

std::optional<std::array<double, 3>> call_functions(const FunctionBinding& binding,
                                                    const std::vector<int>& parameters,
                                                    const std::array<double, 3>& datum,
                                                    EvalState& state) {
    std::array<double, 3> result{};
    state.clear_error();
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        if (parameters[k] == 1) {
            result[k] = binding.call(k, std::span(&datum[k], 1), state);
        } else {
            result[k] = binding.call(k, datum, state);
        }
    }
    if (state.error != EvalError::none) return std::nullopt;
    return result;
}

std::vector<ExpressionRequest> function_requests(const Primitive& primitive, std::size_t first,
                                                 const std::vector<int>& parameters) {
    std::vector<ExpressionRequest> requests;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        requests.push_back({primitive.strings[first + k], parameters[k]});
    }
    return requests;
}

}  // namespace

FunctionBinding DataLookup::bind(const ModifierBuild& build, std::size_t first, std::size_t values,
                                 std::vector<std::shared_ptr<const DataArray>>& tables) {
    const Primitive& primitive = build.primitive;
    const std::size_t data = first + values;
    const std::size_t file = data + values;
    require_arguments(primitive, file + 2);
    for (std::size_t k = 0; k < values; ++k) {
        tables.push_back(
            load_for(primitive, [&] { return build.resources.data(primitive.strings[data + k]); }));
        if (tables[k]->axes.size() != tables[0]->axes.size()) {
            throw modifier_error(primitive, "dimension error: the data files differ in dimension");
        }
    }
    const std::size_t dimensions = tables[0]->axes.size();
    if (primitive.strings.size() < file + 1 + dimensions) {
        throw modifier_error(primitive, "too few string arguments: the data file has " +
                                            std::to_string(dimensions) + " dimensions");
    }
    load_functions(build, primitive.strings[file]);
    std::vector<int> parameters;
    for (std::size_t k = 0; k < values; ++k) {
        const bool color = values == 3 && primitive.type != PrimitiveType::texdata;
        parameters.push_back(
            values == 1 ? 1
            : color ? called_with(build, primitive.strings[file], primitive.strings[first + k], k)
                    : 3);
    }
    std::vector<ExpressionRequest> requests = function_requests(primitive, first, parameters);
    for (std::size_t d = 0; d < dimensions; ++d)
        requests.push_back({primitive.strings[file + 1 + d], -1});
    return FunctionBinding(build, file, std::move(requests), file + 1 + dimensions);
}

DataLookup::DataLookup(const ModifierBuild& build, std::size_t first, std::size_t values)
    : binding_(bind(build, first, values, tables_)) {
    const Primitive& primitive = build.primitive;
    const bool color = values == 3 && primitive.type != PrimitiveType::texdata;
    for (std::size_t k = 0; k < values; ++k) {
        parameters_.push_back(values == 1 ? 1
                              : color ? called_with(build, primitive.strings[first + 2 * values],
                                                    primitive.strings[first + k], k)
                                      : 3);
    }
}

std::optional<std::array<double, 3>> DataLookup::evaluate(const Ray& ray, TraceContext& context,
                                                          Order order,
                                                          bool test_each_coordinate) const {
    EvalState& state = binding_.begin(ray, context);
    const std::size_t values = parameters_.size();
    const std::size_t dimensions = tables_[0]->axes.size();
    std::array<double, kMaxDataDimensions> point{};
    for (std::size_t i = 0; i < dimensions; ++i) {
        const std::size_t d = order == Order::forward ? i : dimensions - 1 - i;
        point[d] = binding_.evaluate(values + d, state);
        if (test_each_coordinate && state.error != EvalError::none) return std::nullopt;
    }
    if (state.error != EvalError::none) return std::nullopt;
    std::array<double, 3> datum{};
    const std::span<const double> where(point.data(), dimensions);
    for (std::size_t k = 0; k < values; ++k) {
        datum[k] = k > 0 && tables_[k] == tables_[0] ? datum[0] : interpolate(*tables_[k], where);
    }
    return call_functions(binding_, parameters_, datum, state);
}

PictureLookup::PictureLookup(const ModifierBuild& build, std::size_t first, std::size_t values)
    : picture_(
          (require_arguments(build.primitive, first + values + 4),
           load_for(
               build.primitive,
               [&] { return build.resources.picture(build.primitive.strings[first + values]); }))),
      binding_([&] {
          const Primitive& primitive = build.primitive;
          const std::size_t file = first + values + 1;
          load_functions(build, primitive.strings[file]);
          std::vector<int> parameters;
          for (std::size_t k = 0; k < values; ++k) {
              parameters.push_back(values == 1 ? 3
                                               : called_with(build, primitive.strings[file],
                                                             primitive.strings[first + k], k));
          }
          std::vector<ExpressionRequest> requests = function_requests(primitive, first, parameters);
          requests.push_back({primitive.strings[file + 1], -1});
          requests.push_back({primitive.strings[file + 2], -1});
          parameters_ = std::move(parameters);
          return FunctionBinding(build, file, std::move(requests), file + 3);
      }()) {}

std::optional<std::array<double, 3>> PictureLookup::evaluate(const Ray& ray,
                                                             TraceContext& context) const {
    EvalState& state = binding_.begin(ray, context);
    const std::size_t values = parameters_.size();
    const double u = binding_.evaluate(values, state);
    const double v = binding_.evaluate(values + 1, state);
    if (state.error != EvalError::none) return std::nullopt;
    const Rgb c = interpolate(*picture_, u, v);
    const std::array<double, 3> datum{static_cast<double>(c.r), static_cast<double>(c.g),
                                      static_cast<double>(c.b)};
    return call_functions(binding_, parameters_, datum, state);
}

}  // namespace lightwalk
