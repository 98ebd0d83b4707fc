// How much work the searches did: counted, so that a regression shows without a clock.
#pragma once

#include <cstdint>

namespace tinsmith {

struct SearchCounts {
  std::int64_t searches = 0;         // third points found
  std::int64_t full_searches = 0;    // of these, over the whole index
  std::int64_t candidates = 0;       // points looked at, by both kinds of search
  std::int64_t full_candidates = 0;  // points looked at by full searches
  std::int64_t cell_rows = 0;        // rows of cells entered by full searches
  std::int64_t exact_decisions = 0;  // beyond the error bound
  std::int64_t walk_steps = 0;       // triangles walked through by insertion

  // What the full searches and the exact decisions cost, in units of one candidate: the rest
  // costs the same on all data.
  std::int64_t work() const { return full_candidates + cell_rows + 5 * exact_decisions; }

  SearchCounts& operator+=(const SearchCounts& other) {
    searches += other.searches;
    full_searches += other.full_searches;
    candidates += other.candidates;
    full_candidates += other.full_candidates;
    cell_rows += other.cell_rows;
    exact_decisions += other.exact_decisions;
    walk_steps += other.walk_steps;
    return *this;
  }
};

}  // namespace tinsmith
