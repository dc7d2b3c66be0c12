#include "apps/walk/walk_time.h"

namespace lightwalk {
namespace {

constexpr double kDegrees = 180 / kPi;

}  // namespace

std::optional<TimePlace> time_place(const SkyCalls& skies) {
    if (skies.empty()) return std::nullopt;
    TimePlace place;
    place.refused = skies.refusal();
    if (!place.refused.empty()) return place;
    const SkyCommand& first = skies.first();
    place.time = first.time();
    place.solar = first.solar_time();
    place.types = skies.has_types();
    place.latitude = first.site().latitude * kDegrees;
    place.longitude = -first.site().longitude * kDegrees;
    return place;
}

TimeReply time_reply(const SkyCalls& skies, const std::optional<SkyTime>& time,
                     const std::string& problem) {
    TimeReply reply;
    reply.time = time;
    reply.problem = problem;
    if (skies.empty() || !skies.refusal().empty()) return reply;
    const SkyCommand& first = skies.first();
    const SunTimes sun = first.sun(time.value_or(first.time()));
    reply.rise = sun.rise;
    reply.set = sun.set;
    reply.altitude = sun.altitude * kDegrees;
    reply.azimuth = sun.azimuth * kDegrees;
    return reply;
}

}  // namespace lightwalk
