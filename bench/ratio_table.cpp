#include "bench/ratio_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "adapters/engines.h"
#include "bench/raw_engines.h"
#include "cases/report/json/machine.h"
#include "core/dynamics/kernels/kernels.h"

namespace rigor::bench {
namespace {

const std::string kCore = "core:semi-implicit-euler", kOde = "ode:worldstep", kBullet = "bullet:sequential-impulse",
                  kDart = "dart:dantzig", kMujoco = "mujoco:euler", kSimbody = "simbody:semi-explicit-euler";
constexpr int kNameWidth = 58;  // of a benchmark outside the table

std::string step(const std::string& scene, int count, const std::string& run) {
  return fmt::format("step/{}/{}/{}", scene, count, run);
}

// "pile, N = 216, contact=impulse": the core's run, its semi-implicit Euler unless another method is named.
std::string title(const std::string& scene, int count, const std::string& run) {
  std::string options = run.starts_with(kCore) ? run.substr(kCore.size()) : run.substr(run.find(':'));
  if (!options.empty()) options = ", " + options.substr(1);
  return fmt::format("{}, N = {}{}", scene, count, options);
}

// One run against both engines.
void add_pair(std::vector<RatioRow>& rows, const std::string& scene, int count, const std::string& run,
              const std::string& ode, double times_ode, double times_bullet) {
  const std::string what = title(scene, count, run);
  const auto kind = RatioRow::Kind::times_as_fast;
  rows.push_back({what + " against ODE", step(scene, count, run), step(scene, count, ode), kind, times_ode});
  if (times_bullet > 0)
    rows.push_back(
        {what + " against Bullet", step(scene, count, run), step(scene, count, kBullet), kind, times_bullet});
}

bool is_built(const std::string& run) {
  const std::string engine = run.substr(0, run.find(':'));
  const auto& infos = engines().infos();
  return std::any_of(infos.begin(), infos.end(), [&](const EngineInfo& info) { return info.name == engine; });
}

// The engines that are built where their library is found.
void add_optional(std::vector<RatioRow>& rows, const std::string& scene, int count, const std::string& run,
                  double times) {
  for (const std::string& other : {kDart, kMujoco, kSimbody}) {
    if (!is_built(other)) continue;
    rows.push_back({fmt::format("{} against {}", title(scene, count, run), other), step(scene, count, run),
                    step(scene, count, other), RatioRow::Kind::times_as_fast, times});
  }
}

// Mechanisms: the core's projection against each engine's own joints. Goals are for the chain of 100. If an engine
// lacks such joints or the method, its row says so.
void add_joints(std::vector<RatioRow>& rows) {
  struct Against {
    std::string run;
    double goal;  // times, for the chain of 100
  };
  const std::vector<Against> engines = {
      {kOde, 50}, {"ode:quickstep,iterations=50", 5}, {kBullet, 3}, {"bullet:multibody", 1.5}};
  const auto add = [&](const std::string& scene, int count, const Against& other, double goal) {
    rows.push_back({fmt::format("{}, N = {}, against {}", scene, count, other.run), step(scene, count, kCore),
                    step(scene, count, other.run), RatioRow::Kind::times_as_fast, goal});
  };
  for (const Against& other : engines) add("chain", 100, other, other.goal);
  for (const std::string& other : {kDart, kSimbody})
    if (is_built(other)) add("chain", 100, {other, 0}, 2);
  if (is_built(kMujoco)) add("chain", 95, {kMujoco, 0}, 2);  // its reader of scenes goes no deeper
  for (const std::string& other : {kDart, kMujoco, kSimbody})
    if (is_built(other)) add("ragdolls", 1000, {other, 0}, 2);
  for (const std::string& other : {engines[1].run, kBullet, kDart, kMujoco, kSimbody})
    if (is_built(other)) add("servo-arms", 1000, {other, 0}, 0);
  for (const auto& [scene, count] : {std::pair("chain", 1),
                                     {"chain", 10},
                                     {"chain", 1000},
                                     {"rod-net", 171},
                                     {"four-bars", 81},
                                     {"ragdolls", 1000}}) {
    for (const Against& other : {engines[1], engines[2]}) add(scene, count, other, 0);
  }
}

// Piles of hulls and cylinders. An engine that lacks the shape, or one of its pairs, says so in its row. Those of DART
// and MuJoCo, and piles of 1000, which take minutes, are there for --benchmark_filter.
void add_solids(std::vector<RatioRow>& rows, const std::string& impulse, const std::string& quick) {
  for (const char* scene : {"hulls", "cube-hulls", "cylinders"}) {
    for (const std::string& other : {kBullet, quick})
      rows.push_back({fmt::format("{}, against {}", title(scene, 216, impulse), other), step(scene, 216, impulse),
                      step(scene, 216, other), RatioRow::Kind::times_as_fast,
                      other == kBullet && scene != std::string_view("cylinders") ? 3.0 : 0.0});
  }
}

std::vector<RatioRow> all_rows() {
  using Kind = RatioRow::Kind;
  std::vector<RatioRow> rows;
  add_pair(rows, "free-bodies", 1000, kCore, kOde, 20, 40);
  add_optional(rows, "free-bodies", 1000, kCore, 50);
  add_pair(rows, "free-bodies", 1000, "core:rk4", kOde, 10, 0);
  add_pair(rows, "free-bodies", 1, kCore, kOde, 5, 10);
  add_pair(rows, "spring-chain", 1000, kCore, kOde, 8, 15);
  add_pair(rows, "springs/fixed-spring", 1, "core:rk4", kOde, 1, 0);
  add_pair(rows, "springs/body-springs", 2, "core:rk4", kOde, 1, 0);
  add_pair(rows, "bouncing-spheres", 1000, kCore, kOde, 20, 60);
  const std::string impulse = kCore + ",contact=impulse", quick = "ode:quickstep";
  add_pair(rows, "pile", 216, impulse, quick, 4, 5);
  add_pair(rows, "pile", 216, impulse + ",substeps=2", quick, 4, 5);  // no deeper in each other than the others' bodies
  add_optional(rows, "pile", 216, impulse, 4);
  add_pair(rows, "pyramid", 1240, impulse, quick, 4, 3);
  add_pair(rows, "balls-on-hills", 216, impulse, quick, 0, 0);
  add_solids(rows, impulse, quick);
  rows.push_back({"pile, a ball of N = 8000 against one of N = 1000", step("pile", 8000, impulse),
                  step("pile", 1000, impulse), Kind::at_most_times, 1.35});
  add_joints(rows);
  for (const auto& [scene, count] : {std::pair("humanoids", 12), {"humanoids", 1200}, {"quadrupeds", 900}}) {
    for (const std::string& other : {kMujoco, kBullet, quick, kDart}) {
      if (!is_built(other)) continue;
      rows.push_back({fmt::format("{}, N = {}, against {}", scene, count, other), step(scene, count, impulse),
                      step(scene, count, other), Kind::times_as_fast, other == kMujoco ? 2.0 : 0.0});
    }
  }
  rows.push_back({"free-bodies, N = 1000000, against copying the state", step("free-bodies", 1000000, kCore),
                  "limit/copy/1000000", Kind::at_most_times, 1.25});
  rows.push_back({"free-bodies, N = 1000, against the arithmetic in cache", step("free-bodies", 1000, kCore),
                  "limit/in-cache/" + kCore, Kind::at_most_times, 2});
  for (const std::string& method : {kCore, std::string("core:rk4")}) {
    rows.push_back({fmt::format("two threads against one, {} (wall)", title("free-bodies", 100000, method)),
                    step("free-bodies", 100000, method + ",threads=2"),
                    step("free-bodies", 100000, method + ",threads=1"), Kind::times_as_fast, 1.8});
  }
  for (const auto& [scene, count] : {std::pair("pile", 8000), {"pyramid", 1240}}) {
    rows.push_back({fmt::format("two threads against one, {} (wall)", title(scene, count, impulse)),
                    step(scene, count, impulse + ",threads=2"), step(scene, count, impulse + ",threads=1"),
                    Kind::times_as_fast, 1.7});
  }
  rows.push_back({"the same of copying the state: the memory's bound", "limit/copy/100000,threads=2",
                  "limit/copy/100000,threads=1", Kind::times_as_fast, 0});
  for (const RawEngine& raw : raw_engines()) {
    for (const auto& [count, goal] : {std::pair(1, 10.0), std::pair(100, 5.0)}) {
      rows.push_back({fmt::format("the seam around {}, N = {}", raw.name, count),
                      fmt::format("harness/seam/{}/{}", raw.name, count),
                      fmt::format("harness/raw/{}/{}", raw.name, count), Kind::at_most_percent_more, goal});
    }
  }
  // The piles of DART and MuJoCo, which take minutes, are there for --benchmark_filter.
  for (const char* engine : {"core", "ode", "bullet"}) {
    rows.push_back({fmt::format("reading contact forces from {}, pile, N = 216", engine),
                    fmt::format("harness/contacts/pile/216/{}", engine),
                    fmt::format("harness/plain/pile/216/{}", engine), Kind::at_most_percent_more, 5});
  }
  return rows;
}

const std::vector<std::string> kAlone = {"harness/cell", "harness/read-case/springs/body-springs",
                                         "harness/truth/springs/fixed-spring",
                                         "harness/truth-kept/springs/fixed-spring", "limit/copy/1000"};

// What is counted beside the time, and its words.
constexpr std::pair<const char*, const char*> kReached[] = {{"error_m_rad", "error [m, rad]"},
                                                            {"energy_error", "energy error"},
                                                            {"penetration_m", "deepest overlap [m]"},
                                                            {"joint_gap_m", "widest gap [m]"}};

// How the cost of a body grows with N.
struct Growth {
  std::string scene, run;
  std::vector<int> counts;
};
const std::vector<Growth> kGrowth = {{"free-bodies", kCore, {100, 1000, 10000, 100000}},
                                     {"pile", kCore + ",contact=impulse", {216, 1000, 8000}},
                                     {"chain", kCore, {1, 10, 100, 1000}}};

// "step/x/real_time/manual_time" and the like: the library appends how it timed.
std::string plain_name(const benchmark::BenchmarkReporter::Run& run) { return run.run_name.function_name; }

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::string time_text(double ns) {
  if (ns < 999.5) return fmt::format("{:.3g} ns", ns);
  if (ns < 999.5e3) return fmt::format("{:.3g} us", ns / 1e3);
  return fmt::format("{:.3g} ms", ns / 1e6);
}

bool holds(const RatioRow& row, double value) {
  return row.kind == RatioRow::Kind::times_as_fast ? value >= row.goal : value <= row.goal;
}

std::string value_text(RatioRow::Kind kind, double value) {
  if (kind == RatioRow::Kind::at_most_percent_more) return fmt::format("{:+.1f} %", value);
  return value < 999.5 ? fmt::format("{:.3g} x", value) : fmt::format("{:.0f} x", value);
}

// The longest name of a row.
int row_width() {
  std::size_t longest = 0;
  for (const RatioRow& row : ratio_rows()) longest = std::max(longest, row.what.size());
  return static_cast<int>(longest);
}

std::string goal_text(const RatioRow& row) {
  if (row.goal == 0) return "";
  switch (row.kind) {
    case RatioRow::Kind::times_as_fast:
      return fmt::format(">= {:g} x", row.goal);
    case RatioRow::Kind::at_most_times:
      return fmt::format("<= {:g} x", row.goal);
    case RatioRow::Kind::at_most_percent_more:
      return fmt::format("<= {:g} %", row.goal);
  }
  return "";
}

}  // namespace

const std::vector<RatioRow>& ratio_rows() {
  static const std::vector<RatioRow> table = all_rows();
  return table;
}

std::string filter_of_table() {
  std::vector<std::string> names = kAlone;
  for (const RatioRow& row : ratio_rows()) names.push_back(row.of), names.push_back(row.against);
  for (const auto& [scene, run, counts] : kGrowth) {
    for (const int count : counts) names.push_back(step(scene, count, run));
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return fmt::format("^({})(/|$)", fmt::join(names, "|"));
}

bool RatioTable::ReportContext(const Context&) {
  const Machine machine = this_machine();
  std::cout << fmt::format("{}, {} cores; {}, {}; the core's lanes: {}\n", machine.cpu, machine.cores, machine.compiler,
                           machine.build_type, kernels().name);
  return true;
}

void RatioTable::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration) continue;
    const std::string name = plain_name(run);
    if (run.error_occurred) {
      skipped_[name] = run.error_message;
      continue;
    }
    const auto counter = run.counters.find("ns_per_body_step");
    const double ns = counter != run.counters.end()
                          ? counter->second.value
                          : 1e9 * run.GetAdjustedRealTime() / benchmark::GetTimeUnitMultiplier(run.time_unit);
    ns_[name].push_back(ns);
    for (const auto& [key, value] : run.counters) counters_[name][key] = value;
    std::cerr << fmt::format("{:<{}} {}\n", name, kNameWidth, time_text(ns));
  }
}

void RatioTable::print_row(const RatioRow& row) {
  for (const std::string& name : {row.of, row.against}) {
    if (ns_.contains(name)) continue;
    const std::string why = skipped_.contains(name) ? skipped_[name] : "not timed";
    std::cout << fmt::format("{:<{}}  -  {}: {}\n", row.what, row_width(), name, why);
    return;
  }
  const Rounds &of = ns_[row.of], &against = ns_[row.against];
  std::vector<double> ratios;
  for (std::size_t k = 0; k < std::min(of.size(), against.size()); ++k) {
    const bool faster = row.kind == RatioRow::Kind::times_as_fast;
    const double ratio = faster ? against[k] / of[k] : of[k] / against[k];
    ratios.push_back(row.kind == RatioRow::Kind::at_most_percent_more ? 100 * (ratio - 1) : ratio);
  }
  const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
  const double value = median(ratios);
  std::cout << fmt::format("{:<{}} {:>9} {:>9} {:>9}  {:<19} {:>9}  {}\n", row.what, row_width(), time_text(median(of)),
                           time_text(median(against)), value_text(row.kind, value),
                           value_text(row.kind, *low) + " .. " + value_text(row.kind, *high), goal_text(row),
                           (row.goal == 0       ? ""
                            : holds(row, value) ? "yes"
                                                : "no ") +
                               reached_by(row));
}

// "joint gap 7.9e-15 / 3.7e-06 m": what both reach beside their speed, where both were looked at for the same.
std::string RatioTable::reached_by(const RatioRow& row) const {
  const auto of = counters_.find(row.of), against = counters_.find(row.against);
  if (of == counters_.end() || against == counters_.end()) return "";
  for (const auto& [name, words] : kReached) {
    const auto ours = of->second.find(name), theirs = against->second.find(name);
    if (ours != of->second.end() && theirs != against->second.end())
      return fmt::format("  {} {:.2g} / {:.2g}", words, ours->second, theirs->second);
  }
  return "";
}

void RatioTable::print_growth() {
  for (const auto& [scene, run, counts] : kGrowth) {
    std::string text;
    for (const int count : counts) {
      const auto rounds = ns_.find(step(scene, count, run));
      if (rounds == ns_.end()) continue;
      text += fmt::format("{}{} at {}", text.empty() ? "" : ", ", time_text(median(rounds->second)), count);
    }
    if (!text.empty()) std::cout << fmt::format("cost of a body as N grows, {}: {}\n", scene, text);
  }
}

void RatioTable::print_alone(const std::string& name) {
  if (!ns_.contains(name)) return;
  std::cout << fmt::format("{:<{}} {:>9}\n", name, kNameWidth, time_text(median(ns_[name])));
}

void RatioTable::Finalize() {
  std::cout << "\nThe core's methods are semi-implicit Euler where no other is named.\n";
  std::cout << fmt::format("{:<{}} {:>9} {:>9} {:>9}  {:<19} {:>9}  met, and what both reach\n", "per body and step",
                           row_width(), "this", "other", "ratio", "range", "goal");
  for (const RatioRow& row : ratio_rows()) {
    if (ns_.contains(row.of) || ns_.contains(row.against) || skipped_.contains(row.of)) print_row(row);
  }
  print_growth();
  for (const std::string& name : kAlone) print_alone(name);
  std::cout << "\nreached by what is in no row\n";
  for (const auto& [name, values] : counters_) {
    if (std::ranges::any_of(ratio_rows(), [&](const RatioRow& row) { return row.of == name || row.against == name; }))
      continue;
    for (const auto& [what, words] : kReached) {
      if (const auto value = values.find(what); value != values.end())
        std::cout << fmt::format("{:<{}} {} {:.3g}\n", name, kNameWidth, words, value->second);
    }
  }
}

}  // namespace rigor::bench
