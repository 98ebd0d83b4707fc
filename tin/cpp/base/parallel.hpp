// Work shared by threads: the caller's thread does part 0 and alone asks whether to go on.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "progress.hpp"
#include "range.hpp"

namespace tinsmith {

// What one thread writes often must not lie on a line that another one uses.
constexpr std::size_t kCacheLine = 64;

class Team {
 public:
  // `ask` says whether to go on; it is only ever called on the thread that made the team.
  // What is done is added to `progress`, if there is one.
  Team(int size, std::function<bool()> ask, Progress* progress = nullptr)
      : size_(std::max(size, 1)), ask_(std::move(ask)), progress_(progress) {}

  int size() const { return size_; }

  // Whether the work of a part should go on: cheap for all parts but the caller's.
  bool keeps_going(int part) {
    if (part == 0 && !is_stopped_ && !ask_()) is_stopped_ = true;
    return !is_stopped_;
  }
  bool is_stopped() const { return is_stopped_; }

  // Of the work's steps, for who is told how far it is.
  void expect(std::int64_t steps) {
    if (progress_ != nullptr) progress_->expect(steps);
  }
  void advance(std::int64_t steps) {
    if (progress_ != nullptr) progress_->advance(steps);
  }

  // work(part) for every part at the same time; throws again what a part threw.
  template <typename Work>
  void run(const Work& work) {
    std::vector<std::exception_ptr> faults(size_);
    const auto guarded = [&](int part) {
      try {
        work(part);
      } catch (...) {
        faults[part] = std::current_exception();
      }
    };
    std::vector<std::thread> threads;
    int not_started = size_;
    running_ = 0;
    for (int part = 1; part < size_; ++part) {
      if (!start(threads, guarded, part)) {
        not_started = part;
        break;
      }
    }
    guarded(0);
    for (int part = not_started; part < size_; ++part) guarded(part);
    wait();
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& fault : faults) {
      if (fault) std::rethrow_exception(fault);
    }
  }

 private:
  static constexpr std::chrono::milliseconds kBetweenQuestions{50};

  // False where the system has no thread to give: then the caller does the part itself.
  template <typename Guarded>
  bool start(std::vector<std::thread>& threads, const Guarded& guarded, int part) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++running_;
    }
    try {
      threads.emplace_back([this, &guarded, part] {
        guarded(part);
        const std::lock_guard<std::mutex> lock(mutex_);
        --running_;
        ended_.notify_one();
      });
      return true;
    } catch (const std::system_error&) {
      const std::lock_guard<std::mutex> lock(mutex_);
      --running_;
      return false;
    }
  }

  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ended_.wait_for(lock, kBetweenQuestions, [this] { return running_ == 0; })) {
      lock.unlock();
      keeps_going(0);
      lock.lock();
    }
  }

  int size_;
  std::function<bool()> ask_;
  Progress* progress_;
  std::atomic<bool> is_stopped_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  int running_ = 0;
};

}  // namespace tinsmith
