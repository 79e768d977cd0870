// The runner on a machine that fails: grid, pool, journal, output folder, shards and --resume, in schedules that follow
// from a seed. A schedule is a few runs of one small grid into one folder, each met by its own faults, and a last one
// that meets none. RIGOR_SCHEDULES=1000000 tries more of them, RIGOR_SCHEDULE=17 that of one seed.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cases/runner/build_identity.h"
#include "cases/runner/grid.h"
#include "cases/runner/output_folder.h"
#include "cases/runner/shards/part.h"
#include "cases/runner/shards/shard.h"
#include "core/base/error.h"
#include "tests/cases/runner/platform/played_grid.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_simulation)

using namespace rigor::test;

namespace {

class Schedule : public CellStage {
 public:
  Schedule(Play& play, std::uint64_t seed) : play_(play), dice_(seed), platform_(dice_.roll()) { cell_stage = this; }
  ~Schedule() override { cell_stage = nullptr; }
  Schedule(const Schedule&) = delete;
  Schedule& operator=(const Schedule&) = delete;
  SimulatedPlatform& platform() override { return platform_; }

  // Finds what the grid comes to.
  void learn() {
    Attempt& attempt = new_attempt("out", {}, false);
    play({&attempt}, {}, true);
  }

  void play_all() {
    const std::size_t kind = dice_.below(10);
    mode_ = kind < 6 ? Mode::whole : kind < 8 ? Mode::shares : Mode::shards;
    for (int i = 1; i <= (mode_ == Mode::shards ? 2 : 1); ++i) play_folder(i);
    if (mode_ == Mode::shards) merge();
  }

  long requests() const { return all_requests_; }
  int faults_met() const { return met_; }

  void begins(const std::string& cell) override {
    Attempt& attempt = attempt_of(platform_.current());
    if (!attempt.begun.emplace(cell, platform_.current()).second) flaw_ = cell + " was begun twice";
    if (attempt.resumes && kept_.contains(attempt.folder + cell))
      flaw_ = cell + " was done again by a run that resumes";
    makers_[cell].insert(platform_.current());
  }

 private:
  static constexpr const char* kNotes = "the user's own";

  std::vector<std::string> file_names() const {
    return mode_ == Mode::shards ? std::vector<std::string>{kPartFile}
                                 : std::vector<std::string>{"report.md", "results.json"};
  }

  Attempt& new_attempt(const std::string& folder, const Shard& shard, bool resumes) {
    Attempt& attempt = *attempts_.emplace_back(std::make_unique<Attempt>());
    attempt.folder = folder, attempt.shard = shard, attempt.resumes = resumes;
    attempt.jobs = static_cast<int>(1 + dice_.below(4));
    return attempt;
  }

  Attempt& attempt_of(int process) {
    const int first = platform_.first_above(process);
    for (auto& attempt : attempts_) {
      if (attempt->first == first) return *attempt;
    }
    throw Violation("a process of no run");
  }

  void play_folder(int shard) {
    const std::string folder = mode_ == Mode::shards ? fmt::format("part{}", shard) : "out";
    const Shard its = mode_ == Mode::shards ? Shard{shard, 2} : Shard{};
    if (dice_.chance(0.5)) {
      Attempt& old = new_attempt(folder, its, false);
      old.order = ++orders_, old.is_published = true;
      for (const std::string& name : file_names()) old.files[name] = "old", platform_.put(folder + "/" + name, "old");
      old.trajectories["a--b--c.csv"] = "old", platform_.put(folder + "/trajectories/a--b--c.csv", "old");
      platform_.put(folder + "/trajectories/notes.txt", kNotes);
      has_notes_ = true;
    } else {
      has_notes_ = false;
    }
    kept_.clear();
    for (std::size_t left = 1 + dice_.below(3) / 2; left > 0; --left) {
      Attempt& attempt = new_attempt(folder, its, dice_.chance(0.7));
      attempt.is_disturbed = true;
      std::vector<Attempt*> at_once = {&attempt};
      if (dice_.chance(0.1)) {
        at_once.push_back(&new_attempt(folder, its, dice_.chance(0.5)));
        at_once.back()->is_disturbed = true;
      }
      play(at_once, draw_faults(), false);
      if (dice_.chance(0.15)) lose_a_trajectory(folder);
    }
    play({&new_attempt(folder, its, dice_.chance(0.8))}, {}, false);
  }

  // As a user may do with what a run has left.
  void lose_a_trajectory(const std::string& folder) {
    const auto grown = platform_.find(folder + "/.rigor-partial/trajectories");
    if (!grown || grown->names.empty()) return;
    auto lost = grown->names.begin();
    std::advance(lost, static_cast<long>(dice_.below(grown->names.size())));
    grown->names.erase(lost);
    kept_.clear();
  }

  // Some kinds of faults at a time, since many together let no run come far.
  Faults draw_faults() {
    Faults faults;
    faults.turn = std::pow(10., -2 * dice_.unit());
    const auto some = [&](double chance, double at_most) {
      return dice_.chance(chance) ? at_most * std::pow(10., -2 * dice_.unit()) : 0.;
    };
    if (dice_.chance(0.6)) faults.kill_first_at = static_cast<long>(dice_.below(dice_.chance(0.5) ? 300 : 1500));
    if (dice_.chance(0.1)) faults.interrupt_at = static_cast<long>(dice_.below(1000));
    faults.interrupts_all = dice_.chance(0.5);
    faults.kill = some(0.3, 0.02), faults.pause = some(0.2, 0.01), faults.no_fork = some(0.1, 0.3);
    faults.clock_jump = some(0.1, 0.01), faults.io_error = some(0.1, 0.05);
    faults.short_write = some(0.4, 1), faults.interrupted_call = some(0.2, 0.3);
    if (dice_.chance(0.1)) faults.space = static_cast<long>(dice_.below(20'000));
    faults.can_exchange = dice_.chance(0.8), faults.can_link = dice_.chance(0.8);
    if (dice_.chance(0.3)) faults.pipe = 1 + dice_.below(4096);
    return faults;
  }

  void play(const std::vector<Attempt*>& attempts, const Faults& faults, bool learns) {
    loses_journals_ = faults.io_error > 0 || faults.space >= 0;
    if (loses_journals_) kept_.clear();
    platform_.watch_folder(attempts.front()->folder + "/trajectories");
    std::vector<std::function<void()>> bodies;
    for (Attempt* attempt : attempts) bodies.push_back([this, attempt, learns] { run(*attempt, learns); });
    flaw_.clear();
    platform_.run(bodies, faults);
    all_requests_ += platform_.requests(), met_ += platform_.is_anything_hit();
    if (!flaw_.empty()) throw Violation(flaw_);
    // One that goes on from nothing may have cleared the folder before it died.
    if (std::any_of(attempts.begin(), attempts.end(),
                    [](const Attempt* each) { return !each->resumes && !each->order; }))
      kept_.clear();
    const std::string& folder = attempts.front()->folder;
    expect(!platform_.lost_its_trajectories(), "for an instant there was no folder of trajectories");
    check_outputs(folder);
    if (!platform_.is_anything_hit() && attempts.size() == 1) {
      Attempt& only = *attempts.front();
      expect(only.is_published, "an undisturbed run came to nothing: " + only.error);
      expect(!platform_.find(folder + "/.rigor-partial"), "an undisturbed run left its hidden folder");
      expect(newest(folder) == &only, "an undisturbed run's outputs are not in place");
      const int cells = platform_.most_at_once(2), cases = platform_.most_at_once(1);
      expect(cells <= only.jobs && cases <= only.jobs, fmt::format("{} children at once", std::max(cells, cases)));
    }
  }

  // A run as the command makes it (cases/cli/run_command.cpp), with its own reports.
  void run(Attempt& attempt, bool learns) {
    attempt.first = platform_.current();
    try {
      OutputFolder folder(attempt.folder, file_names(), attempt.resumes);
      attempt.order = ++orders_;
      check_outputs(attempt.folder);
      if (!attempt.resumes) kept_.clear();
      expect(attempt.resumes || platform_.find(folder.journals())->names.empty(), "journals of another run are left");
      try {
        mode_ == Mode::shards ? run_part(attempt, folder) : run_whole(attempt, folder, learns);
      } catch (...) {  // Interrupted, and the death of the process, too
        folder.keep();
        throw;
      }
    } catch (const Violation& violation) {
      flaw_ = violation.what();
    } catch (const std::exception& error) {
      attempt.error = error.what();
    } catch (const Interrupted&) {
      attempt.error = "interrupted";
    }
  }

  GridOptions options_of(const OutputFolder& folder, const Attempt& attempt, const Results& grid) {
    GridOptions options{attempt.jobs, kLimit, {std::make_shared<SigningRecorder>(folder.trajectories())},
                        false,        false,  folder.journals()};
    options.on_part = [&](std::size_t of_case, const MessageSubject& subject) {
      if (subject.part == MessageSubject::Part::cell) hear(attempt, grid, of_case, subject.index);
    };
    return options;
  }

  void hear(const Attempt& attempt, const Results& grid, std::size_t of_case, std::size_t index) {
    const CaseResult& result = grid.cases[of_case];
    const std::string name = name_in(grid, result, result.cells[index]);
    Attempt& own = attempt_of(attempt.first);
    if (!own.heard.insert(name).second) flaw_ = name + " was heard of twice";
    const Status status = result.cells[index].status;
    if (!loses_journals_ && (status == Status::pass || status == Status::diverged)) kept_.insert(own.folder + name);
  }

  void run_whole(Attempt& attempt, OutputFolder& folder, bool learns) {
    Results grid = play_.plan;
    GridOptions options = options_of(folder, attempt, grid);
    const ProcessExecutor team(attempt.jobs);
    if (mode_ == Mode::shares) options.executor = &team, options.jobs = 1;
    run_grid(grid, play_.table, options, count_);
    learns ? learn_from(grid) : check_grid(attempt, grid, folder, true);
    std::vector<OutputFile> files;
    for (const std::string& name : file_names()) {
      attempt.files[name] = fmt::format("{} of run {}, {}", name, attempt.order, std::string(300, '.'));
      files.push_back({name, [&attempt, name] { return attempt.files.at(name); }});
    }
    const auto faults = faults_of_writing(folder, files, trajectories_of(attempt, grid, folder), true);
    attempt.is_published = faults.size() <= files.size();  // else: all of them, and that nothing was changed
    if (faults.empty()) kept_.clear();
  }

  void run_part(Attempt& attempt, OutputFolder& folder) {
    const Results planned = share_of(play_.plan, attempt.shard);
    Results share = planned;
    const GridOptions options = options_of(folder, attempt, share);
    run_grid(share, play_.table, options, count_);
    check_grid(attempt, share, folder, false);
    const PartTitle title{
        attempt.shard,        "1", build_identity(), {"run"}, "suite", "ad", plans_of(play_.plan, play_.table, options),
        double(attempt.order)};
    attempt.files[kPartFile] = part_text(title, planned, share, play_.table, options);
    const auto trajectories = trajectories_of(attempt, share, folder);
    folder.write(kPartFile, attempt.files.at(kPartFile));
    folder.publish(trajectories);
    attempt.is_published = true;
    kept_.clear();
  }

  std::vector<std::string> trajectories_of(Attempt& attempt, const Results& grid, const OutputFolder& folder) {
    std::vector<std::string> names;
    for (const CaseResult& result : grid.cases) {
      for (const Cell& cell : result.cells) {
        if (cell.trajectory.empty() || cell.status == Status::unsupported) continue;
        names.push_back(cell.trajectory);
        const auto node = platform_.find(folder.trajectories() + "/" + cell.trajectory);
        expect(node != nullptr, cell.trajectory + " is named and not there");
        attempt.trajectories[cell.trajectory] = node->bytes;
      }
    }
    return names;
  }

  void learn_from(const Results& grid) {
    for (const CaseResult& result : grid.cases) {
      for (const Cell& cell : result.cells) play_.lines[name_in(grid, result, cell)] = line_of(cell);
      play_.spreads[result.definition.id] = spreads_in(result);
    }
  }

  void check_grid(const Attempt& attempt, const Results& grid, const OutputFolder& folder, bool has_spreads) {
    for (const CaseResult& result : grid.cases) {
      const bool was_hit = platform_.is_anything_hit();
      expect(result.error.empty() || was_hit, "a case failed of itself: " + result.error);
      bool is_whole = true;
      for (const Cell& cell : result.cells) {
        if (cell.status == Status::unsupported) continue;
        const std::string name = name_in(grid, result, cell), line = line_of(cell);
        const bool is_true = line == play_.lines.at(name);
        is_whole &= is_true;
        expect(cell.reason != Cell().reason, name + " was lost");
        expect(is_true || cell.status == Status::crashed || cell.status == Status::timed_out,
               fmt::format("{} came out as {} instead of {}", name, line, play_.lines.at(name)));
        const auto begun = attempt.begun.find(name);
        const bool its_own_fault = begun == attempt.begun.end() ? was_hit : platform_.is_hit(begun->second);
        expect(is_true || its_own_fault, fmt::format("{} came out as {} and met no fault", name, line));
        if (cell.status == Status::pass) check_maker(attempt, name, cell, folder);
      }
      const std::string spreads = spreads_in(result);
      if (has_spreads && is_whole && result.error.empty() && !loses_journals_)
        expect(spreads == play_.spreads.at(result.definition.id),
               fmt::format("spreads {} instead of {}", spreads, play_.spreads.at(result.definition.id)));
    }
  }

  // The verdict and the trajectory are of one process, and it is one of this run or of those that it goes on from.
  void check_maker(const Attempt& attempt, const std::string& name, const Cell& cell, const OutputFolder& folder) {
    const int maker = std::stoi(cell.recordings.at("sign").at(0));
    const auto node = platform_.find(folder.trajectories() + "/" + cell.trajectory);
    expect(node && node->bytes == fmt::format("rows of {} by {}\n", cell.trajectory, maker),
           name + " has a trajectory of another process");
    expect(makers_[name].contains(maker), name + " was made by nobody");
    const auto begun = attempt.begun.find(name);
    expect(begun == attempt.begun.end() || begun->second == maker, name + " has a result of another process");
    expect(attempt.resumes || begun != attempt.begun.end(), name + " has a result of another run");
  }

  // The newest run whose outputs may stand there.
  const Attempt* newest(const std::string& folder) const {
    const Attempt* found = nullptr;
    for (const auto& attempt : attempts_) {
      if (attempt->folder == folder && attempt->order > (found ? found->order : 0) && stands_there(*attempt))
        found = attempt.get();
    }
    return found;
  }

  bool stands_there(const Attempt& attempt) const {
    bool has_any = false;
    for (const std::string& name : file_names()) {
      const auto node = platform_.find(attempt.folder + "/" + name);
      const auto text = attempt.files.find(name);
      if (node && (text == attempt.files.end() || node->bytes != text->second)) return false;
      has_any |= node != nullptr;
      if (!node && !attempt.is_disturbed) return false;
    }
    const auto trajectories = platform_.find(attempt.folder + "/trajectories");
    if (!has_any || !trajectories) return false;
    std::size_t count = 0;
    for (const auto& [name, node] : trajectories->names) {
      if (name == "notes.txt") continue;
      const auto text = attempt.trajectories.find(name);
      if (text == attempt.trajectories.end() || node->bytes != text->second) return false;
      ++count;
    }
    return count == attempt.trajectories.size();
  }

  // The outputs are those of one run, as a whole, and of none before the last that put its own into place.
  void check_outputs(const std::string& folder) {
    if (platform_.find(folder + "/.rigor-partial/staged/ready")) return;  // the next run begins by that
    const auto notes = platform_.find(folder + "/trajectories/notes.txt");
    expect(!has_notes_ || (notes && notes->bytes == kNotes), "the user's own file is gone");
    int last = 0;
    for (const auto& attempt : attempts_) {
      if (attempt->folder == folder && attempt->is_published) last = std::max(last, attempt->order);
    }
    const Attempt* now = newest(folder);
    if (now) {
      expect(now->order >= last, "older outputs came back");
      return;
    }
    bool is_empty = last == 0;
    for (const std::string& name : file_names()) is_empty &= !platform_.find(folder + "/" + name);
    expect(is_empty, "the outputs are of no run, or of several");
  }

  // As `rigor merge`.
  void merge() {
    Results grid = play_.plan;
    flaw_.clear();
    platform_.run({[&] {
                    try {
                      const std::vector<Part> parts = {read_part("part1"), read_part("part2")};
                      check_same_grid(parts);
                      const Merged merged = fill_in(grid, parts);
                      for (const auto& list : {merged.missing, merged.remarks}) {
                        for (const std::string& sentence : list) flaw_ = sentence;
                      }
                      for (const auto& [name, part] : merged.trajectories) {
                        if (!platform_.find(part + "/trajectories/" + name)) flaw_ = name + " is in no part";
                      }
                    } catch (const std::exception& error) {
                      flaw_ = error.what();
                    }
                  }},
                  {});
    expect(flaw_.empty(), "merging: " + flaw_);
    for (const CaseResult& result : grid.cases) {
      for (const Cell& cell : result.cells) {
        const std::string name = name_in(grid, result, cell);
        expect(line_of(cell) == play_.lines.at(name), fmt::format("{} was merged as {}", name, line_of(cell)));
      }
      expect(spreads_in(result) == play_.spreads.at(result.definition.id), "the merged spreads are others");
    }
  }

  Play& play_;
  Dice dice_;
  SimulatedPlatform platform_;
  Mode mode_ = Mode::whole;
  std::vector<std::unique_ptr<Attempt>> attempts_;
  int orders_ = 0, met_ = 0;
  long all_requests_ = 0;
  bool has_notes_ = false, loses_journals_ = false;
  std::set<std::string> kept_;                   // cells that no further run need do
  std::map<std::string, std::set<int>> makers_;  // by cell
  std::string flaw_;
  const std::function<void(std::size_t, std::size_t)> count_ = [this](std::size_t done, std::size_t all) {
    if (done > all) flaw_ = fmt::format("{} cells of {} are done", done, all);
  };
};

constexpr std::size_t kPlays = 97;

Play& play_of(std::uint64_t seed) {
  static std::map<std::uint64_t, std::unique_ptr<Play>> plays;
  std::unique_ptr<Play>& play = plays[seed % kPlays];
  if (!play) {
    play = std::make_unique<Play>(seed % kPlays);
    Schedule(*play, 1).learn();
  }
  return *play;
}

// What went wrong; empty if nothing did.
std::string flaw_of(std::uint64_t seed, bool is_told, long& requests, int& met) {
  Play& play = play_of(seed);
  Schedule schedule(play, seed);
  if (is_told) schedule.platform().tell();
  try {
    schedule.play_all();
  } catch (const std::exception& error) {
    return error.what();
  }
  requests += schedule.requests(), met += schedule.faults_met();
  return "";
}

long number_in(const char* variable, long otherwise) {
  const char* value = std::getenv(variable);
  return value && *value ? std::atol(value) : otherwise;
}

}  // namespace

BOOST_AUTO_TEST_CASE(whatever_fails_no_cell_is_lost_and_none_counts_twice) {
  build_identity();  // reads the program, once
  const long one = number_in("RIGOR_SCHEDULE", -1), count = number_in("RIGOR_SCHEDULES", 10'000);
  const long first = one >= 0 ? one : number_in("RIGOR_SCHEDULES_FROM", 0), behind = one >= 0 ? one + 1 : first + count;
  const auto begin = std::chrono::steady_clock::now();
  long requests = 0;
  int met = 0, failed = 0;
  for (long seed = first; seed < behind && failed < 10; ++seed) {
    const std::string flaw = flaw_of(static_cast<std::uint64_t>(seed), one >= 0, requests, met);
    failed += !flaw.empty();
    BOOST_TEST(flaw.empty(), flaw << "; once more: RIGOR_SCHEDULE=" << seed);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  BOOST_TEST_MESSAGE(behind - first << " schedules, " << requests << " requests to the machine, " << met
                                    << " runs that met a fault, in " << seconds << " s");
}

BOOST_AUTO_TEST_SUITE_END()
