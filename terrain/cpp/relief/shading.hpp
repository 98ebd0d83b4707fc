// How bright planes are under a light, as whole numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tinsmith {

// The direction to the light, of length 1.
struct LightDirection {
  double east, north, up;
};

// `darkest` to `brightest` for each normal of any length: the cosine of the angle between light and
// normal, `darkest` for one without a direction.
inline void shade_planes(const double* normals, std::size_t count, const LightDirection& light,
                         std::uint8_t darkest, std::uint8_t brightest, std::uint8_t* shades) {
  const double range = brightest - darkest;
  for (std::size_t i = 0; i < count; ++i) {
    const double* n = normals + 3 * i;
    const double largest = std::max({std::fabs(n[0]), std::fabs(n[1]), std::fabs(n[2])});
    const double east = n[0] / largest, north = n[1] / largest, up = n[2] / largest;
    const double length = std::sqrt(east * east + north * north + up * up);  // 1 to 1.8, or NaN
    const double toward = east * light.east + north * light.north + up * light.up;
    const double cosine = toward / length;
    const double part = cosine > 0.0 ? std::min(cosine, 1.0) : 0.0;
    shades[i] = static_cast<std::uint8_t>(std::nearbyint(darkest + range * part));
  }
}

}  // namespace tinsmith
