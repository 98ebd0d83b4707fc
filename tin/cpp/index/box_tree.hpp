// Tree of boxes over a sequence of items: which items may hold a point?
//
// A packed R-tree (Kamel and Faloutsos, "On packing R-trees", 1993).
//
// Level 0 has one box around every kItemsPerLeaf items in the order given; each level above has
// one box around every kFanOut boxes, up to a single one. The better the order keeps neighbours
// together, the fewer boxes hold a point.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../base/box.hpp"
#include "../base/range.hpp"

namespace tinsmith {

class BoxTree {
 public:
  static constexpr std::int32_t kItemsPerLeaf = 4;
  static constexpr std::int32_t kFanOut = 4;

  BoxTree() = default;

  // `box_of(i)` is the box of item i.
  template <typename BoxOf>
  BoxTree(std::int32_t item_count, BoxOf&& box_of) : item_count_(item_count) {
    lay_out_levels();
    for (std::int32_t leaf = 0; leaf < level_[1]; ++leaf) {
      Box box;
      for (std::int32_t i = first_item(leaf); i < first_item(leaf + 1); ++i) {
        box.include(box_of(i));
      }
      boxes_[leaf] = box;
    }
    for (std::size_t above = 1; above + 1 < level_.size(); ++above) {
      for (std::int32_t node = level_[above]; node < level_[above + 1]; ++node) {
        const auto [begin, end] = children(above, node);
        for (std::int32_t child = begin; child < end; ++child) boxes_[node].include(boxes_[child]);
      }
    }
  }

  // Call visit(first, last) for runs of items whose box holds p, until it returns true.
  template <typename Visit>
  void visit_leaves(Point p, Visit&& visit) const {
    visit_leaves_if([p](const Box& box, std::int64_t) { return box.holds(p); }, visit);
  }

  // The same for runs all boxes around which are wanted: wanted(box, end), where `end` comes after
  // the box's last item.
  template <typename Wanted, typename Visit>
  void visit_leaves_if(Wanted&& wanted, Visit&& visit) const {
    struct Node {
      std::int32_t level;
      std::int32_t box;
    };
    Node open[kFanOut * kMostLevels];
    std::int32_t count = 0;
    if (boxes_.empty() || !wanted(boxes_.back(), item_count_)) return;
    open[count++] = {static_cast<std::int32_t>(level_.size()) - 2, level_.back() - 1};
    while (count > 0) {
      const Node node = open[--count];
      if (node.level == 0) {
        if (visit(first_item(node.box), first_item(node.box + 1))) return;
        continue;
      }
      const auto [begin, end] = children(node.level, node.box);
      const std::int32_t below = node.level - 1;
      for (std::int32_t child = begin; child < end; ++child) {
        open[count] = {below, child};
        count += wanted(boxes_[child], end_item(below, child));
      }
    }
  }

 private:
  static constexpr std::int32_t kMostLevels = 17;  // 4^16 leaves and the root

  std::int32_t first_item(std::int32_t leaf) const {
    return static_cast<std::int32_t>(
        std::min<std::int64_t>(std::int64_t{kItemsPerLeaf} * leaf, item_count_));
  }

  // May lie beyond the last item.
  std::int64_t end_item(std::int32_t level, std::int32_t node) const {
    static_assert(kItemsPerLeaf == 4 && kFanOut == 4, "a level is a factor of four");
    return std::int64_t{node - level_[level] + 1} << (2 * (level + 1));
  }

  Range children(std::size_t level, std::int32_t node) const {
    const std::int32_t begin = level_[level - 1] + kFanOut * (node - level_[level]);
    return {begin, std::min(begin + kFanOut, level_[level])};
  }

  void lay_out_levels() {
    std::int32_t size = item_count_ / kItemsPerLeaf + (item_count_ % kItemsPerLeaf != 0);
    level_ = {0, size};
    while (size > 1) {
      size = size / kFanOut + (size % kFanOut != 0);
      level_.push_back(level_.back() + size);
    }
    boxes_.resize(level_.back());
  }

  std::int32_t item_count_ = 0;
  std::vector<std::int32_t> level_;  // where the boxes of each level begin, and the end
  std::vector<Box> boxes_;
};

}  // namespace tinsmith
