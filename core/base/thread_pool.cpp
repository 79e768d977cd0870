#include "core/base/thread_pool.h"

namespace rigor {
namespace {

void pause() {
#ifdef __x86_64__
  __builtin_ia32_pause();
#endif
}

// Polls for some hundred microseconds before it sleeps. It soon yields, because the awaited thread may need this core.
void wait_while(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  constexpr int kLooks = 10000, kLooksAlone = 1000;
  for (int k = 0; k < kLooks; ++k) {
    if (value.load(std::memory_order_acquire) != old) return;
    k < kLooksAlone ? pause() : std::this_thread::yield();
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

ThreadPool::ThreadPool(int members) {
  for (int k = 1; k < members; ++k) helpers_.emplace_back([this, k] { help(static_cast<std::size_t>(k)); });
}

ThreadPool::~ThreadPool() {
  task_ = nullptr;
  begin();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadPool::run(const std::function<void(std::size_t)>& task) {
  task_ = &task;
  const auto all_ended = static_cast<std::uint32_t>(helpers_.size()) * begin();
  task(0);
  for (std::uint32_t ended = ended_; ended != all_ended; ended = ended_) wait_while(ended_, ended);
}

void ThreadPool::meet() {
  if (helpers_.empty()) return;
  const std::uint32_t meetings = meetings_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 < members()) return wait_while(meetings_, meetings);
  arrived_.store(0, std::memory_order_relaxed);
  meetings_.fetch_add(1, std::memory_order_release);
  meetings_.notify_all();
}

std::uint32_t ThreadPool::begin() {
  const std::uint32_t task = begun_.fetch_add(1, std::memory_order_release) + 1;
  begun_.notify_all();
  return task;
}

void ThreadPool::help(std::size_t member) {
  for (std::uint32_t seen = 0;; ++seen) {
    wait_while(begun_, seen);
    if (!task_) return;
    (*task_)(member);
    ended_.fetch_add(1, std::memory_order_release);
    ended_.notify_one();
  }
}

}  // namespace rigor
