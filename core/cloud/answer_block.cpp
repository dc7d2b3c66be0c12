#include "core/cloud/answer_block.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "core/cloud/reuse_error_controller.h"
#include "core/cloud/sparse_hits.h"
#include "core/math/prefetch.h"
#include "core/math/random.h"

namespace lightwalk {
namespace {

constexpr int kPacketSide = 8;  ///< of the pixels that are looked at together
constexpr std::size_t kPacket = std::size_t{kPacketSide} * kPacketSide;

/// Of the tiles: of CloudCheck::rotating, of those where points seem to tell enough.
constexpr double kCheckedShare = 1.0 / 3;

/// Of rays that check pixels where all points are of one surface [pixels].
constexpr int kSurfaceSpacing = 4;

/// Pixels that will be checked together.
struct Packet {
    int spacing = 1;  ///< see ProbeOptions
    std::size_t count = 0;
    std::array<PixelPlace, 2 * kPacket> places{};
};

class BlockAnswerer {
  public:
    BlockAnswerer(const RegionAnswers& region, int worker, BlockUncachedPixels& found)
        : options_(region.options),
          rules_(region.rules),
          region_(region),
          points_(region.points),
          frame_(region.frame),
          finder_(points_.finder(tightened(options_.rules, rules_.tightness))),
          worker_(worker),
          found_(found) {}

    void answer(const PixelRectangle& block) {
        found_.uncached.clear();
        found_.ranked.fill(0);
        found_.unanswered = found_.left = 0;
        if (!has_all_rays()) blacken(block);
        for (int y0 = block.y0 - block.y0 % kPacketSide; y0 < block.y1; y0 += kPacketSide) {
            for (int x0 = block.x0 - block.x0 % kPacketSide; x0 < block.x1; x0 += kPacketSide) {
                std::array<PixelPlace, kPacket> tile;
                std::size_t pixels = 0;
                for (int y = std::max(y0, block.y0); y < std::min(y0 + kPacketSide, block.y1); ++y)
                    for (int x = std::max(x0, block.x0); x < std::min(x0 + kPacketSide, block.x1);
                         ++x)
                        tile[pixels++] = {x, y};
                const std::span left(tile.data(), answer_freely({tile.data(), pixels}));
                Packet& packet = shows_one_surface(left) ? of_surface_ : of_any_;
                std::copy(left.begin(), left.end(), packet.places.begin() + packet.count);
                packet.count += left.size();
                if (packet.count >= kPacket) answer_packet(packet);
            }
        }
        answer_packet(of_surface_);
        answer_packet(of_any_);
        for (const UncachedPixel& pixel : found_.uncached)
            ++found_.ranked[trace_rank(pixel, options_.budget > 0)];
    }

  private:
    /// Whether no pixel is outside the view's domain.
    [[nodiscard]] bool has_all_rays() const {
        const char type = points_.camera().view().type;
        return type == 'v' || type == 'l';
    }

    /// Whether the lot has rays check all of a pixel's tile. No fixed turn: points that move a tile
    /// a frame would then never be checked.
    [[nodiscard]] bool is_checked(const PixelPlace& place) const {
        return RandomStream::of_pixel(options_.seed + rules_.frame + 1,
                                      static_cast<std::uint32_t>(place.x / kPacketSide),
                                      static_cast<std::uint32_t>(place.y / kPacketSide), 1)
                   .next() < kCheckedShare;
    }

    /// Those pixels of a tile whose middles have a ray, moved to the front.
    [[nodiscard]] std::span<PixelPlace> with_rays(std::span<PixelPlace> tile) const {
        const auto end = std::remove_if(tile.begin(), tile.end(), [&](const PixelPlace& place) {
            return !points_.camera().ray((place.x + 0.5) / points_.width(),
                                         (place.y + 0.5) / points_.height());
        });
        return tile.first(static_cast<std::size_t>(end - tile.begin()));
    }

    /// Pixels without rays are black.
    void blacken(const PixelRectangle& area) {
        const auto width = static_cast<std::size_t>(area.width());
        for (int y = area.y0; y < area.y1; ++y) {
            const auto row = static_cast<std::ptrdiff_t>(frame_.area.index({area.x0, y}));
            std::fill_n(frame_.radiance.begin() + row, width, Rgb{});
            std::fill_n(frame_.distance.begin() + row, width, 0.0f);
            std::fill_n(frame_.causes.begin() + row, width, TraceCause::none);
            std::fill_n(frame_.known.begin() + row, width, std::uint8_t{1});
            if (!frame_.origins.empty())
                std::fill_n(frame_.origins.begin() + row, width, PixelOrigin{});
        }
    }

    /// Nothing is known of the pixels of a tile, row by row.
    void forget(std::span<const PixelPlace> tile) {
        for (auto row = tile.begin(); row != tile.end();) {
            auto end = row + 1;
            while (end != tile.end() && end->y == row->y && end->x == end[-1].x + 1) ++end;
            const auto at = static_cast<std::ptrdiff_t>(frame_.area.index(*row));
            const std::ptrdiff_t count = end - row;
            const auto fill = [&](auto& values, auto value) {
                std::fill_n(values.begin() + at, count, value);
            };
            fill(frame_.distance, 0.0f);
            fill(frame_.causes, TraceCause::uncovered);
            fill(frame_.known, std::uint8_t{0});
            if (!frame_.origins.empty()) fill(frame_.origins, PixelOrigin{});
            row = end;
        }
    }

    /// A pixel will be answered soon: fetch what is read and written then into the cache.
    void expect(const PixelPlace& place) const {
        const std::size_t at = frame_.area.index(place);
        finder_.expect(place);
        prefetch(&frame_.radiance[at]);
        prefetch(&frame_.distance[at]);
        if (!frame_.origins.empty()) prefetch(&frame_.origins[at]);
    }

    /// A pixel of which nothing is known stays an uncached pixel. Not all are noted where there is
    /// no time for them anyway, only coarse grids of them.
    void leave(const PixelPlace& place) {
        ++found_.unanswered;
        ++found_.left;
        if (grid_level(place) <= region_.finest)
            found_.uncached.push_back({place, TraceCause::uncovered});
    }

    /// Show what a pixel's answer brings, or note that it is an uncached pixel.
    void accept(const PixelPlace& place, const PixelAnswer& answer) {
        const std::size_t at = frame_.area.index(place);
        const bool reused = answer.found();
        const bool guessed = !reused && options_.budget > 0 && finder_.is_guess(answer);
        const bool known = reused || guessed;
        frame_.radiance[at] = known ? answer.radiance : Rgb{};
        frame_.distance[at] = known ? finder_.distance(answer) : 0;
        frame_.causes[at] = answer.cause;
        frame_.known[at] = known ? 1 : 0;
        const std::uint32_t seen = answer.ahead != kNoPoint ? answer.ahead : answer.mirrored;
        if (known && !frame_.surfaces.empty()) {
            frame_.surfaces[at] = seen != kNoPoint ? points_.all()[seen].surface : 0;
            frame_.patterns[at] = seen != kNoPoint ? points_.all()[seen].pattern : kNoPattern;
        }
        if (!reused) {
            using Kind = PixelOrigin::Kind;
            if (!frame_.origins.empty())
                frame_.origins[at] = {guessed ? Kind::guessed : Kind::filled, 0, 0};
            found_.uncached.push_back({place, answer.cause});
            ++found_.unanswered;
            return;
        }
        for (const std::uint32_t index : {answer.ahead, answer.mirrored})
            if (index != kNoPoint) points_.use(index);
        if (frame_.origins.empty()) return;
        const int fresh = seen != kNoPoint ? kOldestAge - points_.all()[seen].old : 0;
        frame_.origins[at] = {PixelOrigin::Kind::reused, 0, static_cast<std::uint32_t>(fresh)};
    }

    /// The same for a pixel that this frame's audit may trace though it is reused.
    void accept_or_audit(const PixelPlace& place, const PixelAnswer& answer) {
        accept(place, answer);
        if (answer.found() && options_.audit > 0 &&
            audit_stream(options_.seed, rules_.frame, place).next() < options_.audit)
            found_.uncached.push_back({place, TraceCause::audited});
    }

    /// Whether all points in a tile whose pixels are about to be checked are of one surface, so
    /// that few rays tell for all.
    [[nodiscard]] bool shows_one_surface(std::span<const PixelPlace> tile) const {
        if (options_.check != CloudCheck::rotating || tile.size() < SparseHits::kWorthCorners)
            return false;
        std::optional<std::uint32_t> surface;
        std::size_t known = 0;
        for (const PixelPlace& place : tile) {
            const std::optional<std::uint32_t> here = finder_.surface_at(place);
            if (!here) continue;
            ++known;
            if (surface && *surface != *here) return false;
            surface = here;
        }
        return 2 * known > tile.size();
    }

    /// What is read and written afterwards is fetched into the cache while rays are cast: writes
    /// are done in order, so that one that misses holds up all after it.
    void answer_packet(Packet& packet) {
        const std::span<const PixelPlace> places(packet.places.data(),
                                                 std::exchange(packet.count, 0));
        if (places.empty()) return;
        std::array<PixelVisibility, 2 * kPacket> visibility;
        std::array<PixelAnswer, 2 * kPacket> answers;
        for (const PixelPlace& place : places) expect(place);
        region_.caster.probe(places, {false, packet.spacing}, {visibility.data(), places.size()},
                             worker_);
        finder_.checked(places, {visibility.data(), places.size()}, answers);
        for (std::size_t i = 0; i < places.size(); ++i)
            if (answers[i].ahead != kNoPoint) points_.expect_use(answers[i].ahead);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const PixelPlace& place = places[i];
            if (visibility[i].ray)
                accept_or_audit(place, answers[i]);
            else
                blacken({place.x, place.y, place.x + 1, place.y + 1});
        }
    }

    /// Answer those pixels of a tile that the last frame's surfaces seem to go through.
    /// @return  the number of those left, which are moved to the front
    [[nodiscard]] std::size_t answer_temporal(std::span<PixelPlace> tile,
                                              const PixelSquare& square) {
        std::array<PixelAnswer, kPacket> answers;
        for (const PixelPlace& place : tile) expect(place);
        finder_.temporal(square, tile, answers);
        for (std::size_t i = 0; i < tile.size(); ++i)
            if (answers[i].found()) points_.expect_use(answers[i].ahead);
        std::size_t left = 0;
        for (std::size_t i = 0; i < tile.size(); ++i) {
            if (answers[i].found())
                accept_or_audit(tile[i], answers[i]);
            else
                tile[left++] = tile[i];
        }
        return left;
    }

    /// Leave those pixels of a tile that no point can answer, whatever their rays see.
    /// @return  the number of the others, which are moved to the front
    [[nodiscard]] std::size_t leave_blank(std::span<PixelPlace> tile, const PixelSquare& square) {
        forget(tile);
        std::size_t others = 0;
        for (const PixelPlace& place : tile) {
            if (square.is_blank(place))
                leave(place);
            else
                tile[others++] = place;
        }
        return others;
    }

    /// Answer a tile for which there is no time. Nobody audits what is shown for a moment.
    void answer_late(std::span<const PixelPlace> tile, const PixelSquare& square) {
        std::array<PixelAnswer, kPacket> answers;
        finder_.unverified(square, tile, answers);
        for (std::size_t i = 0; i < tile.size(); ++i)
            if (answers[i].ahead != kNoPoint) points_.expect_use(answers[i].ahead);
        for (std::size_t i = 0; i < tile.size(); ++i) {
            if (answers[i].cause == TraceCause::uncovered)
                leave(tile[i]);
            else
                accept(tile[i], answers[i]);
        }
    }

    /// Answer those pixels of a tile that no ray checks, of CloudCheck::rotating.
    /// @return  the number of those left, which are moved to the front
    [[nodiscard]] std::size_t answer_rotating(std::span<PixelPlace> tile) {
        if (!has_all_rays()) tile = with_rays(tile);
        if (tile.empty()) return 0;
        const PixelSquare square = finder_.square_of(tile.front());
        const std::span<PixelPlace> others = tile.first(leave_blank(tile, square));
        if (region_.is_late()) {
            answer_late(others, square);
            return 0;
        }
        if (others.empty() || is_checked(others.front())) return others.size();
        return answer_temporal(others, square);
    }

    /// The same, of any CloudCheck.
    [[nodiscard]] std::size_t answer_freely(std::span<PixelPlace> tile) {
        if (!rules_.empty && options_.check == CloudCheck::all) return tile.size();
        if (!rules_.empty && options_.check == CloudCheck::rotating) return answer_rotating(tile);
        std::size_t left = 0;
        for (const PixelPlace& place : tile) {
            if (!rules_.empty && options_.check == CloudCheck::edges && finder_.is_edge(place))
                tile[left++] = place;
            else
                accept_or_audit(place, finder_.unchecked(place));
        }
        return left;
    }

    const CloudOptions& options_;
    const CloudRules& rules_;
    const RegionAnswers& region_;
    RegionPoints& points_;
    CloudFrame& frame_;
    PointFinder finder_;
    int worker_;
    BlockUncachedPixels& found_;
    Packet of_surface_{kSurfaceSpacing}, of_any_;
};

}  // namespace

void answer_block(const RegionAnswers& region, const PixelRectangle& block, int worker,
                  BlockUncachedPixels& found) {
    BlockAnswerer(region, worker, found).answer(block);
}

}  // namespace lightwalk
