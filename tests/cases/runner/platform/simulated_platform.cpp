// A simulated machine's processes as fibers, the faults that they meet, and the order in which they go on.
#include "tests/cases/runner/platform/simulated_platform.h"

#include <pthread.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <utility>

#include <cxxabi.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif

#include "tests/cases/runner/platform/simulated_process.h"

namespace rigor::test {
namespace {

constexpr double kRequest = 2e-5;          // s that each takes
constexpr std::size_t kStack = 512 << 10;  // bytes: the pool's buffer takes 64 k, a cell's metrics less
constexpr long kMostRequests = 300'000;    // of a run; an undisturbed one takes about a thousand

// Kept for the next process.
std::vector<char*>& free_stacks() {
  static std::vector<char*> stacks;
  return stacks;
}

char* take_stack() {
  if (!free_stacks().empty()) {
    char* stack = free_stacks().back();
    free_stacks().pop_back();
    return stack;
  }
  void* memory = mmap(nullptr, kStack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  mprotect(memory, 4096, PROT_NONE);
  return static_cast<char*>(memory);
}

void swap_handled(Handled& kept) {
  auto* now = reinterpret_cast<Handled*>(abi::__cxa_get_globals());
  std::swap(*now, kept);
}

SimulatedPlatform* running = nullptr;

}  // namespace

SimulatedPlatform::SimulatedPlatform(std::uint64_t seed) : dice_(seed) { root_->is_folder = true, root_->inode = 1; }
SimulatedPlatform::~SimulatedPlatform() = default;

// Fibers.

void SimulatedPlatform::enter() {
  SimulatedPlatform& self = *running;
#if defined(__SANITIZE_ADDRESS__)
  __sanitizer_finish_switch_fiber(nullptr, nullptr, nullptr);
#endif
  self.be(*self.current_);
  self.current_->is_done = true;
  self.leave();
}

__attribute__((noinline)) void SimulatedPlatform::resume(Process& process) {
  current_ = &process;
  swap_handled(process.handled);
#if defined(__SANITIZE_ADDRESS__)
  void* fake = nullptr;
  __sanitizer_start_switch_fiber(&fake, process.stack, kStack);
#endif
  if (_setjmp(scheduler_) == 0) {
    if (process.is_started) _longjmp(process.at, 1);
    process.is_started = true;
    setcontext(&process.first);
  }
#if defined(__SANITIZE_ADDRESS__)
  __sanitizer_finish_switch_fiber(fake, nullptr, nullptr);
#endif
  Process& left = *current_;
  current_ = nullptr;
  swap_handled(left.handled);
  if (left.is_done) {
    if (!left.is_dead) end(left, left.status);
    free_stacks().push_back(std::exchange(left.stack, nullptr));
  }
}

__attribute__((noinline)) void SimulatedPlatform::leave() {
#if defined(__SANITIZE_ADDRESS__)
  void* fake = nullptr;
  // No size is needed to go back: the scheduler has the thread's own stack, which is known from the first switch.
  const void* bottom = nullptr;
  std::size_t size = 0;
  static thread_local const void* thread_bottom = nullptr;
  static thread_local std::size_t thread_size = 0;
  if (!thread_bottom) {
    pthread_attr_t attributes;
    pthread_getattr_np(pthread_self(), &attributes);
    void* found = nullptr;
    pthread_attr_getstack(&attributes, &found, &thread_size);
    pthread_attr_destroy(&attributes);
    thread_bottom = found;
  }
  bottom = thread_bottom, size = thread_size;
  __sanitizer_start_switch_fiber(current_->is_done ? nullptr : &fake, bottom, size);
#endif
  if (_setjmp(current_->at) == 0) _longjmp(scheduler_, 1);
#if defined(__SANITIZE_ADDRESS__)
  __sanitizer_finish_switch_fiber(fake, nullptr, nullptr);
#endif
}

void SimulatedPlatform::be(Process& process) {
  try {
    process.body(process);
  } catch (const Death&) {
  } catch (...) {
    process.status = status_of_exit(1);
  }
}

SimulatedPlatform::Process& SimulatedPlatform::create(int parent, bool is_detached,
                                                      std::function<void(Process&)> body) {
  auto process = std::make_unique<Process>();
  Process& made = *process;
  note("starts", std::to_string(last_process_ + 1));
  made.number = ++last_process_, made.parent = parent, made.is_detached = is_detached;
  made.body = std::move(body);
  made.stack = take_stack();
  getcontext(&made.first);
  made.first.uc_stack.ss_sp = made.stack, made.first.uc_stack.ss_size = kStack;
  made.first.uc_link = nullptr;
  makecontext(&made.first, enter, 0);
  parents_[made.number] = parent;
  if (const Process* above = process_of(parent)) made.level = above->level + 1;
  for (const auto& [number, file] : opened_) {
    if (std::find(file->owners.begin(), file->owners.end(), parent) != file->owners.end())
      file->owners.push_back(made.number);
  }
  processes_.push_back(std::move(process));
  int living = 0;
  for (const auto& each : processes_) living += !each->is_dead && !each->is_detached && each->level == made.level;
  most_at_once_[made.level] = std::max(most_at_once_[made.level], living);
  return made;
}

SimulatedPlatform::Process* SimulatedPlatform::process_of(int number) const {
  for (const auto& process : processes_) {
    if (process->number == number) return process.get();
  }
  return nullptr;
}

bool SimulatedPlatform::has_input(int descriptor) const {
  const Opened* file = opened(descriptor);
  return !file || !file->pipe || !file->pipe->bytes.empty() || file->pipe->writers == 0;
}

bool SimulatedPlatform::can_go_on(const Process& process) const {
  if (process.is_dead || process.is_done) return false;
  if (process.wakes_at <= now_) return true;
  if (process.awaits != 0) {
    const Process* awaited = process_of(process.awaits);
    return !awaited || awaited->is_dead;
  }
  if (process.buries != 0) return process_of(process.buries)->is_done;
  if (process.full) return process.full->bytes.size() < faults_.pipe || process.full->readers == 0;
  if (process.caught != 0 && !process.inputs.empty()) return true;
  return std::any_of(process.inputs.begin(), process.inputs.end(), [&](int input) { return has_input(input); });
}

// As the kernel ends a process: its files are closed, its children die, a little later or at once.
void SimulatedPlatform::end(Process& process, int status) {
  if (process.is_dead) return;
  process.is_dead = true, process.status = status;
  note("ends", std::to_string(process.number) + " with status " + std::to_string(status));
  std::vector<int> descriptors;
  for (const auto& [number, file] : opened_) descriptors.push_back(number);
  for (const int descriptor : descriptors) drop(*opened_.at(descriptor), process.number);
  std::erase_if(opened_, [](const auto& one) { return one.second->owners.empty(); });
  for (const auto& child : processes_) {
    if (child->parent != process.number || child->is_detached || child->is_dead) continue;
    child->requests_left = dice_.chance(0.25) ? static_cast<int>(1 + dice_.below(3)) : 0;
    if (child->requests_left == 0 || !can_go_on(*child)) end(*child, kKilled);
  }
}

// Leaves the functions of the dead, of children before their parents, whose data they may look at.
void SimulatedPlatform::bury() {
  for (bool is_again = true; is_again;) {
    is_again = false;
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      Process& process = *processes_[i];
      if (!process.is_dead || process.is_done) continue;
      const bool has_children = std::any_of(processes_.begin(), processes_.end(), [&](const auto& child) {
        return child->parent == process.number && !child->is_done;
      });
      if (has_children) continue;
      process.is_dying = true;
      if (process.is_started)
        resume(process);
      else
        process.is_done = true, free_stacks().push_back(std::exchange(process.stack, nullptr));
      is_again = true;
    }
  }
}

std::vector<int> SimulatedPlatform::run(const std::vector<std::function<void()>>& bodies, const Faults& faults) {
  running = this;
  const PlatformInPlace in_place(*this);
  faults_ = faults, requests_ = 0, hit_.clear(), all_hit_ = false, most_at_once_.clear(), parents_.clear();
  processes_.clear(), opened_.clear();
  first_ = last_process_ + 1;
  for (const auto& body : bodies) create(0, false, [&body](Process&) { body(); });
  std::string stuck;
  for (;;) {
    bury();
    std::vector<Process*> able;
    double soonest = kForever;
    bool is_over = true;
    for (const auto& process : processes_) {
      is_over &= process->is_done;
      if (process->is_dead || process->is_done) continue;
      if (can_go_on(*process))
        able.push_back(process.get());
      else if (process->requests_left >= 0)
        end(*process, kKilled);
      else
        soonest = std::min(soonest, process->wakes_at);
    }
    if (is_over) break;
    if (requests_ > kMostRequests) stuck = "the processes go on for ever";
    if (able.empty() && std::any_of(processes_.begin(), processes_.end(),
                                    [](const auto& each) { return each->is_dead && !each->is_done; }))
      continue;
    if (able.empty() && soonest == kForever) stuck = "no process can go on";
    if (!stuck.empty()) {
      for (const auto& process : processes_) {
        if (!process->is_dead && !process->is_done) end(*process, kKilled);
      }
      bury();
      throw std::logic_error(stuck);
    }
    if (able.empty()) {
      now_ = soonest;
      continue;
    }
    Process* chosen = able[dice_.below(able.size())];
    if (next_ && std::find(able.begin(), able.end(), next_) != able.end()) chosen = next_;
    next_ = nullptr;
    resume(*chosen);
  }
  std::vector<int> statuses;
  for (std::size_t i = 0; i < bodies.size(); ++i) statuses.push_back(processes_[i]->status);
  running = nullptr;
  return statuses;
}

// Requests and faults.

bool SimulatedPlatform::is_hit(int process) const {
  if (all_hit_) return true;
  while (process > 0) {
    if (hit_.contains(process)) return true;
    const auto parent = parents_.find(process);
    process = parent == parents_.end() ? 0 : parent->second;
  }
  return false;
}

int SimulatedPlatform::current() const { return current_ ? current_->number : 0; }
int SimulatedPlatform::first_above(int process) const {
  for (int parent = process; parent > 0;) {
    process = parent;
    const auto found = parents_.find(process);
    parent = found == parents_.end() ? 0 : found->second;
  }
  return process;
}
void SimulatedPlatform::note(const char* what, const std::string& of) const {
  if (is_told_) std::printf("%10.6f s, request %ld, process %d: %s %s\n", now_, requests_, current(), what, of.c_str());
}

int SimulatedPlatform::level() const { return current_->level; }

void SimulatedPlatform::interrupt(Process& process) {
  if (process.is_dead || process.is_detached) return;
  hit_.insert(process.number);
  if (process.watches > 0 && process.caught == 0)
    process.caught = SIGINT;
  else
    end(process, SIGINT);
}

void SimulatedPlatform::let_faults_meet() {
  Process* first = process_of(first_);
  if (requests_ == faults_.kill_first_at && first && !first->is_dead) {
    hit_.insert(first_);
    end(*first, kKilled);
  }
  if (requests_ == faults_.interrupt_at && first) {
    interrupt(*first);
    for (std::size_t i = 0; faults_.interrupts_all && i < processes_.size(); ++i) {
      if (processes_[i]->number != first_) interrupt(*processes_[i]);
    }
  }
  const auto another = [&]() -> Process* {
    std::vector<Process*> others;
    for (const auto& process : processes_) {
      if (process->level > 0 && !process->is_dead && !process->is_done) others.push_back(process.get());
    }
    return others.empty() ? nullptr : others[dice_.below(others.size())];
  };
  if (dice_.chance(faults_.kill)) {
    if (Process* process = another()) hit_.insert(process->number), end(*process, kKilled);
  }
  if (dice_.chance(faults_.pause)) {
    Process* process = dice_.chance(0.2) ? first : another();
    const bool waits_for_an_end =
        process && (process->awaits != 0 || process->buries != 0 || (process->wakes_at == kForever && !process->full));
    if (process && !process->is_dead && !process->is_detached && !waits_for_an_end) {
      hit_.insert(process->number);
      if (process == first) all_hit_ = true;  // it finds all others late
      const double until = now_ + std::pow(10., 5 * dice_.unit() - 4);
      process->wakes_at = std::max(process->wakes_at == kForever ? 0 : process->wakes_at, until);
      process->inputs.clear(), process->awaits = 0, process->full = nullptr;
    }
  }
  if (dice_.chance(faults_.clock_jump)) now_ += std::pow(10., 5 * dice_.unit() - 4), all_hit_ = true;
}

// False if the process that asks is dead: nothing happens any more.
bool SimulatedPlatform::ask_quietly() noexcept {
  Process& self = *current_;
  if (self.is_dying) return false;
  ++requests_, now_ += kRequest;
  if (self.requests_left == 0) end(self, kKilled);
  if (self.requests_left > 0) --self.requests_left;
  let_faults_meet();
  if (self.is_dead || self.wakes_at > now_ || dice_.chance(faults_.turn)) leave();
  return !self.is_dying;
}

void SimulatedPlatform::ask() {
  if (!ask_quietly()) throw Death();
}

// The caller has set what else ends it.
void SimulatedPlatform::block(double seconds) {
  Process& self = *current_;
  self.wakes_at = now_ + seconds;
  if (!self.is_dead && !can_go_on(self)) leave();
  self.wakes_at = 0, self.inputs.clear(), self.awaits = 0, self.full = nullptr;
  if (self.is_dying) throw Death();
}

bool SimulatedPlatform::io_fails() {
  if (!dice_.chance(faults_.io_error)) return false;
  note("has an error of the disk");
  hit_.insert(current_->number), all_hit_ = true;  // a file may be several processes'
  return true;
}

void SimulatedPlatform::spend(double seconds) {
  ask();
  Process& self = *current_;
  self.spends_from = now_;
  block(seconds);
  self.used += seconds, self.spends_from = -1;
}

void SimulatedPlatform::hang() {
  ask();
  block(kForever);
}

void SimulatedPlatform::exit_now(int code) {
  ask();
  end(*current_, status_of_exit(code));
  leave();
  throw Death();
}

void SimulatedPlatform::die_of(int signal) {
  ask();
  end(*current_, signal);
  leave();
  throw Death();
}

}  // namespace rigor::test
