// What the programs here share: faults are counted and told; "sound" is printed if there are none.
#pragma once

#include <cstdio>
#include <string>

namespace {

int faults = 0;

void expect(bool holds, const std::string& what) {
  if (holds) return;
  std::printf("not so: %s\n", what.c_str());
  ++faults;
}

bool keep_going() { return true; }

int tell_faults() {
  if (faults == 0) std::puts("sound");
  return faults == 0 ? 0 : 1;
}

}  // namespace
