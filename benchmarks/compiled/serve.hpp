// What the harnesses share: files of doubles in, triangles out, orders from stdin.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

// Appends the pairs of a file of T, each as Made(first, second).
template <typename T, typename Made>
bool read_pairs(const char* path, std::vector<Made>& made) {
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) return false;
  T pair[2];
  while (std::fread(pair, sizeof(T), 2, file) == 2) made.push_back(Made{pair[0], pair[1]});
  std::fclose(file);
  return true;
}

// Appends the pairs of 64-bit point numbers of a file, each as Made{start, end} of 32 bits.
template <typename Made>
bool read_segments(const char* path, std::vector<Made>& made) {
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  if (!read_pairs<std::int64_t>(path, pairs)) return false;
  for (const auto& [start, end] : pairs) {
    made.push_back(Made{static_cast<std::uint32_t>(start), static_cast<std::uint32_t>(end)});
  }
  return true;
}

// Writes the corners of every triangle, six doubles each.
template <typename Triangulation>
bool save(const Triangulation& triangulation, const char* path) {
  std::FILE* file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  for (const auto& face : triangulation.finite_face_handles()) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto& point = face->vertex(corner)->point();
      const double xy[2] = {point.x(), point.y()};
      std::fwrite(xy, sizeof(double), 2, file);
    }
  }
  return std::fclose(file) == 0;
}

template <typename Work>
double seconds_of(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  const auto end = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(end - begin).count();
}

// Says "ready" and obeys stdin until it ends:
//
//   run K       calls seconds_to_run(triangulation) K times, each time on what `renew` makes of
//               the triangulation; answers one line of JSON: mean seconds, number of triangles
//   save PATH   writes the last triangles
template <typename Triangulation, typename Renew, typename Run>
void serve(Triangulation& kept, Renew&& renew, Run&& seconds_to_run) {
  std::printf("{\"ready\": true}\n");
  std::fflush(stdout);
  std::string line;
  while (std::getline(std::cin, line)) {
    if (line.rfind("run ", 0) == 0) {
      const int count = std::atoi(line.c_str() + 4);
      double total = 0;
      for (int i = 0; i < count; ++i) {
        renew(kept);
        total += seconds_to_run(kept);
      }
      std::printf("{\"seconds\": %.9f, \"triangles\": %zu}\n", total / count,
                  static_cast<std::size_t>(kept.number_of_faces()));
    } else if (line.rfind("save ", 0) == 0) {
      std::printf("{\"saved\": %s}\n", save(kept, line.c_str() + 5) ? "true" : "false");
    }
    std::fflush(stdout);
  }
}
