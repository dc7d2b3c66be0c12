#include "core/transport/counters.h"

namespace lightwalk {

RayCounters& RayCounters::operator+=(const RayCounters& o) {
    primary += o.primary;
    shadow += o.shadow;
    specular += o.specular;
    transmitted += o.transmitted;
    ambient += o.ambient;
    return *this;
}

AmbientCounters& AmbientCounters::operator+=(const AmbientCounters& o) {
    interpolated += o.interpolated;
    computed += o.computed;
    incomplete += o.incomplete;
    waits += o.waits;
    duplicates += o.duplicates;
    return *this;
}

TraceCounters& TraceCounters::operator+=(const TraceCounters& o) {
    rays += o.rays;
    ambient += o.ambient;
    return *this;
}

}  // namespace lightwalk
