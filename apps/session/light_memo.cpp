#include "apps/session/light_memo.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

namespace lightwalk {
namespace {

constexpr std::size_t kPlaces = 16;
constexpr std::size_t kMostNumbers = std::size_t{1} << 14;

enum class State : std::uint32_t { free, taken, ready };

/// One set of options. Who takes it and is killed leaves it taken, which costs the place.
struct Place {
    std::atomic<State> state;
    RenderNumbers options;
    std::uint32_t hit_rates, emissions;
    std::array<float, kMostNumbers> numbers;
};
static_assert(std::atomic<State>::is_always_lock_free);
static_assert(std::is_trivially_copyable_v<RenderNumbers>);

class SharedLightMemo final : public LightMemo {
  public:
    explicit SharedLightMemo(void* memory)
        : memory_(memory), places_(static_cast<Place*>(memory), kPlaces) {
        // Not the numbers: pages that nobody touches are no memory.
        for (Place& place : places_) new (&place.state) std::atomic<State>(State::free);
    }
    SharedLightMemo(const SharedLightMemo&) = delete;
    SharedLightMemo& operator=(const SharedLightMemo&) = delete;
    ~SharedLightMemo() override { munmap(memory_, kPlaces * sizeof(Place)); }

    [[nodiscard]] std::optional<LightMeasures> find(const RenderNumbers& options) const override {
        for (const Place& place : places_) {
            if (place.state.load(std::memory_order_acquire) != State::ready ||
                !(place.options == options))
                continue;
            const float* const rates = place.numbers.data();
            const float* const emissions = rates + place.hit_rates;
            return LightMeasures{{rates, emissions}, {emissions, emissions + place.emissions}};
        }
        return {};
    }

    void keep(const RenderNumbers& options, const LightMeasures& measures) override {
        const std::size_t rates = measures.hit_rates.size(), emissions = measures.emissions.size();
        if (rates + emissions > kMostNumbers) return;
        const auto take = [](Place& place) {
            State expected = State::free;
            return place.state.compare_exchange_strong(expected, State::taken);
        };
        const auto place = std::ranges::find_if(places_, take);
        if (place == places_.end()) return;
        place->options = options;
        place->hit_rates = static_cast<std::uint32_t>(rates);
        place->emissions = static_cast<std::uint32_t>(emissions);
        std::ranges::copy(measures.hit_rates, place->numbers.begin());
        std::ranges::copy(measures.emissions,
                          place->numbers.begin() + static_cast<std::ptrdiff_t>(rates));
        place->state.store(State::ready, std::memory_order_release);
    }

  private:
    void* memory_;
    std::span<Place> places_;
};

}  // namespace

std::shared_ptr<LightMemo> make_shared_light_memo() {
    void* const memory = mmap(nullptr, kPlaces * sizeof(Place), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) return nullptr;
    return std::make_shared<SharedLightMemo>(memory);
}

}  // namespace lightwalk
