#pragma once
// Compiled expressions of Radiance's function language: evaluation without name look-ups,
// allocation or locks.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/function/noise.h"

namespace lightwalk {

/// Inputs of an evaluation. 1..27 are the language's $n; the rest are set by particular materials
/// only.
enum class Channel : std::uint8_t {
    Dx = 1,
    Dy,
    Dz,
    Nx,
    Ny,
    Nz,
    Px,
    Py,
    Pz,
    T,
    Rdot,
    S,
    Tx,
    Ty,
    Tz,
    Ix,
    Iy,
    Iz,
    Jx,
    Jy,
    Jz,
    Kx,
    Ky,
    Kz,
    Ts,
    Lu,
    Lv,
    NxP,
    NyP,
    NzP,
    RdotP,
    CrP,
    CgP,
    CbP,
    DxA,
    DyA,
    DzA,
};
inline constexpr std::size_t kChannelCount = 38;

using ChannelMask = std::uint64_t;
[[nodiscard]] constexpr ChannelMask channel_bit(Channel c) {
    return ChannelMask{1} << static_cast<unsigned>(c);
}

using ChannelValues = std::array<double, kChannelCount>;  ///< indexed by Channel; index 0 is unused

/// The language's numeric error flag (domain or range error), see the icalc and "Radiance function
/// files" notes.
enum class EvalError : std::uint8_t { none, domain, range };

/// One number for each of several simultaneous evaluations (SIMD lanes).
inline constexpr std::size_t kLanes = 8;
struct alignas(64) Lanes {
    std::array<double, kLanes> value{};
};
using LaneMask = std::uint32_t;  ///< bit k: lane k

/// Results of simultaneous evaluations.
struct LaneValues {
    Lanes lanes;
    LaneMask done = 0;  ///< lanes that have a result
    [[nodiscard]] bool has(std::size_t lane) const { return (done >> lane & 1) != 0; }
};

/// Caches and scratch of one evaluation at a time; one per thread, reused without allocation after
/// the first evaluations.
/// After Program::begin it belongs to that program until the next begin.
struct EvalState {
    const ChannelValues* channels = nullptr;
    EvalError error = EvalError::none;
    std::vector<double> values;       ///< cells of all frames
    std::vector<std::uint8_t> valid;  ///< cached cells that have been computed
    std::uint64_t warnings = 0;       ///< numeric errors met
    void clear_error() { error = EvalError::none; }

    struct Return {  ///< where the interpreter continues after a call
        std::uint32_t instruction = 0, frame = 0, cell = 0;
    };
    std::vector<Return> returns;
    struct PrismRays {             ///< cache of fprism_val
        std::vector<double> rays;  ///< direction and energy of each ray
        bool valid = false;        ///< whether they belong to this epoch
    };
    std::uint64_t operations =
        0;  ///< number of instructions executed by calls in this epoch, which is limited
    std::vector<Lanes> lanes;               ///< registers of simultaneous evaluations
    std::vector<std::uint32_t> lane_queue;  ///< rays that still have to be evaluated
    function::NoiseMemory noise;
    function::FractalMemory fractal;
    PrismRays prism;
};

/// What a primitive wants to evaluate: an expression in its file's context, or a function called by
/// name with the values given at evaluation time.
struct ExpressionRequest {
    std::string text;  ///< expression, or the function's name
    int parameters =
        -1;  ///< -1: expression; n >= 0: call of the named function with exactly n arguments
};

/// The expressions of one primitive, compiled for its real arguments. Immutable and shareable.
class Program {
  public:
    struct Code;
    Program() = default;
    explicit Program(std::shared_ptr<const Code> code) : code_(std::move(code)) {}

    [[nodiscard]] bool empty() const { return !code_; }
    /// Whether both share one compiled program.
    friend bool operator==(const Program&, const Program&) = default;
    [[nodiscard]] std::size_t outputs() const;
    /// Whether evaluate() and call() can throw.
    [[nodiscard]] bool can_throw() const;
    [[nodiscard]] ChannelMask channels()
        const;  ///< channels that any output may read: fill at least these

    /// Start an epoch: the evaluations for one ray, during which variables are cached. It ends with
    /// the next begin(); until then `channels` must stay alive and unchanged.
    void begin(EvalState& state, const ChannelValues& channels) const;

    /// Evaluate output k. Values that other outputs need, too, are cached for the epoch; the others
    /// are computed anew by each call. Numeric errors set state.error and follow the language's
    /// rules (value 0); they are sticky or cleared as the language says, so call
    /// state.clear_error() where the primitive clears. Throws InputError for what the language
    /// calls fatal (undefined name met, missing argument).
    [[nodiscard]] double evaluate(std::size_t output, EvalState& state) const;
    /// Evaluate output k with arguments, for a request with `parameters >= 0`; arguments.size()
    /// must equal that.
    [[nodiscard]] double call(std::size_t output, std::span<const double> arguments,
                              EvalState& state) const;

    /// Whether evaluate_lanes can succeed: the program needs neither noise, nor calls (recursion),
    /// nor more of the ray than its channels. Inputs (`parameters` > 0) have no lanes.
    [[nodiscard]] bool has_lanes() const;
    /// Output k for 1 to kLanes rays at once (SIMD), each in an epoch of its own. Lanes that take
    /// the same branches as the first one and meet no numeric error get the same values as from
    /// evaluate(), to the bit; others get none.
    [[nodiscard]] LaneValues evaluate_lanes(std::size_t output, std::span<const ChannelValues> rays,
                                            EvalState& state) const;
    /// Output k for any number of rays by evaluate_lanes(). Rays that meet a numeric error get
    /// nothing, and have to be evaluated one by one. values.size() == rays.size().
    void evaluate_all(std::size_t output, std::span<const ChannelValues> rays,
                      std::span<std::optional<double>> values, EvalState& state) const;

    /// The value of output k where it is a constant; else nothing.
    [[nodiscard]] const double* constant(std::size_t output) const;

  private:
    std::shared_ptr<const Code> code_;
};

}  // namespace lightwalk
