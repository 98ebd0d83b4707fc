// The pairs of triangles of two surfaces whose boxes meet: a spatial join.
//
// One surface is taken block by block along Hilbert's curve; of the other those near the block are
// looked up once in a tree of boxes. Nothing is asked of the surfaces: they may be clipped, of
// several parts, or pieces. If it is known that the triangles of the second do not overlap, then one
// that is also in the first meets no other, and two versions of a survey are joined triangle by
// triangle.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "../../../tin/cpp/base/box.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/index/box_tree.hpp"
#include "../../../tin/cpp/location/ordered_surface.hpp"
#include "equal_triangles.hpp"
#include "facet.hpp"

namespace tinsmith::earthwork {

class Pairs {
 public:
  Pairs(const Surface& first, const Surface& second, bool is_second_apart)
      : first_(without_neighbors(first)),
        second_(without_neighbors(second)),
        tree_(static_cast<std::int32_t>(second.triangle_count),
              [this](std::int32_t i) { return box_of(second_, i); }) {
    if (is_second_apart) equal_.emplace(second_);
  }

  // visit(part, triangle, other triangle) for every pair, on all threads of the team.
  template <typename Visit>
  void visit(Team& team, Visit&& visit) const {
    std::atomic<std::int64_t> next{0};
    const std::int64_t count = first_.surface().triangle_count;
    team.expect(count);
    team.run([&](int part) {
      std::vector<Item> near;
      Pulse pulse(team, part);  // a single triangle may meet all of the others
      while (team.keeps_going(part)) {
        const std::int64_t begin = next.fetch_add(kBlocksAtATime * kBlock);
        if (begin >= count) return;
        const std::int64_t end = std::min<std::int64_t>(begin + kBlocksAtATime * kBlock, count);
        for (std::int64_t at = begin; at < end; at += kBlock) {
          visit_block(at, std::min(at + kBlock, end), near, [&](const Facet& a, const Facet& b) {
            if (pulse.goes_on()) visit(part, a, b);
          });
        }
        team.advance(end - begin);
      }
    });
  }

 private:
  static constexpr std::int64_t kBlock = 16;
  static constexpr std::int64_t kBlocksAtATime = 64;
  static constexpr double kScattered = 8.0;  // box of a block by those of its triangles

  struct Item {
    Box box;
    Facet facet;
  };

  static OrderedSurface without_neighbors(Surface surface) {
    surface.neighbors = nullptr;
    return OrderedSurface(surface);
  }
  static Box box_of(const OrderedSurface& copy, std::int64_t i) {
    return copy.surface().box_of(triangle_numbered(i));
  }

  template <typename Visit>
  void visit_block(std::int64_t begin, std::int64_t end, std::vector<Item>& near,
                   Visit&& visit) const {
    Box boxes[kBlock], all;
    Triangle equal[kBlock];
    double sum = 0.0;
    for (std::int64_t i = begin; i < end; ++i) {
      equal[i - begin] = find_equal(i);
      if (equal[i - begin] != kNoTriangle) continue;
      boxes[i - begin] = box_of(first_, i);
      all.include(boxes[i - begin]);
      sum += boxes[i - begin].width() * boxes[i - begin].height();
    }
    // A large triangle among small ones is looked up alone.
    const bool is_scattered = all.width() * all.height() > kScattered * sum;
    if (!is_scattered) gather(all, near);
    for (std::int64_t i = begin; i < end; ++i) {
      if (equal[i - begin] != kNoTriangle) {
        visit(Facet::of(first_, triangle_numbered(i)), Facet::of(second_, equal[i - begin]));
        continue;
      }
      const Box& box = boxes[i - begin];
      if (is_scattered) gather(box, near);
      if (near.empty()) continue;
      const Facet facet = Facet::of(first_, triangle_numbered(i));
      for (const Item& item : near) {
        if (item.box.meets(box)) visit(facet, item.facet);
      }
    }
  }

  Triangle find_equal(std::int64_t i) const {
    if (!equal_) return kNoTriangle;
    return equal_->find(Facet::of(first_.surface(), triangle_numbered(i)));
  }

  void gather(const Box& box, std::vector<Item>& near) const {
    near.clear();
    tree_.visit_leaves_if([&](const Box& outer, std::int64_t) { return outer.meets(box); },
                          [&](std::int32_t begin, std::int32_t end) {
                            for (std::int32_t i = begin; i < end; ++i) {
                              const Box own = box_of(second_, i);
                              if (own.meets(box))
                                near.push_back({own, Facet::of(second_, triangle_numbered(i))});
                            }
                            return false;
                          });
  }

  OrderedSurface first_, second_;
  BoxTree tree_;                         // of the second
  std::optional<EqualTriangles> equal_;  // in the second
};

}  // namespace tinsmith::earthwork
