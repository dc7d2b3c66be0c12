#pragma once
// A list of rays as rank 0 tells the others of it.
#include <cstdint>
#include <utility>
#include <vector>

#include "apps/session/lightwalk/renderer.h"
#include "core/error.h"

namespace lightwalk {

struct ListedRays {
    std::uint64_t first = 0;      ///< of all rays of the input
    std::vector<double> numbers;  ///< of each ray six: origin and direction
};
template <class Wire>
void visit_fields(Wire& wire, ListedRays& list) {
    wire(list.first, list.numbers);
}

[[nodiscard]] inline std::vector<double> numbers_of(const RayTask& list) {
    std::vector<double> numbers;
    numbers.reserve(6 * list.rays.size());
    for (const RayQuery& query : list.rays) {
        for (const Vec3& v : {query.origin, query.direction})
            numbers.insert(numbers.end(), {v.x, v.y, v.z});
    }
    return numbers;
}

/// The inverse. Throws InputError for numbers of half a ray.
[[nodiscard]] inline RayTask list_of(const ListedRays& told) {
    if (told.numbers.size() % 6 != 0) throw InputError("a list of rays ends within one");
    RayTask list;
    list.first = told.first;
    for (std::size_t i = 0; i < told.numbers.size(); i += 6) {
        const double* const v = &told.numbers[i];
        list.rays.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
    }
    return list;
}

}  // namespace lightwalk
