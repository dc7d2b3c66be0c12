#pragma once
// A stand-in for a scene that is walked through: what a ray meets is known without tracing, and
// what it shows tells of which scene it is.
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/transport/light_groups.h"
#include "core/view/view.h"
#include "parallel/walk/frame_caster.h"
#include "parallel/walk/scene_caster.h"

namespace lightwalk::simulation {

/// An empty room with a screen that hides a part of it, lit by two groups of lamps.
struct WalkRoom {
    std::uint32_t light = 0;   ///< another one shows in every surface: 16 times as bright each
    std::uint32_t screen = 0;  ///< how the screen looks
    friend bool operator==(const WalkRoom&, const WalkRoom&) = default;
};

inline constexpr std::size_t kRoomGroups = 2;
/// PrimaryVisibility::surface & kMaterialBits of the screen.
inline constexpr std::uint32_t kScreen = 7;

/// What each group adds is between these, times 16 for each step of the light.
inline constexpr float kDarkest = 0.25f, kBrightest = 0.75f;
[[nodiscard]] float scale_of(const WalkRoom& room);

/// The rays of one frame into the room.
class RoomCaster final : public FrameCaster {
  public:
    struct Picture {
        View view;
        int width = 0, height = 0;
        FrameUse use = FrameUse::picture;
        LightMixture mixture = {};
        bool groups = false;  ///< whether they are kept
    };
    /// Called before pixels are looked at or traced.
    struct Watch {
        std::function<void()> looks;
        std::function<void(std::span<const PixelPlace> places, int sample)> traces;
    };
    RoomCaster(const WalkRoom& room, const Picture& picture, int workers, Watch watch = {});

    void probe(std::span<const PixelPlace> places, const ProbeOptions& options,
               std::span<PixelVisibility> visibility, int worker) override;
    void trace(std::span<const PixelPlace> places, std::span<TracedPixel> pixels, int sample,
               int worker) override;
    [[nodiscard]] PixelGroups groups(int worker) const override;
    [[nodiscard]] const Camera& camera() const override { return camera_; }
    [[nodiscard]] std::uint64_t traced() const override { return traced_; }

  private:
    struct Scratch {
        std::vector<Rgb> whole, mirrored;
    };
    [[nodiscard]] PixelVisibility look(const PixelRays& rays, const PixelPlace& place) const;

    WalkRoom room_;
    Picture picture_;
    Camera camera_;
    FrameOptions options_;
    PixelRays rays_;  ///< of sample 0
    Watch watch_;
    std::vector<Scratch> scratch_;  ///< by worker
    std::uint64_t traced_ = 0;
};

}  // namespace lightwalk::simulation
