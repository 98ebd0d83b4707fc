// Which points lie in polygons, by the even-odd rule over all rings together?
//
// The crossing test of Shimrat, "Algorithm 112: position of point relative to polygon" (1962), for
// many points at once.
//
// The ray east from a point crosses the rings an odd number of times if the point is inside. Rings
// are cut into chains of edges, halves of halves. For a group of points, a chain
//   - above, below or west of the group's box counts nothing;
//   - east of it counts for a point if its two ends lie on different sides of the point's northing,
//     whatever its edges do in between, and for no point if it is a whole ring;
//   - else it must be looked into: its halves are asked.
// Groups are halved at the median, and every half keeps only the chains that are not settled for
// all of it. So points far from every edge are settled by thousands.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "segments.hpp"

namespace tinsmith {

class PointInPolygon {
 public:
  // Ring i has the corners offsets[i] .. offsets[i + 1] - 1, the last one joined to the first.
  PointInPolygon(const Point* corners, const std::int32_t* offsets, std::int32_t ring_count) {
    for (std::int32_t ring = 0; ring < ring_count; ++ring) {
      add_ring(corners + offsets[ring], offsets[ring + 1] - offsets[ring]);
    }
  }

  // +1 inside, 0 on a ring, -1 outside; incomplete if the team was stopped.
  void locate(const Point* queries, std::int32_t count, std::int8_t* result, Team& team) const {
    auto items = scratch_array<Item>(count);
    for (std::int32_t i = 0; i < count; ++i) items[i] = {queries[i], i};
    std::vector<Group> groups{{items.get(), items.get() + count, {roots_, false}}};
    // Halves of the largest groups until every thread has some to fetch.
    const std::size_t wanted = team.size() == 1 ? 1 : kGroupsPerThread * team.size();
    for (std::size_t i = 0; i < groups.size() && groups.size() < wanted; ++i) {
      settle(groups[i]);
      if (groups[i].size() <= kSmallGroup) continue;
      groups.push_back(split_off_half(groups[i]));
      groups.push_back(std::move(groups[i]));
      groups[i] = {nullptr, nullptr, {{}, false}};
    }
    std::atomic<std::size_t> next{0};
    team.run([&](int part) {
      for (std::size_t i; (i = next.fetch_add(1)) < groups.size();) {
        answer(std::move(groups[i]), result, team, part);
      }
    });
  }

 private:
  static constexpr std::int64_t kSmallGroup = 16;
  static constexpr std::int64_t kBetweenQuestions = 4096;  // points
  static constexpr std::int32_t kEdgesPerChain = 4;        // of the shortest chains
  static constexpr std::size_t kGroupsPerThread = 16;

  struct Item {
    Point point;
    std::int32_t row;
  };

  // Consecutive edges of a ring: corners[0] to corners[edge_count], or round the whole ring.
  struct Chain {
    Box box;
    std::int32_t first_corner;
    std::int32_t edge_count;
    std::int32_t halves;  // the chain of the first half, the other one behind; 0 if it has none
    double start_y, end_y;
  };

  // Chains that are not settled for a group, and whether an odd number of crossings is.
  struct Open {
    std::vector<std::int32_t> chains;
    bool is_odd;
  };

  struct Group {
    Item* begin;
    Item* end;
    Open open;
    std::int64_t size() const { return end - begin; }
  };

  // ------------------------------------------------------------------ chains

  void add_ring(const Point* corners, std::int32_t count) {
    if (count == 0) return;
    const auto first = static_cast<std::int32_t>(corners_.size());
    corners_.insert(corners_.end(), corners, corners + count);
    corners_.push_back(corners[0]);
    roots_.push_back(static_cast<std::int32_t>(chains_.size()));
    chains_.push_back(chain_of(first, count));
    for (std::size_t i = roots_.back(); i < chains_.size(); ++i) {
      const Chain chain = chains_[i];
      if (chain.edge_count <= kEdgesPerChain) continue;
      const std::int32_t half = chain.edge_count / 2;
      chains_[i].halves = static_cast<std::int32_t>(chains_.size());
      chains_.push_back(chain_of(chain.first_corner, half));
      chains_.push_back(chain_of(chain.first_corner + half, chain.edge_count - half));
    }
    // Halves come behind the whole.
    for (std::size_t i = chains_.size(); i-- > static_cast<std::size_t>(roots_.back());) {
      Chain& chain = chains_[i];
      if (chain.halves == 0) {
        for (std::int32_t k = 0; k <= chain.edge_count; ++k) {
          chain.box.include(corners_[chain.first_corner + k]);
        }
      } else {
        for (int k = 0; k < 2; ++k) chain.box.include(chains_[chain.halves + k].box);
      }
    }
  }

  Chain chain_of(std::int32_t first_corner, std::int32_t edge_count) const {
    return {Box(),
            first_corner,
            edge_count,
            0,
            corners_[first_corner].y,
            corners_[first_corner + edge_count].y};
  }

  // ------------------------------------------------------------------ groups

  static Box box_of(const Group& group) {
    Box box;
    for (const Item* item = group.begin; item != group.end; ++item) box.include(item->point);
    return box;
  }

  // Then it is looked into at once: larger chains would stay open for many groups.
  static bool is_larger(const Chain& chain, const Box& box, std::int64_t query_count) {
    return chain.edge_count >= query_count || chain.box.width() > box.width() ||
           chain.box.height() > box.height();
  }

  // Settle what can be for the whole group.
  void settle(Group& group) const {
    const Box box = box_of(group);
    std::vector<std::int32_t> chains = std::move(group.open.chains);
    group.open.chains.clear();
    while (!chains.empty()) {
      const std::int32_t number = chains.back();
      chains.pop_back();
      const Chain& chain = chains_[number];
      if (chain.box.north < box.south || chain.box.south > box.north || chain.box.east < box.west) {
        continue;
      }
      if (chain.box.west > box.east) {
        settle_eastern(chain, number, box, group.open);
      } else if (chain.halves != 0 && is_larger(chain, box, group.size())) {
        chains.push_back(chain.halves);
        chains.push_back(chain.halves + 1);
      } else {
        group.open.chains.push_back(number);
      }
    }
  }

  // East of the box, the ends' northings count: the same for all points, or left open.
  static void settle_eastern(const Chain& chain, std::int32_t number, const Box& box, Open& open) {
    if (chain.start_y == chain.end_y) return;
    const double low = std::min(chain.start_y, chain.end_y);
    const double high = std::max(chain.start_y, chain.end_y);
    if (high <= box.south || low > box.north) return;
    if (low <= box.south && high > box.north) {
      open.is_odd = !open.is_odd;
    } else {
      open.chains.push_back(number);
    }
  }

  // Takes the upper half of the points, by the box's longer side.
  static Group split_off_half(Group& group) {
    const Box box = box_of(group);
    Item* const middle = group.begin + group.size() / 2;
    if (box.width() > box.height()) {
      std::nth_element(group.begin, middle, group.end,
                       [](const Item& a, const Item& b) { return a.point.x < b.point.x; });
    } else {
      std::nth_element(group.begin, middle, group.end,
                       [](const Item& a, const Item& b) { return a.point.y < b.point.y; });
    }
    return {middle, std::exchange(group.end, middle), group.open};
  }

  // Halving ends after 31 times; groups that wait are few.
  void answer(Group whole, std::int8_t* result, Team& team, int part) const {
    std::vector<Group> waiting;
    waiting.push_back(std::move(whole));
    std::int64_t since_question = 0;
    while (!waiting.empty()) {
      Group group = std::move(waiting.back());
      waiting.pop_back();
      settle(group);
      if (group.open.chains.empty()) {
        const std::int8_t side = group.open.is_odd ? 1 : -1;
        for (const Item* item = group.begin; item != group.end; ++item) result[item->row] = side;
      } else if (group.size() <= kSmallGroup) {
        for (const Item* item = group.begin; item != group.end; ++item) {
          result[item->row] = side_of(item->point, group.open);
        }
      } else {
        waiting.push_back(split_off_half(group));
        waiting.push_back(std::move(group));
        continue;
      }
      since_question += group.size();
      if (since_question < kBetweenQuestions) continue;
      since_question = 0;
      if (!team.keeps_going(part)) return;
    }
  }

  // ------------------------------------------------------------------ one point

  std::int8_t side_of(Point p, const Open& open) const {
    bool is_odd = open.is_odd;
    for (const std::int32_t number : open.chains) {
      if (!count_crossings(p, number, is_odd)) return 0;
    }
    return is_odd ? 1 : -1;
  }

  // False if p lies on the chain. Waiting chains: one for each halving of 2^31 edges.
  bool count_crossings(Point p, std::int32_t whole, bool& is_odd) const {
    std::int32_t waiting[32];
    std::int32_t count = 0;
    waiting[count++] = whole;
    while (count > 0) {
      const Chain& chain = chains_[waiting[--count]];
      if (chain.box.north < p.y || chain.box.south > p.y || chain.box.east < p.x) continue;
      if (chain.box.west > p.x) {
        is_odd ^= (chain.start_y <= p.y) != (chain.end_y <= p.y);
      } else if (chain.halves != 0) {
        waiting[count++] = chain.halves;
        waiting[count++] = chain.halves + 1;
      } else {
        for (std::int32_t k = 0; k < chain.edge_count; ++k) {
          const Point* edge = corners_.data() + chain.first_corner + k;
          if (!count_crossing(p, edge[0], edge[1], is_odd)) return false;
        }
      }
    }
    return true;
  }

  // False if p lies on a-b.
  static bool count_crossing(Point p, Point a, Point b, bool& is_odd) {
    const Box box = Box::of(a, b);
    if (box.north < p.y || box.south > p.y || box.east < p.x) return true;
    const bool straddles = (a.y <= p.y) != (b.y <= p.y);
    if (box.west > p.x) {
      is_odd ^= straddles;
      return true;
    }
    const int side = a.y < b.y ? orientation(a, b, p) : orientation(b, a, p);
    if (side == 0) return false;  // on the line and in the box
    is_odd ^= straddles && side > 0;
    return true;
  }

  std::vector<Point> corners_;  // of each ring, the first one again at the end
  std::vector<Chain> chains_;
  std::vector<std::int32_t> roots_;
};

}  // namespace tinsmith
