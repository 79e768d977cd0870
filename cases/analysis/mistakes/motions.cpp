#include "cases/analysis/mistakes/motions.h"

#include <fmt/format.h>
#include <sys/time.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <optional>

#include "adapters/faults/broken_engine.h"
#include "cases/runner/process_pool.h"
#include "cases/runner/simulate.h"

namespace rigor::inline analysis {
namespace {

void append_state(BodyColumns bodies, std::vector<double>& into) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Vec3 p = bodies.position(i), v = bodies.velocity(i), w = bodies.angular_velocity(i);
    const Mat3 R = matrix_of(bodies.orientation(i));
    into.insert(into.end(), p.data(), p.data() + 3);
    for (int k = 0; k < 9; ++k) into.push_back(R(k / 3, k % 3));
    into.insert(into.end(), v.data(), v.data() + 3), into.insert(into.end(), w.data(), w.data() + 3);
  }
}

// Ends this process after so much more CPU time [s].
void allow(double seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - std::floor(seconds)));
  setitimer(ITIMER_PROF, &timer, nullptr);
}

std::string why_it_ended(const JobEnd& end, double limit) {
  const bool is_late = end.how == Ending::killed && end.code == SIGPROF;
  return is_late ? fmt::format("it took more than {:g} s of CPU time", limit) : sentence_of(end, limit);
}

StateSeries simulated(const MotionTask& task) {
  std::optional<BrokenEngine> broken;
  if (task.fault) broken.emplace(*task.engine, *task.fault);
  const Engine& engine = broken ? *broken : *task.engine;
  StateSeries motion;
  try {
    const double duration = task.dt * static_cast<double>(task.steps);
    const Simulation run = simulate(engine, task.settings, *task.scene, task.dt, duration,
                                    {.steps_per_sample = task.every, .is_timed = false});
    for (const Sample& sample : run.trajectory.samples) append_state(sample.bodies.columns(), motion.states);
  } catch (const std::exception& error) {
    motion.why = error.what();
  }
  return motion;
}

// A task's index, whether it succeeded, and its states or the reason.
std::string message_of(std::size_t index, const StateSeries& motion) {
  const std::uint64_t number = index;
  std::string text(sizeof number, '\0');
  std::memcpy(text.data(), &number, sizeof number);
  text += motion.why.empty() ? 'm' : 'w';
  if (!motion.why.empty()) return text + motion.why;
  return text.append(reinterpret_cast<const char*>(motion.states.data()), motion.states.size() * sizeof(double));
}

std::size_t index_in(const std::string& message) {
  std::uint64_t number = 0;
  std::memcpy(&number, message.data(), sizeof number);
  return number;
}

StateSeries motion_in(const std::string& message) {
  constexpr std::size_t kHead = sizeof(std::uint64_t) + 1;
  StateSeries motion;
  if (message[kHead - 1] == 'w') {
    motion.why = message.substr(kHead);
  } else {
    motion.states.resize((message.size() - kHead) / sizeof(double));
    std::memcpy(motion.states.data(), message.data() + kHead, message.size() - kHead);
  }
  return motion;
}

using Chain = std::vector<std::size_t>;  // the tasks of one child, in order

std::vector<Chain> dealt(const Chain& tasks, int hands) {
  std::vector<Chain> chains(std::min<std::size_t>(std::max(hands, 1), std::max<std::size_t>(tasks.size(), 1)));
  for (std::size_t n = 0; n < tasks.size(); ++n) chains[n % chains.size()].push_back(tasks[n]);
  return chains;
}

}  // namespace

std::vector<StateSeries> simulate_motions(const std::vector<MotionTask>& tasks, const EngineTable& engines, int at_once,
                                          double limit, const std::function<void()>& on_motion) {
  constexpr int kMostDeaths = 4;  // an engine that dies of every task does not get the rest
  // s: the pool allows a multiple of this by the clock. Each run has its own timer of CPU time, and may wait for long
  // on a busy machine.
  constexpr double kLeastPatience = 10;
  const double patience = std::max(limit, kLeastPatience);
  int deaths = 0, answers = 0;
  std::vector<StateSeries> motions(tasks.size());
  Chain left(tasks.size());
  for (std::size_t n = 0; n < left.size(); ++n) left[n] = n;
  while (!left.empty()) {
    const std::vector<Chain> chains = dealt(left, at_once);
    std::vector<std::size_t> done(chains.size(), 0);
    std::vector<Job> jobs;
    for (const Chain& chain : chains) {
      jobs.push_back({[&](const Channel& channel) {
                        for (const std::size_t n : chain) {
                          allow(limit);
                          channel.send(message_of(n, simulated(tasks[n])));
                        }
                        engines.rest();
                      },
                      patience});
    }
    const auto on_message = [&](std::size_t job, const std::string& message) {
      motions[index_in(message)] = motion_in(message);
      ++done[job], ++answers;
      if (on_motion) on_motion();
    };
    const auto on_end = [&](std::size_t job, const JobEnd& end) {
      if (done[job] == chains[job].size()) return;
      motions[chains[job][done[job]++]].why =
          why_it_ended(end, end.how == Ending::timed_out ? patience : limit);  // the task in progress
      ++deaths;
    };
    run_jobs(jobs, at_once, on_message, on_end);
    left.clear();
    for (std::size_t job = 0; job < chains.size(); ++job)
      left.insert(left.end(), chains[job].begin() + static_cast<long>(done[job]), chains[job].end());
    if (deaths < kMostDeaths || deaths < answers) continue;
    for (const std::size_t n : left) motions[n].why = "not tried: the engine died of other tasks";
    left.clear();
  }
  return motions;
}

}  // namespace rigor::inline analysis
