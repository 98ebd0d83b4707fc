// The lock of Python's interpreter, let go and taken so that threads may be inside when it exits.
//
// Python up to 3.13 ends a daemon thread that takes the lock while the interpreter exits by
// pthread_exit, whose unwinding must not pass destructors and functions of nanobind that throw
// nothing: the process would abort. Such a thread waits for the end of the process instead, as
// Python does itself from 3.14 on.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <thread>

#ifdef __GLIBCXX__
#include <cxxabi.h>
#endif

namespace tinsmith::python {

// Calls what takes the lock; never returns if the thread was to end there. The unwinding brings no
// object, which UBSan reports as a reference to null.
template <typename Take>
#ifdef __GLIBCXX__
__attribute__((no_sanitize("null")))
#endif
auto take_lock(Take take) noexcept {
#ifdef __GLIBCXX__
  try {
    return take();
  } catch (abi::__forced_unwind&) {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }
#else
  return take();
#endif
}

// Lets go of the lock while it lives.
class ReleasedLock {
 public:
  ReleasedLock() : state_(PyEval_SaveThread()) {}
  ~ReleasedLock() {
    take_lock([this] {
      PyEval_RestoreThread(state_);
      return true;
    });
  }
  ReleasedLock(const ReleasedLock&) = delete;
  ReleasedLock& operator=(const ReleasedLock&) = delete;

 private:
  PyThreadState* state_;
};

// Holds the lock while it lives, in a thread that has let go of it.
class HeldLock {
 public:
  HeldLock() : state_(take_lock([] { return PyGILState_Ensure(); })) {}
  ~HeldLock() { PyGILState_Release(state_); }
  HeldLock(const HeldLock&) = delete;
  HeldLock& operator=(const HeldLock&) = delete;

 private:
  PyGILState_STATE state_;
};

}  // namespace tinsmith::python
