#pragma once
// Rays of a hemisphere that are denser where light comes in.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ambient/hemisphere.h"
#include "core/transport/light_transport.h"

namespace lightwalk {

/// What the rays of a hemisphere have found.
struct Surroundings {
    Rgb sum;            ///< of what they bring, times the coefficient [W/(m² sr)]
    int succeeded = 0;  ///< rays
};

/// Samples n x n cells of equal cosine-weighted solid angle with a ray each. Cells next to one
/// whose ray has met light, or what lets light through, are sampled more densely: most noise of
/// daylight is that of few rays which find the window. Whether a cell is does not depend on its own
/// ray, so that the sum is not biased. Belongs to one thread.
class RefinedHemisphere {
  public:
    struct Sampling {
        Vec3 normal;        ///< unit
        int divisions = 1;  ///< n
        int finer = 1;      ///< rays of a denser cell, per axis
        RayKind kind = kAmbientSame;
        Rgb coef;         ///< what the rays are weighed by, for their limits
        float share = 1;  ///< of each cell in the sum, beside that
        RandomStream random;
    };
    /// All must outlive this.
    /// @param lets_light  by modifier: whether its surfaces are light, or let light through
    RefinedHemisphere(const LightTransport& tracer, std::span<const std::uint8_t> lets_light,
                      Ray& parent, const Sampling& sampling, TraceContext& context);
    /// The context's sink is told what the rays bring.
    [[nodiscard]] Surroundings sample();

  private:
    struct Rays {
        std::vector<Ray> rays;
        std::vector<Hit> hits;
        void clear() {
            rays.clear();
            hits.clear();
        }
    };
    struct Row : Rays {
        std::vector<int> place;           ///< of a cell's ray in the finer grid
        std::vector<int> ray;             ///< of a cell; -1: it has none
        std::vector<std::uint8_t> light;  ///< whether a cell's ray met light
    };
    void look(int i);
    void shade(int i);
    void trace(Rays& some);
    bool start(Rays& some, double x, double y);
    [[nodiscard]] bool met_light(const Hit& hit) const;
    [[nodiscard]] bool is_next_to_light(int i, int j) const;

    const LightTransport& tracer_;
    std::span<const std::uint8_t> lets_light_;
    Ray& parent_;
    Sampling sampling_;
    TraceContext& context_;
    HemisphereFrame frame_;
    std::array<Row, 3> rows_;  ///< of cells: row i is i modulo 3
    Rays more_;                ///< of denser cells
    Surroundings seen_;
};

}  // namespace lightwalk
