#pragma once
// Evaluates an expression in the context of a function file.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/function/environment.h"
#include "core/function/program.h"

namespace lightwalk::test {

struct Setting {
    std::string_view definitions;  ///< text of the function file tt.cal
    std::vector<double> reals;
    ChannelMask material_channels = 0;
    ChannelValues channels{};
};

inline void set(ChannelValues& channels, Channel c, double value) {
    channels[static_cast<std::size_t>(c)] = value;
}

/// A ray that hits the plane z = 0 at the origin from straight above.
inline ChannelValues straight_down() {
    ChannelValues channels{};
    set(channels, Channel::Dz, -1);
    set(channels, Channel::Nz, 1);
    set(channels, Channel::Rdot, 1);
    set(channels, Channel::S, 1);
    return channels;
}

struct Evaluated {
    double value = 0;
    EvalError error = EvalError::none;
};

/// The values of several expressions, evaluated in the given order in one epoch.
inline std::vector<Evaluated> evaluate_all(const std::vector<std::string>& expressions,
                                           const Setting& in) {
    FunctionEnvironment environment;
    environment.load("tt.cal", in.definitions);
    std::vector<ExpressionRequest> requests;
    requests.reserve(expressions.size());
    for (const std::string& e : expressions) requests.push_back({e, -1});
    const Program program =
        environment.compile("tt.cal", requests, in.reals, in.material_channels, {"scene.rad", 7});
    EvalState state;
    program.begin(state, in.channels);
    std::vector<Evaluated> results;
    for (std::size_t k = 0; k < expressions.size(); ++k) {
        const double value = program.evaluate(k, state);
        results.push_back({value, state.error});
    }
    return results;
}

inline Evaluated evaluate(const std::string& expression, const Setting& in) {
    return evaluate_all({expression}, in).front();
}

/// The value of an expression that does not depend on a ray.
inline double value_of(const std::string& expression, std::string_view definitions = "") {
    return evaluate(expression, {definitions, {}, 0, straight_down()}).value;
}

/// The error message for an expression or its definitions; "" when there is none.
inline std::string complaint(const std::string& expression, std::string_view definitions = "") {
    try {
        (void)evaluate(expression, {definitions, {}, 0, straight_down()});
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

}  // namespace lightwalk::test
