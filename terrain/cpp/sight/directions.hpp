// Vertices in the order of their directions from an eye, counter-clockwise, exactly.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/range.hpp"
#include "../../../tin/cpp/location/surface.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"

namespace tinsmith::sight {

class DirectionOrder {
 public:
  struct Keyed {
    double key;  // grows with the angle, from 0 in the east up to 4
    Vertex vertex;
  };

  DirectionOrder(const Surface& surface, Point eye) : surface_(surface), eye_(eye) {}

  Keyed keyed(Vertex v) const {
    const Point p = surface_.point(v);
    const double x = p.x - eye_.x, y = p.y - eye_.y;
    const double part = x / (std::fabs(x) + std::fabs(y));
    return {is_upper(p) ? 1.0 - part : 3.0 + part, v};
  }

  // Whether one comes before another, both not at the eye.
  bool operator()(const Keyed& one, const Keyed& other) const {
    if (std::fabs(one.key - other.key) > kRounding) return one.key < other.key;
    const Point p = surface_.point(one.vertex), q = surface_.point(other.vertex);
    if (is_upper(p) != is_upper(q)) return is_upper(p);
    return orientation(eye_, p, q) > 0;
  }

  // Of two in the same direction: the nearer one first.
  bool is_nearer(Vertex one, Vertex other) const {
    const Point p = surface_.point(one), q = surface_.point(other);
    if (p.x != q.x) return (p.x < q.x) == (p.x > eye_.x);
    return (p.y < q.y) == (p.y > eye_.y);
  }

 private:
  static constexpr double kRounding = 0x1p-46;  // of keys: far more than they have

  bool is_upper(Point p) const { return p.y > eye_.y || (p.y == eye_.y && p.x > eye_.x); }

  const Surface& surface_;
  Point eye_;
};

// Positions in the order of directions; vertices in one direction stand together, the nearest
// first, and share a slot, the position of their first. A sector has all vertices of its slots.
class Directions {
 public:
  static constexpr std::int32_t kNoSlot = -1;

  // Of vertices that are not at the eye. Check `team.is_stopped()` afterwards.
  Directions(const Surface& surface, Point eye, const std::vector<Vertex>& vertices, Team& team)
      : count_(static_cast<std::int32_t>(vertices.size())),
        order_(scratch_array<Vertex>(vertices.size())),
        slots_(scratch_array<std::int32_t>(static_cast<std::size_t>(surface.point_count))),
        positions_(scratch_array<std::int32_t>(static_cast<std::size_t>(surface.point_count))) {
    const DirectionOrder before(surface, eye);
    auto sorted = divide(before, vertices);
    std::atomic<std::size_t> next{0};
    team.run([&](int part) {
      for (std::size_t s; (s = next++) + 1 < sectors_.size() && team.keeps_going(part);) {
        sort_sector(before, sorted.get() + sectors_[s], sectors_[s], sectors_[s + 1]);
      }
    });
  }

  std::int32_t size() const { return count_; }
  Vertex vertex(std::int32_t position) const { return order_[position]; }
  std::int32_t slot(Vertex v) const { return slots_[number(v)]; }
  std::int32_t position(Vertex v) const { return positions_[number(v)]; }

  // Vertices are numbered by their positions from now on.
  void renumber() {
    auto slots = scratch_array<std::int32_t>(static_cast<std::size_t>(count_));
    for (std::int32_t at = 0; at < count_; ++at) slots[at] = slot(order_[at]);
    slots_ = std::move(slots);
    for (std::int32_t at = 0; at < count_; ++at) {
      order_[at] = Vertex{at};
      positions_[at] = at;
    }
  }

  // Positions at which sectors begin, and the end of the last one.
  const std::vector<std::int32_t>& sectors() const { return sectors_; }

 private:
  using Keyed = DirectionOrder::Keyed;
  static constexpr std::size_t kVerticesPerSector = 4096, kMostSectors = 256, kSamples = 16;

  // Into sectors of about the same size, by vertices taken as samples.
  ScratchArray<Keyed> divide(const DirectionOrder& before, const std::vector<Vertex>& vertices) {
    const std::size_t wanted =
        std::min(std::max(vertices.size() / kVerticesPerSector, std::size_t{1}), kMostSectors);
    const auto limits = choose_limits(before, vertices, wanted);
    std::vector<std::int32_t> begins(limits.size() + 2, 0);
    std::vector<std::uint16_t> own(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto at =
          std::upper_bound(limits.begin(), limits.end(), before.keyed(vertices[i]), before);
      own[i] = static_cast<std::uint16_t>(at - limits.begin());
      ++begins[own[i] + 1];
    }
    for (std::size_t s = 1; s < begins.size(); ++s) begins[s] += begins[s - 1];
    sectors_ = begins;
    sectors_.erase(std::unique(sectors_.begin(), sectors_.end()), sectors_.end());
    auto sorted = scratch_array<Keyed>(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      sorted[begins[own[i]]++] = before.keyed(vertices[i]);
    }
    return sorted;
  }

  static std::vector<Keyed> choose_limits(const DirectionOrder& before,
                                          const std::vector<Vertex>& vertices, std::size_t wanted) {
    std::vector<Keyed> samples, limits;
    if (wanted == 1) return limits;
    for (std::size_t i = 0; i < wanted * kSamples; ++i) {
      samples.push_back(before.keyed(vertices[i * vertices.size() / (wanted * kSamples)]));
    }
    std::sort(samples.begin(), samples.end(), before);
    for (std::size_t s = 1; s < wanted; ++s) limits.push_back(samples[s * kSamples]);
    return limits;
  }

  void sort_sector(const DirectionOrder& before, Keyed* sorted, std::int32_t begin,
                   std::int32_t end) {
    std::sort(sorted, sorted + (end - begin), before);
    for (std::int32_t i = begin, next = begin; i < end; i = next) {
      while (next < end && !before(sorted[i - begin], sorted[next - begin])) ++next;
      std::sort(sorted + (i - begin), sorted + (next - begin),
                [&](const Keyed& one, const Keyed& other) {
                  return before.is_nearer(one.vertex, other.vertex);
                });
      for (std::int32_t k = i; k < next; ++k) {
        const Vertex v = sorted[k - begin].vertex;
        order_[k] = v;
        slots_[number(v)] = i;
        positions_[number(v)] = k;
      }
    }
  }

  std::int32_t count_;
  ScratchArray<Vertex> order_;
  ScratchArray<std::int32_t> slots_, positions_;
  std::vector<std::int32_t> sectors_;
};

}  // namespace tinsmith::sight
