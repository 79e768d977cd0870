#include "cases/runner/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>
#include <set>

#include "cases/case/recording/recording_reader.h"
#include "cases/case/selection.h"
#include "cases/results/result_json.h"
#include "cases/runner/build_identity.h"
#include "cases/runner/case_process.h"
#include "cases/runner/shards/shard.h"
#include "cases/runner/stable_step.h"
#include "core/base/error.h"

namespace rigor::inline runner {
namespace {

void check_steps(const Case& definition, const StepSize& dt) {
  constexpr double kMostSteps = 1e9;  // hours of computing; and far from where a step count overflows
  const double steps = definition.duration / dt.seconds;
  if (dt.seconds > definition.duration * (1 + 1e-9)) {
    throw InputError(
        fmt::format("{}: a step of {} s is longer than the run of {:g} s; dt has to be at most the duration",
                    definition.id, dt.text, definition.duration));
  }
  if (!(steps <= kMostSteps)) {
    throw InputError(fmt::format("{}: steps of {} s would be {:.3g} of them in {:g} s; at most {:g} are allowed",
                                 definition.id, dt.text, steps, definition.duration, kMostSteps));
  }
}

// Letters, digits, dot and hyphen stay; a slash becomes a hyphen, all else an underscore. Of a long text the end stays.
std::string safe_name(std::string text) {
  constexpr std::size_t kLongest = 80;  // three parts must fit into a file system's 255 bytes
  for (char& c : text) {
    const bool is_plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '-';
    if (!is_plain) c = c == '/' ? '-' : '_';
  }
  return text.size() > kLongest ? text.substr(text.size() - kLongest) : text;
}

// A unique file name for every cell's trajectory, even if the names that it consists of are alike.
void name_trajectories(Results& grid) {
  std::set<std::string> taken;
  for (CaseResult& result : grid.cases) {
    for (Cell& cell : result.cells) {
      const std::string stem = fmt::format("{}--{}--{}", safe_name(result.definition.id),
                                           safe_name(grid.runs[cell.run].text), safe_name(cell.dt.text));
      std::string name = stem + ".csv";
      for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}--{}.csv", stem, n);
      if (cell.status != Status::unsupported) cell.trajectory = name;
    }
  }
}

bool is_named_by_gates(const RunName& run, const Case& definition, const std::vector<EngineInfo>& engines) {
  return std::any_of(definition.gates.begin(), definition.gates.end(), [&](const Gate& gate) {
    const auto names = runs_named_by(gate);
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return is_same_run(parse_run_name(name, engines), run); });
  });
}

// The search would take hundreds of runs of half a minute each. Several touching bodies have large errors at coarse
// steps long before they blow up.
std::string why_no_stable_step(const Case& definition) {
  if (definition.truth == "recording") return "not searched for where the truth is a recording, which ends";
  const Scene& scene = definition.scene;
  const long touching = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                      [](const Body& body) { return body.collides && !body.fixed; });
  return touching > 1 ? "not searched for where more than one moving body can touch" : "";
}

// `asked_for`: so many of the grid's runs are for every case; each of the others for those whose gates name it.
CaseResult plan_case(const Case& definition, const Results& grid, std::size_t asked_for, const EngineTable& engines,
                     const Scope& scope) {
  CaseResult result;
  result.definition = definition;
  const bool only_judged = scope.only_judged && !definition.gates.empty();
  const std::string missing = missing_recording(definition);
  for (std::size_t run = 0; run < grid.runs.size(); ++run) {
    if (run >= asked_for && !is_named_by_gates(grid.runs[run], definition, grid.engines)) {
      skip(result.stable_steps.emplace_back(), SkipReason::not_asked_for);
      continue;
    }
    const EngineInfo& info = engines.info_of(grid.runs[run].engine);
    double shortest = definition.duration;
    for (const StepSize& dt : definition.dt) {
      if (only_judged && !is_judged(definition, grid.runs[run], dt, grid.engines)) continue;
      Cell cell;
      cell.run = run, cell.dt = dt;
      const std::string why =
          missing.empty() ? why_unsupported(info, grid.runs[run].settings, definition.scene, dt.seconds) : missing;
      if (!why.empty()) cell.status = Status::unsupported, cell.reason = why;
      result.cells.push_back(cell);
      shortest = std::min(shortest, dt.seconds);
    }
    StableStepResult stable;
    std::string why = missing;
    if (why.empty()) why = why_unsupported(info, grid.runs[run].settings, definition.scene, shortest);
    if (why.empty() && scope.stable_steps) why = why_no_stable_step(definition);
    if (!why.empty())
      stable.status = Status::unsupported, stable.reason = why;
    else if (!scope.stable_steps)
      skip(stable, SkipReason::not_asked_for);
    result.stable_steps.push_back(stable);
  }
  return result;
}

std::size_t cells_to_run(const Results& grid) {
  std::size_t count = 0;
  for (const CaseResult& result : grid.cases) {
    for (const Cell& cell : result.cells) count += cell.status != Status::unsupported;
    for (const StableStepResult& stable : result.stable_steps) count += stable.status != Status::unsupported;
  }
  return count;
}

// The cases by falling count of body steps, so that no long one is left alone at the end.
std::vector<std::size_t> longest_first(const Results& grid) {
  std::vector<double> work;
  for (const CaseResult& result : grid.cases) {
    double steps = 0;
    for (const Cell& cell : result.cells) {
      if (cell.status != Status::unsupported) steps += result.definition.duration / cell.dt.seconds;
    }
    work.push_back(steps * static_cast<double>(result.definition.scene.bodies.size()));
  }
  std::vector<std::size_t> order(work.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
  return order;
}

// Why the case's own process failed: cells without a result are then not trusted. `planned`: the parts that it had to
// do, before it started.
void note_case_end(CaseResult& result, const CaseResult& planned, const JobEnd& end, double limit) {
  const bool is_input = end.how == Ending::refused;
  if (end.how != Ending::finished) {
    const std::string what = is_input       ? result.definition.truth_where + ": "
                             : result.truth ? "the process of this case broke off: "
                                            : "the truth of this case was not found: ";
    result.error = what + sentence_of(end, limit);
    result.error_is_input = is_input;
  }
  if (result.error.empty()) return;
  const Status status = is_input ? Status::invalid : end.how == Ending::timed_out ? Status::timed_out : Status::crashed;
  const auto is_unheard = [](const auto& part, const auto& before) {
    return before.status != Status::unsupported && part.status == Status::crashed && part.reason == Cell().reason;
  };
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    Cell& cell = result.cells[i];
    if (is_unheard(cell, planned.cells[i])) cell.status = status, cell.reason = result.error, cell.trajectory.clear();
  }
  for (std::size_t i = 0; i < result.stable_steps.size(); ++i) {
    StableStepResult& stable = result.stable_steps[i];
    if (is_unheard(stable, planned.stable_steps[i])) stable.status = status, stable.reason = result.error;
  }
}

// The jobs of a grid: its cases; for an executor each case in the shares that it falls into.
class GridJobs {
 public:
  GridJobs(const Results& grid, const GridOptions& options) : planned_(grid) {
    if (options.executor) partition_.emplace(grid, kShares);
    for (const std::size_t index : longest_first(grid)) {
      for (const int share : partition_ ? shares_in(partition_->cases()[index]) : std::vector<int>{0})
        jobs_.push_back({JobSpec::Kind::whole_case, index, options.limit, static_cast<std::size_t>(share)});
    }
  }

  const std::vector<JobSpec>& jobs() const { return jobs_; }

  // The case, reduced to the job's parts.
  CaseResult planned(const JobSpec& job) const {
    CaseResult own = planned_.cases[job.of_case];
    if (partition_) leave_to_others(own, partition_->cases()[job.of_case], static_cast<int>(job.part));
    return own;
  }

  // Pairs of cells that different processes have done.
  void add_spreads(Results& grid, const EngineTable& engines, const GridOptions& options) const {
    for (std::size_t c = 0; partition_ && c < grid.cases.size(); ++c) {
      if (shares_in(partition_->cases()[c]).size() < 2) continue;
      const CaseResult& planned = planned_.cases[c];
      grid.cases[c].spreads = spreads_of(planned, paths_in(planned, kept_answers(planned_, planned, engines, options)));
    }
  }

 private:
  const Results planned_;
  std::optional<Partition> partition_;
  std::vector<JobSpec> jobs_;
};

std::string plan_of_all(const Results& grid, const EngineTable& engines, const GridOptions& options) {
  std::string all;
  for (const CaseResult& planned : grid.cases) all += plan_of(grid, planned, engines, options);
  return all;
}

}  // namespace

void override_run(Case& definition, const Overrides& overrides) {
  if (overrides.duration) definition.duration = *overrides.duration;
  if (!overrides.dt.empty()) definition.dt = overrides.dt;
  for (const StepSize& dt : definition.dt) check_steps(definition, dt);
}

std::vector<RunName> runs_of_gates(const std::vector<Case>& cases, const std::vector<RunName>& but,
                                   const std::vector<EngineInfo>& engines) {
  std::vector<RunName> found;
  const auto is_in = [](const std::vector<RunName>& runs, const RunName& run) {
    return std::any_of(runs.begin(), runs.end(), [&](const RunName& other) { return is_same_run(other, run); });
  };
  for (const Case& definition : cases) {
    for (const Gate& gate : definition.gates) {
      for (const std::string& name : runs_named_by(gate)) {
        RunName run = parse_run_name(name, engines);
        if (!is_in(but, run) && !is_in(found, run)) found.push_back(std::move(run));
      }
    }
  }
  return found;
}

Results plan_grid(const std::vector<Case>& cases, const std::vector<RunName>& runs, const EngineTable& engines,
                  const Scope& scope, const std::vector<RunName>& only_where_named) {
  Results grid;
  grid.runs = runs;
  const std::size_t asked_for = runs.size();
  grid.runs.insert(grid.runs.end(), only_where_named.begin(), only_where_named.end());
  grid.engines = infos_of(engines);
  for (const Case& definition : cases) {
    grid.cases.push_back(plan_case(definition, grid, asked_for, engines, scope));
  }
  const bool is_empty =
      std::all_of(grid.cases.begin(), grid.cases.end(), [](const CaseResult& c) { return c.cells.empty(); });
  if (is_empty) throw InputError("nothing to run: no case, no engine or no step size is left of the selection");
  name_trajectories(grid);
  return grid;
}

void run_grid(Results& grid, const EngineTable& engines, const GridOptions& options,
              const std::function<void(std::size_t done, std::size_t all)>& on_progress) {
  const auto start = std::chrono::steady_clock::now();
  const std::size_t all = cells_to_run(grid);
  std::size_t done = 0;
  if (!options.journals.empty()) build_identity();  // read before there are processes that would each read it
  const GridJobs all_jobs(grid, options);
  const std::vector<JobSpec>& jobs = all_jobs.jobs();
  const int at_once = std::min<int>(options.jobs, static_cast<int>(grid.cases.size()));
  // Runs in its own process, which needs the runs and its own case only.
  const auto work = [&](const JobSpec& job, const Channel& channel) {
    GridOptions of_case = options;
    of_case.jobs = options.executor ? options.jobs : options.jobs / std::max(1, at_once);
    of_case.share = static_cast<int>(job.part);
    Results own;
    own.runs = grid.runs, own.engines = grid.engines, own.cases.resize(grid.cases.size());
    own.cases[job.of_case] = all_jobs.planned(job);
    run_case(own, own.cases[job.of_case], engines, of_case, channel);
  };
  const auto on_message = [&](std::size_t job, const std::string& message) {
    using Part = MessageSubject::Part;
    CaseResult& result = grid.cases[jobs[job].of_case];
    try {
      const MessageSubject subject = apply_message(result, message);
      if (options.on_part) options.on_part(jobs[job].of_case, subject);
      if (subject.part == Part::cell || subject.part == Part::stable_step) on_progress(++done, all);
    } catch (const std::exception& error) {
      result.error = fmt::format("a message of this case's process could not be read: {}", error.what());
    }
  };
  const auto on_end = [&](std::size_t job, const JobEnd& end) {
    note_case_end(grid.cases[jobs[job].of_case], all_jobs.planned(jobs[job]), end, options.limit);
  };
  const ProcessExecutor processes(at_once);
  const Executor& executor = options.executor ? *options.executor : processes;
  executor.begin(plan_of_all(grid, engines, options), options.journals);
  executor.run(jobs, work, on_message, on_end);
  all_jobs.add_spreads(grid, engines, options);
  std::for_each(grid.cases.begin(), grid.cases.end(), hold_to_cells);
  grid.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace rigor::inline runner
