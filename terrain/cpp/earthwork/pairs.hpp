// The pairs of triangles of two surfaces whose boxes meet.
//
// One surface is taken block by block along Hilbert's curve; of the other those near the block are
// looked up once in a tree of boxes. Nothing is asked of the surfaces: they may be clipped, of
// several parts, or pieces.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "../../../tin/cpp/base/box.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/index/box_tree.hpp"
#include "../../../tin/cpp/index/hilbert_order.hpp"
#include "../pulse.hpp"
#include "facet.hpp"

namespace tinsmith::earthwork {

inline std::vector<std::int32_t> order_along_curve(const Triangles& triangles) {
  std::vector<Point> centers(triangles.count);
  for (std::int32_t t = 0; t < triangles.count; ++t) centers[t] = triangles.box_of(t).center();
  const HilbertOrder order(centers.data(), triangles.count);
  std::vector<std::int32_t> numbers(triangles.count);
  for (std::int32_t i = 0; i < triangles.count; ++i) numbers[i] = order[i];
  return numbers;
}

class Pairs {
 public:
  Pairs(const Triangles& first, const Triangles& second)
      : first_(first), first_order_(order_along_curve(first)) {
    const std::vector<std::int32_t> order = order_along_curve(second);
    items_.reserve(order.size());
    for (const std::int32_t t : order) items_.push_back({second.box_of(t), t});
    tree_ = BoxTree(second.count, [this](std::int32_t i) { return items_[i].box; });
  }

  // visit(part, triangle, other triangle) for every pair, on all threads of the team.
  template <typename Visit>
  void visit(Team& team, Visit&& visit) const {
    std::atomic<std::int64_t> next{0};
    team.run([&](int part) {
      std::vector<Item> near;
      Pulse pulse(team, part);  // a single triangle may meet all of the others
      while (team.keeps_going(part)) {
        const std::int64_t begin = next.fetch_add(kBlocksAtATime * kBlock);
        if (begin >= first_.count) return;
        const std::int64_t end = std::min<std::int64_t>(begin + kBlocksAtATime * kBlock, first_.count);
        for (std::int64_t at = begin; at < end; at += kBlock) {
          visit_block(at, std::min(at + kBlock, end), near,
                      [&](std::int32_t a, std::int32_t b) {
                        if (pulse.goes_on()) visit(part, a, b);
                      });
        }
      }
    });
  }

 private:
  static constexpr std::int64_t kBlock = 16;
  static constexpr std::int64_t kBlocksAtATime = 64;
  static constexpr double kScattered = 8.0;  // box of a block by those of its triangles

  struct Item {
    Box box;
    std::int32_t triangle;
  };

  template <typename Visit>
  void visit_block(std::int64_t begin, std::int64_t end, std::vector<Item>& near,
                   Visit&& visit) const {
    Box boxes[kBlock], all;
    double sum = 0.0;
    for (std::int64_t i = begin; i < end; ++i) {
      boxes[i - begin] = first_.box_of(first_order_[i]);
      all.include(boxes[i - begin]);
      sum += boxes[i - begin].width() * boxes[i - begin].height();
    }
    // A large triangle among small ones is looked up alone.
    const bool is_scattered = all.width() * all.height() > kScattered * sum;
    if (!is_scattered) gather(all, near);
    for (std::int64_t i = begin; i < end; ++i) {
      const Box& box = boxes[i - begin];
      if (is_scattered) gather(box, near);
      for (const Item& item : near) {
        if (item.box.meets(box)) visit(first_order_[i], item.triangle);
      }
    }
  }

  void gather(const Box& box, std::vector<Item>& near) const {
    near.clear();
    tree_.visit_leaves_if([&](const Box& outer, std::int64_t) { return outer.meets(box); },
                          [&](std::int32_t begin, std::int32_t end) {
                            for (std::int32_t i = begin; i < end; ++i) {
                              if (items_[i].box.meets(box)) near.push_back(items_[i]);
                            }
                            return false;
                          });
  }

  Triangles first_;
  std::vector<std::int32_t> first_order_;
  std::vector<Item> items_;  // of the second surface, along the curve
  BoxTree tree_;
};

}  // namespace tinsmith::earthwork
