// Threads that do the same work on different bodies. No member reads what another writes, so the distribution of work
// changes no bit of the result. Between two tasks the threads stay awake for about one step. Waking a thread takes
// longer than many tasks, and puts it on the core of the waking thread while others are busy.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace rigor {

class ThreadPool {
 public:
  explicit ThreadPool(int members);  // of which the thread that calls is one
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  std::size_t members() const { return helpers_.size() + 1; }
  // Calls task(member) in each member's thread; returns when all have done.
  void run(const std::function<void(std::size_t member)>& task);
  // A member's share of so many rows, in the order of the members; begins at a multiple of `whole`.
  struct Share {
    std::size_t first, last;
  };
  Share share(std::size_t rows, std::size_t member, std::size_t whole = 1) const {
    const auto begin = [&](std::size_t k) { return k == members() ? rows : rows / whole * k / members() * whole; };
    return {begin(member), begin(member + 1)};
  }
  // For tasks that every member takes part in: returns when all members have come here.
  void meet();

 private:
  std::uint32_t begin();  // returns how many tasks there have been
  void help(std::size_t member);

  std::atomic<std::uint32_t> begun_ = 0, ended_ = 0;        // tasks; completed shares of the helpers
  std::atomic<std::uint32_t> arrived_ = 0, meetings_ = 0;   // members at the meeting that is on; meetings so far
  const std::function<void(std::size_t)>* task_ = nullptr;  // null: the members are to end
  std::vector<std::thread> helpers_;
};

}  // namespace rigor
