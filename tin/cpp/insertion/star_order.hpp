// Order of the triangles that belong to one vertex, as the growth would have found them.
//
// They form sectors; sectors are ordered by the vertex they start at, triangles within one
// counter-clockwise. A vertex that owns its whole star starts at its nearest neighbour.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"

namespace tinsmith {

class StarOrder {
 public:
  // A triangle without the vertex that owns it; vertices are compared by number.
  struct Ray {
    Vertex from, to;
    std::int32_t triangle;  // whatever the caller tells it by
  };

  void clear() { rays_.clear(); }
  void add(Ray ray) { rays_.push_back({ray, kNoRay, true}); }

  // compare(a, b) > 0 if vertex a is further from the owner than b is; asked only about an owner
  // of its whole star. Afterwards the rays are visited in order.
  template <typename Compare>
  void put_in_order(Compare&& compare) {
    sorted_.clear();
    if (rays_.empty()) return;
    if (rays_.size() <= kFewRays) {
      link_few_rays();
    } else {
      link_many_rays();
    }
    starts_.clear();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (rays_[i].is_start) starts_.push_back(static_cast<std::int32_t>(i));
    }
    if (starts_.empty()) starts_.push_back(nearest_ray(compare));
    std::sort(starts_.begin(), starts_.end(), [this](std::int32_t a, std::int32_t b) {
      return rays_[a].ray.from < rays_[b].ray.from;
    });
    for (const std::int32_t start : starts_) list_sector(start);
  }

  std::vector<Ray>::const_iterator begin() const { return sorted_.begin(); }
  std::vector<Ray>::const_iterator end() const { return sorted_.end(); }

 private:
  struct LinkedRay {
    Ray ray;
    std::int32_t next;  // the ray that starts at `to`
    bool is_start;      // no ray ends at `from`
  };
  static constexpr std::int32_t kNoRay = -1;
  static constexpr std::size_t kFewRays = 12;  // so few are compared all with all

  void link(LinkedRay& ray, std::int32_t next) {
    ray.next = next;
    if (next != kNoRay) rays_[next].is_start = false;
  }

  void link_few_rays() {
    for (LinkedRay& ray : rays_) {
      std::int32_t next = kNoRay;
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        next = rays_[i].ray.from == ray.ray.to ? static_cast<std::int32_t>(i) : next;
      }
      link(ray, next);
    }
  }

  void link_many_rays() {
    std::sort(rays_.begin(), rays_.end(),
              [](const LinkedRay& a, const LinkedRay& b) { return a.ray.from < b.ray.from; });
    for (LinkedRay& ray : rays_) {
      const auto found =
          std::lower_bound(rays_.begin(), rays_.end(), ray.ray.to,
                           [](const LinkedRay& other, Vertex to) { return other.ray.from < to; });
      const bool is_found = found != rays_.end() && found->ray.from == ray.ray.to;
      link(ray, is_found ? static_cast<std::int32_t>(found - rays_.begin()) : kNoRay);
    }
  }

  template <typename Compare>
  std::int32_t nearest_ray(Compare& compare) const {
    const auto is_nearer = [&](const LinkedRay& a, const LinkedRay& b) {
      const int order = compare(a.ray.from, b.ray.from);
      return order < 0 || (order == 0 && a.ray.from < b.ray.from);
    };
    const auto nearest = std::min_element(rays_.begin(), rays_.end(), is_nearer);
    return static_cast<std::int32_t>(nearest - rays_.begin());
  }

  void list_sector(std::int32_t start) {
    std::int32_t i = start;
    do {
      sorted_.push_back(rays_[i].ray);
      i = rays_[i].next;
    } while (i != kNoRay && i != start);
  }

  std::vector<LinkedRay> rays_;
  std::vector<std::int32_t> starts_;
  std::vector<Ray> sorted_;
};

}  // namespace tinsmith
