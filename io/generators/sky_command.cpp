#include "io/generators/sky_command.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "io/generators/scene_writer.h"

namespace lightwalk {
namespace {

constexpr std::size_t kMonth = 1, kDay = 2, kHour = 3;  ///< places of the words

/// gensky's options that say which sky; all others take a number.
bool is_type_option(const std::string& word) {
    return word.size() >= 2 && std::string_view("scui").find(word[1]) != std::string_view::npos;
}

/// A number of hours as both generators read it: fewer than 24.
std::string hour_text(double hour) {
    constexpr int kDecimals = 4;  // a third of a second
    constexpr double kLast = 23.9999;
    return fixed(std::clamp(hour, 0.0, kLast), kDecimals);
}

double of_day(double hour) {
    return hour - 24 * std::floor(hour / 24);
}

}  // namespace

bool SkyCommand::is_sky(const std::string& program) {
    return program == "gensky" || program == "gendaylit";
}

SkyCommand::SkyCommand(std::vector<std::string> words) : words_(std::move(words)) {
    if (words_.size() == 2 && words_[1] == "-defaults")
        throw InputError(words_[0] + " -defaults makes no sky");
    details_ = words_[0] == "gensky" ? gensky_details(words_) : gendaylit_details(words_);
    if (details_.moment.angles)
        throw InputError(words_[0] + " -ang gives the sun's angles, and no time");
}

SkyTime SkyCommand::time() const {
    const SolarDate& date = details_.moment.date;
    return {date.month, date.day, date.hour, details_.type};
}

std::vector<std::string> SkyCommand::at(const SkyTime& time) const {
    std::vector<std::string> words(words_.begin(), words_.begin() + kHour);
    words[kMonth] = std::to_string(time.month);
    words[kDay] = std::to_string(time.day);
    const std::string& hour = words_[kHour];
    const auto zone = std::ranges::find_if(
        hour, [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
    words.push_back((solar_time() ? "+" : "") + hour_text(time.hour) +
                    std::string(has_types() ? zone : hour.end(), hour.end()));
    const bool retyped = has_types() && !time.type.empty();
    for (std::size_t i = kHour + 1; i < words_.size(); ++i) {
        if (!has_types()) {
            words.push_back(words_[i]);
            continue;
        }
        const bool type = is_type_option(words_[i]);
        if (!type || !retyped) words.push_back(words_[i]);
        if (!type && i + 1 < words_.size()) words.push_back(words_[++i]);
    }
    if (retyped) words.push_back(time.type);
    return words;
}

SolarDate SkyCommand::date(const SkyTime& time) const {
    SolarDate date = details_.moment.date;
    date.month = time.month;
    date.day = time.day;
    date.hour = time.hour;
    return date;
}

/// By the sun's declination at noon; it changes little in a day.
SunTimes SkyCommand::sun(const SkyTime& time) const {
    SunTimes times;
    const SolarAngles angles = solar_angles(lightwalk::solar_time(date(time), site()), site());
    times.altitude = angles.altitude;
    times.azimuth = angles.azimuth;
    SolarDate at_noon = date(time);
    at_noon.hour = 12;
    const SolarTime noon = lightwalk::solar_time(at_noon, site());
    const double cosine = -std::tan(site().latitude) * std::tan(noon.declination);
    if (!(std::abs(cosine) <= 1)) return times;
    const double half_day = 12 / kPi * std::acos(cosine), middle = 24 - noon.hour;
    times.rise = of_day(middle - half_day);
    times.set = of_day(middle + half_day);
    return times;
}

}  // namespace lightwalk
