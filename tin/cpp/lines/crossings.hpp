// Which segments cross?
//
// Two segments cross where their open interiors have exactly one place in common and neither holds
// an end of the other. Segments that share an end, touch or overlap along a line do not cross.
//
// A tree of boxes over the segments is asked for what each segment's line cuts: the cost follows
// the number of boxes that do, which for segments not much longer than their distances is about
// the number of segments.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../index/spatial_order.hpp"
#include "segments.hpp"

namespace tinsmith {

inline bool do_cross(Point a, Point b, Point c, Point d) {
  return orientation(a, b, c) * orientation(a, b, d) < 0 &&
         orientation(c, d, a) * orientation(c, d, b) < 0;
}

// Pairs i < j with j >= first_new, sorted; incomplete if the team was stopped.
class CrossingSearch {
 public:
  CrossingSearch(const Segments& segments, std::int32_t first_new)
      : first_new_(first_new), items_(items_of(segments)) {
    tree_ = BoxTree(segments.count, [&](std::int32_t i) { return items_[i].box(); });
  }

  std::vector<NumberPair> run(Team& team) const {
    std::vector<std::vector<NumberPair>> found(team.size());
    visit_in_blocks(static_cast<std::int32_t>(items_.size()), team,
                    [&](int part, std::int32_t i) { search(i, found[part]); });
    return sorted_together(found);
  }

 private:
  struct Item {
    Point a, b;
    std::int32_t segment;

    Rectangle box() const {
      Rectangle box;
      box.include(a);
      box.include(b);
      return box;
    }
  };

  static std::vector<Item> items_of(const Segments& segments) {
    const SpatialOrder order(segments.count,
                             [&](std::int32_t i) { return segments.box_of(i).center(); });
    std::vector<Item> items(segments.count);
    for (std::int32_t i = 0; i < segments.count; ++i) {
      const std::int32_t segment = order[i];
      items[i] = {segments.place(segment, 0), segments.place(segment, 1), segment};
    }
    return items;
  }

  // Only new segments ask; of two new ones the earlier item does.
  void search(std::int32_t asking, std::vector<NumberPair>& found) const {
    const Item& item = items_[asking];
    if (item.segment < first_new_) return;
    const std::int32_t from = first_new_ == 0 ? asking + 1 : 0;
    const Rectangle box = item.box();
    const Band band(item.a, item.b, 0.0);
    const auto wanted = [&](const Rectangle& other, std::int64_t end) {
      return end > from && band.meets(other);
    };
    tree_.visit_leaves_if(wanted, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = std::max(begin, from); i < end; ++i) {
        const Item& other = items_[i];
        if (other.segment >= first_new_ && i <= asking) continue;
        if (!box.meets(other.box()) || !do_cross(item.a, item.b, other.a, other.b)) continue;
        found.push_back({std::min(item.segment, other.segment),
                         std::max(item.segment, other.segment)});
      }
      return false;
    });
  }

  std::int32_t first_new_;
  std::vector<Item> items_;  // in spatial order
  BoxTree tree_;
};

}  // namespace tinsmith
