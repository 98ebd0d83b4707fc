// Snapping: merge points that lie within a distance of each other, in an order of their own.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <set>
#include <utility>
#include <vector>

#include "../base/point.hpp"

namespace tinsmith {

// For each row the row that it is merged into (its own if kept).
//
// Points are taken in lexicographic order; one is kept if no point kept before lies within the
// distance, else it goes to the nearest of those. So kept points are pairwise further apart than
// the distance, no point moves by more, and the result does not depend on the order of the rows:
// of rows at one point, the first stands for the others.
inline std::vector<std::int32_t> snap_rows(const PointRows& rows, double distance) {
  std::vector<std::int32_t> order(rows.count);
  for (std::int64_t i = 0; i < rows.count; ++i) order[i] = static_cast<std::int32_t>(i);
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return lexicographically_before(rows[a], rows[b]);
  });
  std::vector<std::int32_t> kept_row(rows.count);
  std::set<std::pair<double, std::int32_t>> near;  // kept points in reach of the sweep, by y
  std::deque<std::int32_t> leaving;                // the same, by x
  for (const std::int32_t row : order) {
    const Point p = rows[row];
    while (!leaving.empty() && p.x - rows[leaving.front()].x > distance) {
      near.erase({rows[leaving.front()].y, leaving.front()});
      leaving.pop_front();
    }
    std::int32_t nearest = row;
    double least = distance;
    for (auto at = near.lower_bound({p.y - distance, INT32_MIN});
         at != near.end() && at->first <= p.y + distance; ++at) {
      const Point q = rows[at->second];
      const double apart = std::hypot(p.x - q.x, p.y - q.y);
      const bool is_nearer = apart < least || (apart == least && nearest == row);
      if (is_nearer) {
        nearest = at->second;
        least = apart;
      }
    }
    kept_row[row] = nearest;
    if (nearest == row) {
      near.insert({p.y, row});
      leaving.push_back(row);
    }
  }
  return kept_row;
}

}  // namespace tinsmith
