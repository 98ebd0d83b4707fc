// What drains through each edge along which water runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"

namespace tinsmith::hydrology {

struct Channel {
  Vertex start, end;
  double area;
};

// By upper end, then lower end; the areas of each are added in the order of the nodes. Nodes without
// an upper end, -1, run along no edge.
class ChannelSums {
 public:
  ChannelSums(const std::int32_t* uppers, const std::int32_t* nexts, std::int32_t node_count,
              std::int32_t first_vertex, std::int32_t vertex_count)
      : nexts_(nexts),
        first_vertex_(first_vertex),
        begin_(scratch_array<std::int32_t>(std::size_t(vertex_count) + 1)) {
    std::fill_n(begin_.get(), std::size_t(vertex_count) + 1, 0);
    for (std::int32_t i = 0; i < node_count; ++i) {
      if (uppers[i] >= 0) ++begin_[uppers[i]];
    }
    std::int32_t total = 0;
    for (std::int32_t v = 0; v <= vertex_count; ++v) begin_[v] = total += begin_[v];
    nodes_ = scratch_array<std::int32_t>(total);
    for (std::int32_t i = node_count; i-- > 0;) {
      if (uppers[i] >= 0) nodes_[--begin_[uppers[i]]] = i;
    }
  }

  std::vector<Channel> sum(const double* totals, std::int32_t vertex_count) const {
    std::vector<Channel> found;
    for (const Vertex v : Ids<Vertex>(vertex_count)) {
      std::int32_t* const first = nodes_.get() + begin_[number(v)];
      std::int32_t* const last = nodes_.get() + begin_[number(v) + 1];
      std::sort(first, last, [&](std::int32_t one, std::int32_t other) {
        return std::make_pair(nexts_[one], one) < std::make_pair(nexts_[other], other);
      });
      for (const std::int32_t* node = first; node != last; ++node) {
        const bool is_new = node == first || nexts_[*node] != nexts_[node[-1]];
        if (is_new) found.push_back({v, Vertex{nexts_[*node] - first_vertex_}, 0.0});
        found.back().area += totals[*node];
      }
    }
    return found;
  }

 private:
  const std::int32_t* nexts_;
  std::int32_t first_vertex_;
  ScratchArray<std::int32_t> begin_;  // of the nodes of each upper end
  ScratchArray<std::int32_t> nodes_;
};

}  // namespace tinsmith::hydrology
