#pragma once
// Evaluates the variables of a function file at a point of a ray.
#include <doctest/doctest.h>

#include <span>
#include <string>
#include <vector>

#include "core/function/environment.h"
#include "core/math/vec3.h"
#include "io/files/library_path.h"

namespace lightwalk::test {

/// The values of a ray that a function file can read.
struct RayValues {
    Vec3 direction{0, 0, 1};
    Vec3 normal{0, 0, 1};
    Vec3 position{};
    double distance = 0;  ///< distance of the shadow ray's target, Ts
};

class LibraryFile {
  public:
    explicit LibraryFile(const std::string& path) {
        environment_.load("file.cal", read_file(path));
    }

    /// The values of `variables` for a primitive with these real arguments.
    [[nodiscard]] std::vector<double> values(std::span<const std::string> variables,
                                             std::span<const double> reals,
                                             const RayValues& ray) const {
        std::vector<ExpressionRequest> requests;
        for (const std::string& variable : variables) requests.push_back({variable, -1});
        const Program program =
            environment_.compile("file.cal", requests, reals, 0, {"test.rad", 1});
        ChannelValues channels{};
        const auto set = [&channels](Channel first, const Vec3& v) {
            for (std::size_t i = 0; i < 3; ++i)
                channels[static_cast<std::size_t>(first) + i] = v[i];
        };
        set(Channel::Dx, ray.direction);
        set(Channel::Nx, ray.normal);
        set(Channel::Px, ray.position);
        channels[static_cast<std::size_t>(Channel::Rdot)] = -dot(ray.direction, ray.normal);
        channels[static_cast<std::size_t>(Channel::Ts)] = ray.distance;
        EvalState state;
        program.begin(state, channels);
        std::vector<double> result;
        for (std::size_t i = 0; i < requests.size(); ++i) {
            result.push_back(program.evaluate(i, state));
            CHECK(state.error == EvalError::none);
        }
        return result;
    }

    [[nodiscard]] double value(const std::string& variable, std::span<const double> reals,
                               const RayValues& ray) const {
        return values({&variable, 1}, reals, ray)[0];
    }

  private:
    FunctionEnvironment environment_;
};

/// The library file of this name in io/library.
inline LibraryFile own_library_file(const std::string& name) {
    return LibraryFile(std::string(LIGHTWALK_SOURCE "/io/library/") + name);
}

}  // namespace lightwalk::test
