// A machine that a test can break, for the runner: files, pipes, processes and a clock in this program's memory. Each
// process is a fiber. Processes take turns at what they ask of the machine, in an order that follows from a seed, and
// so do the faults. Time passes only here. Not simulated: a machine that loses its power (the runner promises nothing
// about that) and shared memory.
#pragma once

#include <csetjmp>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <ucontext.h>

#include "cases/runner/platform/platform.h"
#include "cases/runner/process_pool.h"

namespace rigor::test {

// splitmix64: the same numbers on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::uint64_t roll() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(roll() % count); }
  double unit() { return static_cast<double>(roll() >> 11) * 0x1p-53; }
  bool chance(double probability) { return probability > 0 && unit() < probability; }

 private:
  std::uint64_t state_;
};

// Of one attempt. Probabilities are for each request to the machine.
struct Faults {
  double turn = 0.25;           // that another process goes on (no fault)
  long kill_first_at = -1;      // requests until the first process is killed
  long interrupt_at = -1;       // requests until it gets SIGINT
  bool interrupts_all = false;  // and all others, too, as by a terminal
  double kill = 0;              // another process
  double pause = 0;             // one stops for up to 10 s
  double no_fork = 0;
  double clock_jump = 0;  // forwards, up to 10 s
  double io_error = 0;
  double short_write = 0, interrupted_call = 0;
  long space = -1;  // bytes left on the disk
  bool can_exchange = true, can_link = true;
  std::size_t pipe = 65536;  // bytes
};

struct FileNode {
  bool is_folder = false;
  std::string bytes = {};
  std::map<std::string, std::shared_ptr<FileNode>, std::less<>> names = {};
  ino_t inode = 0;
};

class SimulatedPlatform : public Platform {
 public:
  explicit SimulatedPlatform(std::uint64_t seed);
  ~SimulatedPlatform() override;

  // Runs these as the first processes, until there are no processes any more. Returns their statuses, as of waitpid.
  // Throws std::logic_error if none can ever go on.
  std::vector<int> run(const std::vector<std::function<void()>>& bodies, const Faults& faults);

  // What a fault has met since the last `run` began: a process or one above it, or all.
  bool is_hit(int process) const;
  bool is_anything_hit() const { return all_hit_ || !hit_.empty(); }
  int current() const;                         // the process that asks
  int first_above(int process) const;          // the one of `run` that it comes from
  long requests() const { return requests_; }  // of the last run
  int most_at_once(int level) const { return most_at_once_.contains(level) ? most_at_once_.at(level) : 0; }
  int level() const;  // of the process that asks: 0 the first, 1 its children, and so on
  bool lost_its_trajectories() const { return lost_folder_; }  // at some instant the watched folder was not there
  void watch_folder(const Path& path) {
    watched_folder_ = path.string(), lost_folder_ = false, had_folder_ = find(watched_folder_) != nullptr;
  }

  // Prints each request that changes something, and each fault.
  void tell() { is_told_ = true; }

  // What an engine may do.
  void breathe() { ask(); }    // another process may go on, and a fault may meet
  void spend(double seconds);  // CPU time
  void hang();
  void exit_now(int code);

  // Files as they are, without a request.
  std::shared_ptr<FileNode> find(std::string_view path) const;
  void put(const std::string& path, const std::string& bytes);

  int open(const Path& file, int flags) override;
  ssize_t read(int descriptor, char* bytes, std::size_t count) override;
  ssize_t write(int descriptor, const char* bytes, std::size_t count) override;
  int truncate(int descriptor, std::size_t size) override;
  void close(int descriptor) noexcept override;
  int lock(int descriptor) override;
  ino_t inode(int descriptor) override;
  ino_t inode(const Path& path) override;
  bool exchange(const Path& a, const Path& b) override;
  bool link(const Path& file, const Path& name) override;
  bool exists(const Path& path) noexcept override;
  bool is_file(const Path& path) override;
  bool is_folder(const Path& path) override;
  void make_folders(const Path& path) override;
  std::vector<Path> entries(const Path& folder) override;
  void rename(const Path& from, const Path& to) override;
  void copy(const Path& from, const Path& to) override;
  void remove(const Path& path) override;
  void remove_all(const Path& path) override;
  void try_to_remove(const Path& path) noexcept override;
  void try_to_remove_all(const Path& path) noexcept override;
  Child start(const std::function<void(const Channel&)>& work) override;
  bool do_unstopped(const std::function<void()>& work) override;
  std::optional<int> status_of_ended(pid_t child) noexcept override;
  int kill_and_wait(pid_t child) noexcept override;
  double cpu_seconds(pid_t child) override;
  void die_of(int signal) override;
  Time::time_point now() noexcept override;
  void sleep(std::chrono::milliseconds time) override;
  void wait_for_input(std::vector<pollfd>& watched, int ms) override;
  std::unique_ptr<SignalWatch> watch_signals() override;

 private:
  struct Process;
  struct Pipe;
  struct Opened;
  class Watch;
  struct Death {};  // leaves a process that was killed
  using NodePtr = std::shared_ptr<FileNode>;

  static void enter();
  void resume(Process& process);
  void leave();
  void be(Process& process);
  Process& create(int parent, bool is_detached, std::function<void(Process&)> body);
  Process* process_of(int number) const;
  bool can_go_on(const Process& process) const;
  bool has_input(int descriptor) const;
  void end(Process& process, int status);
  void bury();
  void let_faults_meet();
  bool ask_quietly() noexcept;
  void ask();
  void block(double seconds);
  bool io_fails();
  void interrupt(Process& process);
  Opened* opened(int descriptor) const;
  int add_opened(std::unique_ptr<Opened> file);
  void drop(Opened& file, int process);
  NodePtr folder_of(const Path& path, std::string& name) const;
  NodePtr make_node(const Path& path, bool is_folder);
  bool take_space(std::size_t bytes);
  bool remove_below(FileNode& folder, const std::string& name, bool is_quiet);
  bool remove_whole(const Path& path, bool is_quiet);
  bool remove_one(const Path& path, bool is_quiet);
  void copy_node(const NodePtr& from, const Path& to);
  void look_after_watched();
  void note(const char* what, const std::string& of = "") const;

  Dice dice_;
  Faults faults_;
  NodePtr root_ = std::make_shared<FileNode>();
  std::string watched_folder_;
  bool lost_folder_ = false, had_folder_ = false;
  ino_t last_inode_ = 1;
  double now_ = 0;  // s
  long requests_ = 0;
  int last_process_ = 0, last_descriptor_ = 2, first_ = 0;
  std::vector<std::unique_ptr<Process>> processes_;
  std::map<int, std::unique_ptr<Opened>> opened_;
  std::set<int> hit_;
  bool all_hit_ = false, is_told_ = false;
  std::map<int, int> parents_, most_at_once_;
  Process* current_ = nullptr;
  Process* next_ = nullptr;
  std::jmp_buf scheduler_;
};

}  // namespace rigor::test
