#pragma once
// Calls of gensky and gendaylit that say when: their words for another day and hour.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/generators/sky_words.h"

namespace lightwalk {

/// When a sky is seen, by the clock of the call that makes it, and which kind of sky it is.
struct SkyTime {
    int month = 1, day = 1;
    double hour = 12;       ///< 0 to 24, exclusive
    std::string type = {};  ///< of gensky, one of kSkyTypes; "": as the call has it
    friend bool operator==(const SkyTime&, const SkyTime&) = default;
};

/// gensky's kinds of sky: sunny, intermediate, overcast and uniform; with a + the sun is written,
/// too.
inline constexpr std::array<const char*, 6> kSkyTypes = {"+s", "-s", "+i", "-i", "-c", "-u"};

/// What is to be said has been said when the scene was read.
class NoWarnings final : public WarningSink {
  public:
    void warn(const std::string&) override {}
};

/// The sun's day, by the call's clock.
struct SunTimes {
    std::optional<double> rise, set;   ///< [h], 0 to 24; neither: it is up, or down, all day
    double altitude = 0, azimuth = 0;  ///< at the hour; from the south to the west [rad]
};

/// What the words of a call say.
struct SkyDetails {
    SkyMoment moment;
    Site site;
    std::string type;  ///< one of kSkyTypes; "": the generator knows no types
};
// Throw InputError for wrong words.
[[nodiscard]] SkyDetails gensky_details(std::span<const std::string> words);
[[nodiscard]] SkyDetails gendaylit_details(std::span<const std::string> words);

class SkyCommand {
  public:
    /// Whether a program is one of the two.
    [[nodiscard]] static bool is_sky(const std::string& program);

    /// Throws InputError where the words are wrong, or give angles in place of a time.
    /// @param words  the program's name first
    explicit SkyCommand(std::vector<std::string> words);

    /// As it is called.
    [[nodiscard]] SkyTime time() const;
    [[nodiscard]] const std::string& program() const { return words_[0]; }
    [[nodiscard]] const Site& site() const { return details_.site; }
    /// Whether hours are of local solar time, not of a clock.
    [[nodiscard]] bool solar_time() const { return details_.moment.date.solar_time; }
    [[nodiscard]] bool has_types() const { return !details_.type.empty(); }

    /// The words of the same call at another time.
    [[nodiscard]] std::vector<std::string> at(const SkyTime& time) const;
    [[nodiscard]] SunTimes sun(const SkyTime& time) const;

  private:
    [[nodiscard]] SolarDate date(const SkyTime& time) const;

    std::vector<std::string> words_;
    SkyDetails details_;
};

}  // namespace lightwalk
