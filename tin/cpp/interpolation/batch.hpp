// Many points at a time: shared among threads, each in an order that keeps memory near.
#pragma once

#include <cstdint>
#include <limits>

#include "../base/parallel.hpp"
#include "../location/locator.hpp"

namespace tinsmith {

// make() gives each thread an evaluate(point, triangle of locator.ordered()) of its own. NaN outside.
// Every result is the same for any number of threads. Check `team.is_stopped()` afterwards.
template <typename Make>
void interpolate_all(const Locator& locator, const Point* points, std::int64_t count,
                     double* result, Team& team, Make&& make) {
  team.run([&](int part) {
    const std::int64_t begin = count * part / team.size();
    const std::int64_t end = count * (part + 1) / team.size();
    auto evaluate = make();
    locator.visit_queries(
        points + begin, end - begin, [&] { return team.keeps_going(part); },
        [&](std::int64_t i, Point p, Triangle triangle) {
          result[begin + i] = triangle == kNoTriangle ? std::numeric_limits<double>::quiet_NaN()
                                                      : evaluate(p, triangle);
        });
  });
}

}  // namespace tinsmith
