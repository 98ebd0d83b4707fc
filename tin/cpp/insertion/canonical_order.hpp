// Canonical order: triangles numbered as the growth would have made them.
//
// A triangle belongs to its first vertex in the sweep and begins with it; those of one vertex are
// ordered as in star_order.hpp.
//
// Triangles are dealt out to their owners by counting, in the order of the mesh, and put in order
// within each owner, two or three at a time, where they lie. No walk about a vertex is needed.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../growth/triangle_store.hpp"
#include "../index/grid.hpp"
#include "../predicates/predicates.hpp"
#include "ghost_mesh.hpp"
#include "star_order.hpp"

namespace tinsmith {

// Triangles closed by ghosts, with the positions of their corners in the sweep.
class SweptTriangles {
 public:
  // All must outlive this.
  SweptTriangles(const GhostTriangle* triangles, std::uint32_t count)
      : triangles_(triangles), count_(count) {}

  std::uint32_t count() const { return count_; }
  HalfEdge twin(std::int64_t t, std::uint32_t corner) const { return triangles_[t].twin[corner]; }
  const GhostTriangle& operator[](std::int64_t t) const { return triangles_[t]; }

 private:
  const GhostTriangle* triangles_;
  std::uint32_t count_;
};

// The same where corners are vertices and triangles may be free, which is as if they were of ghosts
// alone: `sweep_of` by vertex, the ghost's in front.
class SweptMesh {
 public:
  SweptMesh(const GhostTriangle* triangles, std::uint32_t count, const Vertex* sweep_of)
      : triangles_(triangles), count_(count), sweep_of_(sweep_of) {}

  std::uint32_t count() const { return count_; }
  HalfEdge twin(std::int64_t t, std::uint32_t corner) const { return triangles_[t].twin[corner]; }
  struct Corners {
    Vertex corner[3];
  };
  Corners operator[](std::int64_t t) const {
    const auto& c = triangles_[t].corner;
    if (c[0] == kFree) return {{kGhost, kGhost, kGhost}};
    return {{sweep_of_[number(c[0])], sweep_of_[number(c[1])], sweep_of_[number(c[2])]}};
  }

 private:
  const GhostTriangle* triangles_;
  std::uint32_t count_;
  const Vertex* sweep_of_;
};

// Points in the order of the sweep, where they are not stored in it.
class PointsInSweep {
 public:
  // By vertex, and the vertices in the order of the sweep. Both must outlive this.
  PointsInSweep(const Point* points, const std::vector<Vertex>& sweep)
      : points_(points), sweep_(sweep) {}

  std::int32_t count() const { return static_cast<std::int32_t>(sweep_.size()); }
  Point point(Vertex v) const { return points_[number(sweep_[number(v)])]; }

 private:
  const Point* points_;
  const std::vector<Vertex>& sweep_;
};

// `Points` is a PointGrid or PointsInSweep, `Mesh` SweptTriangles or a SweptMesh.
template <typename Points, typename Mesh>
class CanonicalOrder {
 public:
  // All must outlive the order.
  CanonicalOrder(const Points& points, const Mesh& mesh, Team& team)
      : points_(points),
        team_(team),
        mesh_(mesh),
        number_of_(scratch_array<Triangle>(mesh.count())),
        end_of_(points.count() + std::size_t{1}) {}

  // Find how many triangles there are without ghosts. Returns false if the team is stopped.
  bool count() {
    if (!in_blocks(mesh_.count(), is_shared() ? &CanonicalOrder::count_owned<true>
                                              : &CanonicalOrder::count_owned<false>)) {
      return false;
    }
    begins_from_counts();
    return true;
  }
  std::int64_t triangles() const { return triangles_; }

  // `out` has room for all triangles. Returns false if the team is stopped.
  bool write(Triangles out) {
    return write(out, [](std::int64_t, std::uint32_t, std::size_t) {});
  }

  // The same; write_more(t, first, entry) is called for every triangle of the mesh, with the corner
  // that comes first and where it stands in `out`.
  template <typename WriteMore>
  bool write(Triangles out, WriteMore&& write_more) {
    corners_ = out.corners;
    neighbors_ = out.neighbors;
    return in_blocks(mesh_.count(),
                     is_shared() ? &CanonicalOrder::deal<true> : &CanonicalOrder::deal<false>) &&
           in_blocks(points_.count(), &CanonicalOrder::order_stars) &&
           in_blocks(mesh_.count(), [&](std::int64_t begin, std::int64_t end) {
             write_neighbors(begin, end, write_more);
           });
  }

 private:
  bool is_shared() const { return team_.size() > 1; }

  bool in_blocks(std::int64_t count, void (CanonicalOrder::*work)(std::int64_t, std::int64_t)) {
    return in_blocks(count,
                     [&](std::int64_t begin, std::int64_t end) { (this->*work)(begin, end); });
  }

  template <typename Work>
  bool in_blocks(std::int64_t count, const Work& work) {
    constexpr std::int64_t kBlock = 65536;  // a few milliseconds
    std::atomic<std::int64_t> next{0};
    team_.run([&](int member) {
      while (team_.keeps_going(member)) {
        const std::int64_t begin = next.fetch_add(kBlock);
        if (begin >= count) return;
        work(begin, std::min(begin + kBlock, count));
      }
    });
    return !team_.is_stopped();
  }

  // What a count was before one is added. Threads may come to those of one owner at a time.
  template <bool kIsShared>
  static std::int32_t add_one(std::atomic<std::int32_t>& count) {
    constexpr auto kRelaxed = std::memory_order_relaxed;
    if (kIsShared) return count.fetch_add(1, kRelaxed);
    const std::int32_t before = count.load(kRelaxed);
    count.store(before + 1, kRelaxed);
    return before;
  }

  // Corner of the first vertex of the sweep, or of the ghost.
  static std::uint32_t first_corner(const Vertex (&corner)[3]) {
    const bool is_second = corner[1] < corner[0];
    return corner[2] < corner[is_second] ? 2 : is_second;
  }

  // One entry on from its owner, so that the ghost's are counted in front.
  template <bool kIsShared>
  void count_owned(std::int64_t begin, std::int64_t end) {
    for (std::int64_t t = begin; t < end; ++t) {
      const auto& triangle = mesh_[t];
      const auto& corner = triangle.corner;
      add_one<kIsShared>(end_of_[number(std::min({corner[0], corner[1], corner[2]})) + 1]);
    }
  }

  // Dealing out turns the begins into ends.
  void begins_from_counts() {
    end_of_[0] = 0;
    std::int32_t total = 0;
    for (std::atomic<std::int32_t>& end : end_of_) {
      const std::int32_t size = end;
      end = total;
      total += size;
    }
    triangles_ = total;
  }

  template <bool kIsShared>
  void deal(std::int64_t begin, std::int64_t end) {
    for (std::int64_t t = begin; t < end; ++t) {
      const auto& triangle = mesh_[t];
      const std::uint32_t first = first_corner(triangle.corner);
      const Vertex owner = triangle.corner[first];
      if (owner == kGhost) {
        number_of_[t] = kNoTriangle;
        continue;
      }
      const std::int32_t at = add_one<kIsShared>(end_of_[number(owner) + 1]);
      std::int32_t* const corner = corners_ + std::int64_t{3} * at;
      corner[0] = number(owner);
      corner[1] = number(triangle.corner[corner_after(first)]);
      corner[2] = number(triangle.corner[corner_before(first)]);
      neighbors_[at] = static_cast<std::int32_t>(t);  // for the time being
    }
  }

  void order_stars(std::int64_t first, std::int64_t end) {
    StarOrder star;
    std::int32_t begin = end_of_[first];  // the end of the vertex before
    for (std::int64_t v = first; v < end; ++v) {
      const std::int32_t after = end_of_[v + 1];
      const std::int32_t owned = after - begin;
      if (owned == 1) {
        number_of_[neighbors_[begin]] = triangle_numbered(begin);
      } else if (owned == 2) {
        order_two(begin);
      } else if (owned > 2) {
        order_star(static_cast<Vertex>(v), begin, after, star);
      }
      begin = after;
    }
  }

  // In one sector, or each in its own: two triangles are no whole star.
  void order_two(std::int32_t begin) {
    std::int32_t* const corner = corners_ + std::int64_t{3} * begin;
    const std::int32_t from = corner[1], to = corner[2];
    const std::int32_t other_from = corner[4], other_to = corner[5];
    const bool is_swapped = other_to == from || (to != other_from && other_from < from);
    corner[1] = is_swapped ? other_from : from;
    corner[2] = is_swapped ? other_to : to;
    corner[4] = is_swapped ? from : other_from;
    corner[5] = is_swapped ? to : other_to;
    number_of_[neighbors_[begin]] = triangle_numbered(begin + is_swapped);
    number_of_[neighbors_[begin + 1]] = triangle_numbered(begin + !is_swapped);
  }

  void order_star(Vertex v, std::int32_t begin, std::int32_t end, StarOrder& star) {
    star.clear();
    for (std::int32_t i = begin; i < end; ++i) {
      const std::int32_t* const corner = corners_ + std::int64_t{3} * i;
      star.add({Vertex{corner[1]}, Vertex{corner[2]}, neighbors_[i]});
    }
    star.put_in_order([this, v](Vertex a, Vertex b) {
      return compare_distances(points_.point(v), points_.point(a), points_.point(b));
    });
    for (const StarOrder::Ray& ray : star) {
      std::int32_t* const corner = corners_ + std::int64_t{3} * begin;
      corner[1] = number(ray.from);
      corner[2] = number(ray.to);
      number_of_[ray.triangle] = triangle_numbered(begin++);
    }
  }

  template <typename WriteMore>
  void write_neighbors(std::int64_t begin, std::int64_t end, WriteMore&& write_more) {
    const Triangle* const number_of = number_of_.get();
    for (std::int64_t t = begin; t < end; ++t) {
      if (number_of[t] == kNoTriangle) continue;
      const std::uint32_t first = first_corner(mesh_[t].corner);
      const auto beyond = [&](std::uint32_t corner) {
        return index_of(number_of[number(triangle_of(mesh_.twin(t, corner)))]);
      };
      const std::size_t entry = entry_of(number_of[t], 0);
      neighbors_[entry] = beyond(first);
      neighbors_[entry + 1] = beyond(corner_after(first));
      neighbors_[entry + 2] = beyond(corner_before(first));
      write_more(t, first, entry);
    }
  }

  const Points& points_;
  Team& team_;
  Mesh mesh_;
  ScratchArray<Triangle> number_of_;  // of each triangle of the mesh; kNoTriangle of ghosts
  std::vector<std::atomic<std::int32_t>> end_of_;  // of an owner's triangles, the ghost's in front
  std::int64_t triangles_ = 0;
  std::int32_t* corners_ = nullptr;
  std::int32_t* neighbors_ = nullptr;
};

}  // namespace tinsmith
