// A small grid for the runner's simulation, what it comes to where nothing fails, and one run of it.
#pragma once

#include <fmt/format.h>

#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cases/case/selection.h"
#include "cases/results/spread.h"
#include "cases/runner/grid.h"
#include "cases/runner/shards/shard.h"
#include "tests/cases/runner/platform/acting_engine.h"
#include "tests/cases/runner/platform/simulated_platform.h"

namespace rigor::test {

struct Violation : std::runtime_error {
  using runtime_error::runtime_error;
};
inline void expect(bool holds, const std::string& what) {
  if (!holds) throw Violation(what);
}

// Writes who made a cell into its trajectory, and into its result.
class SigningRecorder : public Recorder {
 public:
  explicit SigningRecorder(std::string folder) : folder_(std::move(folder)) {}
  std::string name() const override { return "sign"; }
  Recording of_truth(const Case&, const Truth&, const TruthFacts&) const override { return {}; }
  Recording of_run(const Case&, const Cell& cell, const JudgedRun&, const std::vector<NamedSeries>&,
                   const TruthFacts&) const override {
    const std::string maker = std::to_string(cell_stage->platform().current());
    write_file(folder_ + "/" + cell.trajectory, fmt::format("rows of {} by {}\n", cell.trajectory, maker));
    return {maker};
  }
  void discard(const Cell& cell) const override { the_platform().try_to_remove(folder_ + "/" + cell.trajectory); }
  bool still_has(const Cell& cell) const override {
    return cell.trajectory.empty() || the_platform().exists(folder_ + "/" + cell.trajectory);
  }

 private:
  std::string folder_;
};

// What a result says, without times and without who made it. Whether a cell that timed out was begun depends on what
// ran beside it.
inline std::string line_of(const Cell& cell) {
  std::string line = word_of(cell.status);
  if (cell.status == Status::timed_out) return line;
  line += fmt::format(" '{}' {} {}", cell.reason, cell.trajectory, word_of(cell.stability.verdict));
  for (const auto& [name, value] : cell.metrics) {
    if (value.not_applicable.empty() && name != "cost") line += fmt::format(" {}={}", name, value.value);
  }
  return line;
}

inline std::string spreads_in(const CaseResult& result) {
  std::string text;
  for (const Spread& spread : result.spreads)
    text += fmt::format("{}-{} {} {} {};", spread.first, spread.second, spread.dt.text, spread.distance.value,
                        spread.compared_until);
  return text;
}

inline std::string name_in(const Results& grid, const CaseResult& result, const Cell& cell) {
  return name_of(grid.runs[cell.run].engine, result.definition.id, cell.dt.seconds);
}

// A grid and what comes of it where nothing fails.
struct Play {
  explicit Play(std::uint64_t seed) {
    Dice dice(seed);
    std::vector<StepSize> steps = {{0.1, "1/10"}};
    if (dice.chance(0.6)) steps.push_back({0.05, "1/20"});
    const std::size_t count = dice.chance(0.6) ? 1 : dice.chance(0.8) ? 2 : 3;
    std::vector<Case> cases;
    for (std::size_t c = 0; c < count; ++c) {
      Case& definition = cases.emplace_back();
      definition.id = fmt::format("case-{}", c), definition.title = "One body adrift";
      Body body;
      body.name = definition.id, body.velocity = Vec3(1, 0, 0);
      definition.scene.bodies.push_back(body);
      definition.duration = 0.2;
      definition.dt = steps;
    }
    const bool is_slow = dice.chance(0.1);  // its cells take longer together than a process may be silent
    for (const char* engine : {"inside", "outside"}) {
      for (const Case& definition : cases) {
        Way way = Way::good;
        for (const StepSize& dt : steps) {
          const bool is_out_of_time = way == Way::hangs || way == Way::spins;
          if (!is_out_of_time) way = is_slow ? Way::waits : draw_way(dice);
          ways[name_of(engine, definition.id, dt.seconds)] = way;
        }
      }
    }
    table.add(std::make_unique<ActingEngine>("inside", ways));
    table.add(std::make_unique<ActingEngine>("outside", ways), "some file, and its hash");
    const auto infos = infos_of(table);
    plan = plan_grid(cases, {parse_run_name("inside", infos), parse_run_name("outside", infos)}, table, {false});
  }
  Ways ways;
  EngineTable table;
  Results plan;
  std::map<std::string, std::string> lines, spreads;  // by cell, by case
};

enum class Mode { whole, shares, shards };

// One run of the program.
struct Attempt {
  std::string folder = "out";
  Shard shard;
  bool resumes = false;
  int jobs = 1, first = 0;  // its process
  int order = 0;            // in which the folder was had; 0: never
  bool is_published = false, is_disturbed = false;
  std::string error = {};
  std::map<std::string, std::string> files = {}, trajectories = {};
  std::map<std::string, int> begun = {};  // by cell: the process
  std::set<std::string> heard = {};
};

}  // namespace rigor::test
