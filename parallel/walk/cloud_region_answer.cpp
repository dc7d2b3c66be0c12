// CloudRegion's pixels, answered by points: square by square, many of them side by side.
#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "core/math/prefetch.h"
#include "parallel/walk/cloud_region.h"
#include "parallel/walk/step_timer.h"

namespace lightwalk {
namespace {

constexpr int kPacketSide = 8;  ///< of the pixels that are looked at together
constexpr std::size_t kPacket = std::size_t{kPacketSide} * kPacketSide;

/// Of the tiles: of CloudCheck::rotating, of those where points seem to tell enough.
constexpr double kCheckedShare = 1.0 / 3;

/// Of the audited pixels a second ray tells how much two rays differ.
constexpr double kFloorShare = 0.25;

/// Whether no pixel is outside the view's domain.
bool has_all_rays(const Camera& camera) {
    return camera.view().type == 'v' || camera.view().type == 'l';
}

/// Many pixels may use one point.
void mark(std::uint8_t& flag) {
    std::atomic_ref<std::uint8_t>(flag).store(1, std::memory_order_relaxed);
}

}  // namespace

/// What decides whether this frame's audit traces a pixel though it is reused, and whether twice.
RandomStream CloudRegion::audit_stream(const PixelPlace& place) const {
    return RandomStream::of_pixel(options_.seed + rules_.frame + 1,
                                  static_cast<std::uint32_t>(place.x),
                                  static_cast<std::uint32_t>(place.y), 0);
}

void CloudRegion::answer(const PixelCaster& caster, Executor& executor, const StopFlag& stop,
                         Clock::time_point check_until) {
    const StepTimer timer(frame_.report.check_seconds);
    check_until_ = check_until;
    uncached_of_.resize(blocks_.size());
    // Where time is short it is that of the last ones: others in each frame.
    const std::size_t first = rules_.frame * (blocks_.size() / 3 + 1);
    executor.for_each(
        blocks_.size(),
        [&](std::size_t block, int worker) {
            answer_block((first + block) % blocks_.size(), caster, worker);
        },
        stop);
    if (stop.requested()) return;
    order_uncached(executor);
    choose_noise_pairs();
    expect_uncached();
}

/// Where time is short: the worst first, among equals coarse grids.
std::size_t CloudRegion::rank(const UncachedPixel& uncached_pixel) const {
    if (!(options_.budget > 0)) return 0;
    return static_cast<std::size_t>(uncached_pixel.cause) * kGridLevels +
           static_cast<std::size_t>(grid_level(uncached_pixel.place));
}

/// By rank, and by block, where time is short another one first in each frame.
void CloudRegion::order_uncached(Executor& executor) {
    const std::size_t blocks = blocks_.size();
    const std::size_t first = options_.budget > 0 && blocks > 0 ? rules_.frame % blocks : 0;
    std::size_t count = 0;
    for (std::size_t rank = 0; rank < kTraceRanks; ++rank) {
        for (std::size_t k = 0; k < blocks; ++k) {
            std::uint32_t& of_block = uncached_of_[(first + k) % blocks].ranked[rank];
            count += std::exchange(of_block, static_cast<std::uint32_t>(count));
        }
    }
    for (const BlockUncachedPixels& block : uncached_of_) {
        unanswered_ += block.unanswered;
        left_ += block.left;
    }
    uncached_.resize(count);
    executor.for_each(blocks, [&](std::size_t k, int) {
        BlockUncachedPixels& block = uncached_of_[k];
        for (const UncachedPixel& uncached_pixel : block.uncached)
            uncached_[block.ranked[rank(uncached_pixel)]++] = uncached_pixel;
    });
}

void CloudRegion::choose_noise_pairs() {
    for (std::size_t i = 0; i < uncached_.size(); ++i) {
        if (uncached_[i].cause != TraceCause::audited) continue;
        RandomStream random = audit_stream(uncached_[i].place);
        (void)random.next();  // has decided that it is audited
        if (random.next() < kFloorShare) noise_pairs_.push_back(static_cast<std::uint32_t>(i));
    }
}

/// Whether the lot has rays check all of a pixel's tile. No fixed turn: points that move a tile a
/// frame would then never be checked.
bool CloudRegion::is_checked(const PixelPlace& place) const {
    return RandomStream::of_pixel(options_.seed + rules_.frame + 1,
                                  static_cast<std::uint32_t>(place.x / kPacketSide),
                                  static_cast<std::uint32_t>(place.y / kPacketSide), 1)
               .next() < kCheckedShare;
}

/// A pixel will be answered soon: fetch what is read and written then into the cache.
void CloudRegion::expect(const PixelPlace& place, const PointFinder& finder) const {
    const std::size_t at = pixel(place);
    finder.expect(place);
    prefetch(&frame_.radiance[at]);
    prefetch(&frame_.distance[at]);
    if (!origins_.empty()) prefetch(&origins_[at]);
}

/// Show what a pixel's answer brings, or note that it is an uncached pixel.
void CloudRegion::accept(const PixelPlace& place, const PointFinder& finder,
                         const PixelAnswer& answer, BlockUncachedPixels& block) {
    const std::size_t at = pixel(place);
    const bool reused = answer.found();
    const bool guessed = !reused && options_.budget > 0 && finder.is_guess(answer);
    const bool known = reused || guessed;
    frame_.radiance[at] = known ? answer.radiance : Rgb{};
    frame_.distance[at] = known ? finder.distance(answer) : 0;
    frame_.causes[at] = answer.cause;
    known_[at] = known ? 1 : 0;
    if (!reused) {
        using Kind = PixelOrigin::Kind;
        if (!origins_.empty()) origins_[at] = {guessed ? Kind::guessed : Kind::filled, 0, 0};
        block.uncached.push_back({place, answer.cause});
        ++block.unanswered;
        return;
    }
    for (const std::uint32_t index : {answer.ahead, answer.mirrored})
        if (index != kNoPoint) mark(used_[index]);
    if (origins_.empty()) return;
    const std::uint32_t index = answer.ahead != kNoPoint ? answer.ahead : answer.mirrored;
    const int fresh = index != kNoPoint ? kOldestAge - points_[index].old : 0;
    origins_[at] = {PixelOrigin::Kind::reused, 0, static_cast<std::uint32_t>(fresh)};
}

/// The same for a pixel that this frame's audit may trace though it is reused.
void CloudRegion::accept_or_audit(const PixelPlace& place, const PointFinder& finder,
                                  const PixelAnswer& answer, BlockUncachedPixels& block) {
    accept(place, finder, answer, block);
    if (answer.found() && options_.audit > 0 && audit_stream(place).next() < options_.audit)
        block.uncached.push_back({place, TraceCause::audited});
}

/// What is read and written afterwards is fetched into the cache while rays are cast: writes are
/// done in order, so that one that misses holds up all after it.
void CloudRegion::answer_packet(std::span<const PixelPlace> places, const PointFinder& finder,
                                const PixelCaster& caster, int worker, BlockUncachedPixels& block) {
    std::array<PixelVisibility, 2 * kPacket> visibility;
    std::array<PixelAnswer, 2 * kPacket> answers;
    for (const PixelPlace& place : places) expect(place, finder);
    caster.probe(places, {visibility.data(), places.size()}, worker);
    finder.checked(places, {visibility.data(), places.size()}, answers);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (answers[i].ahead != kNoPoint) prefetch(&used_[answers[i].ahead]);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const PixelPlace& place = places[i];
        if (visibility[i].ray)
            accept_or_audit(place, finder, answers[i], block);
        else
            blacken({place.x, place.y, place.x + 1, place.y + 1});
    }
}

/// Answer those pixels of a tile that the last frame's surfaces seem to go through.
/// @return  the number of those left, which are moved to the front
std::size_t CloudRegion::answer_temporal(std::span<PixelPlace> tile, const PixelSquare& square,
                                         const PointFinder& finder, BlockUncachedPixels& block) {
    std::array<PixelAnswer, kPacket> answers;
    for (const PixelPlace& place : tile) expect(place, finder);
    finder.temporal(square, tile, answers);
    for (std::size_t i = 0; i < tile.size(); ++i)
        if (answers[i].found()) prefetch(&used_[answers[i].ahead]);
    std::size_t left = 0;
    for (std::size_t i = 0; i < tile.size(); ++i) {
        if (answers[i].found())
            accept_or_audit(tile[i], finder, answers[i], block);
        else
            tile[left++] = tile[i];
    }
    return left;
}

/// Those pixels of a tile whose middles have a ray, moved to the front.
std::span<PixelPlace> CloudRegion::with_rays(std::span<PixelPlace> tile) const {
    const auto end = std::remove_if(tile.begin(), tile.end(), [&](const PixelPlace& place) {
        return !projector_->camera().ray((place.x + 0.5) / width_, (place.y + 0.5) / height_);
    });
    return tile.first(static_cast<std::size_t>(end - tile.begin()));
}

/// Nothing is known of the pixels of a tile, row by row.
void CloudRegion::forget(std::span<const PixelPlace> tile) {
    for (auto row = tile.begin(); row != tile.end();) {
        auto end = row + 1;
        while (end != tile.end() && end->y == row->y && end->x == end[-1].x + 1) ++end;
        const auto at = static_cast<std::ptrdiff_t>(pixel(*row));
        const std::ptrdiff_t count = end - row;
        const auto fill = [&](auto& values, auto value) {
            std::fill_n(values.begin() + at, count, value);
        };
        fill(frame_.distance, 0.0f);
        fill(frame_.causes, TraceCause::uncovered);
        fill(known_, std::uint8_t{0});
        if (!origins_.empty()) fill(origins_, PixelOrigin{});
        row = end;
    }
}

/// A pixel of which nothing is known stays an uncached pixel. Not all are noted where there is no
/// time for them anyway, only coarse grids of them.
void CloudRegion::leave(const PixelPlace& place, BlockUncachedPixels& block) const {
    ++block.unanswered;
    ++block.left;
    if (grid_level(place) <= finest_) block.uncached.push_back({place, TraceCause::uncovered});
}

/// Leave those pixels of a tile that no point can answer, whatever their rays see.
/// @return  the number of the others, which are moved to the front
std::size_t CloudRegion::leave_blank(std::span<PixelPlace> tile, const PixelSquare& square,
                                     BlockUncachedPixels& block) {
    forget(tile);
    std::size_t others = 0;
    for (const PixelPlace& place : tile) {
        if (square.is_blank(place))
            leave(place, block);
        else
            tile[others++] = place;
    }
    return others;
}

/// Answer a tile for which there is no time. Nobody audits what is shown for a moment.
void CloudRegion::answer_late(std::span<const PixelPlace> tile, const PixelSquare& square,
                              const PointFinder& finder, BlockUncachedPixels& block) {
    std::array<PixelAnswer, kPacket> answers;
    finder.unverified(square, tile, answers);
    for (std::size_t i = 0; i < tile.size(); ++i)
        if (answers[i].ahead != kNoPoint) prefetch(&used_[answers[i].ahead]);
    for (std::size_t i = 0; i < tile.size(); ++i) {
        if (answers[i].cause == TraceCause::uncovered)
            leave(tile[i], block);
        else
            accept(tile[i], finder, answers[i], block);
    }
}

/// Answer those pixels of a tile that no ray checks.
/// @return  the number of those left, which are moved to the front
std::size_t CloudRegion::answer_freely(std::span<PixelPlace> tile, const PointFinder& finder,
                                       BlockUncachedPixels& block) {
    if (!rules_.empty && options_.check == CloudCheck::all) return tile.size();
    if (!rules_.empty && options_.check == CloudCheck::rotating) {
        if (!has_all_rays(projector_->camera())) tile = with_rays(tile);
        if (tile.empty()) return 0;
        const PixelSquare square = finder.square_of(tile.front());
        const std::span<PixelPlace> others = tile.first(leave_blank(tile, square, block));
        if (Clock::now() > check_until_) {
            answer_late(others, square, finder, block);
            return 0;
        }
        if (others.empty() || is_checked(others.front())) return others.size();
        return answer_temporal(others, square, finder, block);
    }
    std::size_t left = 0;
    for (const PixelPlace& place : tile) {
        if (!rules_.empty && options_.check == CloudCheck::edges && finder.is_edge(place))
            tile[left++] = place;
        else
            accept_or_audit(place, finder, finder.unchecked(place), block);
    }
    return left;
}

/// Pixels without rays are black.
void CloudRegion::blacken(const PixelRectangle& area) {
    const auto width = static_cast<std::size_t>(area.width());
    for (int y = area.y0; y < area.y1; ++y) {
        const auto row = static_cast<std::ptrdiff_t>(pixel({area.x0, y}));
        std::fill_n(frame_.radiance.begin() + row, width, Rgb{});
        std::fill_n(frame_.distance.begin() + row, width, 0.0f);
        std::fill_n(frame_.causes.begin() + row, width, TraceCause::none);
        std::fill_n(known_.begin() + row, width, std::uint8_t{1});
        if (!origins_.empty()) std::fill_n(origins_.begin() + row, width, PixelOrigin{});
    }
}

void CloudRegion::answer_block(std::size_t block, const PixelCaster& caster, int worker) {
    const PointFinder finder(*projector_, points_, grids_, places_, reuse_);
    const PixelRectangle& area = blocks_[block];
    BlockUncachedPixels& found = uncached_of_[block];
    found.uncached.clear();
    found.ranked.fill(0);
    found.unanswered = found.left = 0;
    if (!has_all_rays(projector_->camera())) blacken(area);
    std::array<PixelPlace, 2 * kPacket> places;
    std::size_t count = 0;
    const auto check = [&] {
        if (count > 0) answer_packet({places.data(), count}, finder, caster, worker, found);
        count = 0;
    };
    for (int y0 = area.y0 - area.y0 % kPacketSide; y0 < area.y1; y0 += kPacketSide) {
        for (int x0 = area.x0 - area.x0 % kPacketSide; x0 < area.x1; x0 += kPacketSide) {
            PixelPlace* const tile = places.data() + count;
            std::size_t pixels = 0;
            for (int y = std::max(y0, area.y0); y < std::min(y0 + kPacketSide, area.y1); ++y)
                for (int x = std::max(x0, area.x0); x < std::min(x0 + kPacketSide, area.x1); ++x)
                    tile[pixels++] = {x, y};
            count += answer_freely({tile, pixels}, finder, found);
            if (count >= kPacket) check();
        }
    }
    check();
    for (const UncachedPixel& uncached_pixel : found.uncached) ++found.ranked[rank(uncached_pixel)];
}

}  // namespace lightwalk
