// Segments in spatial order under a tree of boxes (index/box_tree.hpp): which pairs come near each
// other?
//
// Groups of neighbours ask the tree together. The cost follows the number of pairs whose boxes
// overlap: few for segments not much longer than they are apart, all for long slanting parallels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../base/arrays.hpp"
#include "../index/box_tree.hpp"
#include "../index/hilbert_order.hpp"
#include "segments.hpp"

namespace tinsmith {

class SegmentBoxes {
 public:
  struct Item {
    Point end[2];
    Vertex vertex[2];
    Segment segment;
  };

  SegmentBoxes(const Segments& segments, double reach)
      : count_(segments.count),
        reach_(reach),
        items_(scratch_array<Item>(count_)),
        boxes_(scratch_array<Box>(count_)) {
    const HilbertOrder order(count_,
                             [&](std::int32_t i) { return segments.box_of(Segment{i}).center(); });
    for (std::int32_t i = 0; i < count_; ++i) {
      const Segment segment{order[i]};
      items_[i] = {{segments.point(segment, 0), segments.point(segment, 1)},
                   {segments.end(segment, 0), segments.end(segment, 1)},
                   segment};
      boxes_[i] = segments.box_of(segment);
    }
    tree_ = BoxTree(count_, [&](std::int32_t i) { return boxes_[i]; });
  }

  // visit(part, item, other) once for every pair of which at least one segment is `first_new` or
  // later and whose boxes come within reach, by the team's parts.
  template <typename Visit>
  void visit_pairs(Segment first_new, Team& team, Visit&& visit) const {
    const std::int32_t group_count = count_ / kGroup + (count_ % kGroup != 0);
    visit_in_blocks(group_count, team, [&](int part, std::int32_t group) {
      visit_group({kGroup * group, std::min(kGroup * group + kGroup, count_)}, first_new,
                  [&](const Item& item, const Item& other) { visit(part, item, other); });
    });
  }

 private:
  static constexpr std::int32_t kGroup = 8;

  // The new segments of a group, their boxes grown by the reach.
  struct Askers {
    std::int32_t item[kGroup];
    Box box[kGroup];
    std::int32_t count = 0;
    Box around;
  };

  Askers askers(Range group, Segment first_new) const {
    Askers result;
    for (std::int32_t i = group.begin; i < group.end; ++i) {
      if (items_[i].segment < first_new) continue;
      result.item[result.count] = i;
      result.box[result.count] = boxes_[i].grown_by(Band::kRoom * reach_);
      result.around.include(result.box[result.count++]);
    }
    return result;
  }

  // Of two new segments the one that comes first in the tree asks.
  template <typename Visit>
  void visit_group(Range group, Segment first_new, Visit&& visit) const {
    const Askers asking = askers(group, first_new);
    if (asking.count == 0) return;
    const std::int32_t from = first_new == Segment{0} ? group.begin : 0;
    const auto wanted = [&](const Box& box, std::int64_t end) {
      return end > from && asking.around.meets(box);
    };
    tree_.visit_leaves_if(wanted, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = std::max(begin, from); i < end; ++i) {
        if (!asking.around.meets(boxes_[i])) continue;
        const std::int32_t limit = items_[i].segment >= first_new ? i : count_;
        for (std::int32_t k = 0; k < asking.count && asking.item[k] < limit; ++k) {
          if (asking.box[k].meets(boxes_[i])) visit(items_[asking.item[k]], items_[i]);
        }
      }
      return false;
    });
  }

  std::int32_t count_;
  double reach_;
  ScratchArray<Item> items_;
  ScratchArray<Box> boxes_;
  BoxTree tree_;
};

}  // namespace tinsmith
