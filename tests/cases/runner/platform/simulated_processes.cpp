// How the runner starts, ends and waits for a simulated machine's processes.
#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "cases/runner/process_pool.h"
#include "tests/cases/runner/platform/simulated_platform.h"
#include "tests/cases/runner/platform/simulated_process.h"

namespace rigor::test {

class SimulatedPlatform::Watch : public SignalWatch {
 public:
  explicit Watch(Process& process) : process_(process) { ++process.watches, process.caught = 0; }
  ~Watch() override { --process_.watches; }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  int caught() const override { return process_.caught; }

 private:
  Process& process_;
};

Platform::Child SimulatedPlatform::start(const std::function<void(const Channel&)>& work) {
  ask();
  if (dice_.chance(faults_.no_fork)) {
    hit_.insert(current_->number);
    throw std::system_error(EAGAIN, std::generic_category(), "starting a child process");
  }
  int ends[2][2];
  std::vector<Opened*> readers, writers;
  for (auto& pair : ends) {
    const auto pipe = std::make_shared<Pipe>();
    for (const bool is_reader : {true, false}) {
      auto file = std::make_unique<Opened>();
      file->pipe = pipe, file->is_reader = is_reader;
      (is_reader ? readers : writers).push_back(file.get());
      pair[is_reader ? 0 : 1] = add_opened(std::move(file));
    }
  }
  const int messages = ends[0][1], words = ends[1][1];
  Process& child = create(current_->number, false, [work, messages, words, this](Process& self) {
    try {
      work(Channel(messages));
    } catch (const std::exception& error) {
      const std::string said = error.what();
      write(words, said.data(), said.size());
      self.status = status_of_exit(1);
    }
  });
  for (Opened* reader : readers) reader->owners = {current_->number};
  for (Opened* writer : writers) writer->owners = {child.number};
  next_ = &child;
  const Platform::Child made{child.number, ends[0][0], ends[1][0]};
  leave();  // the child looks first at what it has of its parent
  if (current_->is_dying) throw Death();
  return made;
}

bool SimulatedPlatform::do_unstopped(const std::function<void()>& work) {
  ask();
  if (dice_.chance(faults_.no_fork)) return false;
  Process& child = create(current_->number, true, [work](Process& self) {
    try {
      work();
    } catch (const std::exception&) {
      self.status = status_of_exit(1);
    }
  });
  const int number = child.number;
  current_->awaits = number;
  block(kForever);
  return process_of(number)->status == 0;
}

std::optional<int> SimulatedPlatform::status_of_ended(pid_t child) noexcept {
  if (!ask_quietly()) return {};
  const Process* process = process_of(child);
  // Not before it is no more, since what it has of this process it looks at until then.
  if (process->is_done) return process->status;
  return {};
}

int SimulatedPlatform::kill_and_wait(pid_t child) noexcept {
  if (!ask_quietly()) return 0;
  Process &self = *current_, &process = *process_of(child);
  end(process, kKilled);
  // What it has of this process it looks at until it is no more.
  self.buries = child, self.wakes_at = kForever;
  if (!process.is_done) leave();
  self.buries = 0, self.wakes_at = 0;
  return process.status;
}

double SimulatedPlatform::cpu_seconds(pid_t child) {
  const Process& process = *process_of(child);
  return process.used + (process.spends_from < 0 ? 0 : now_ - process.spends_from);
}

Platform::Time::time_point SimulatedPlatform::now() noexcept {
  return Time::time_point(std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(now_)));
}

void SimulatedPlatform::sleep(std::chrono::milliseconds time) {
  ask();
  block(1e-3 * static_cast<double>(time.count()));
}

void SimulatedPlatform::wait_for_input(std::vector<pollfd>& watched, int ms) {
  ask();
  current_->inputs.clear();
  for (const pollfd& one : watched) current_->inputs.push_back(one.fd);
  block(1e-3 * ms);
}

std::unique_ptr<SignalWatch> SimulatedPlatform::watch_signals() { return std::make_unique<Watch>(*current_); }

}  // namespace rigor::test
