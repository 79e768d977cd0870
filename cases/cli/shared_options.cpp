#include "cases/cli/shared_options.h"

#include <algorithm>

#include "adapters/plugin/plugins.h"
#include "cases/case/suite.h"
#include "cases/gates/deviations.h"
#include "cases/report/wording/printed_command.h"

namespace rigor::inline cli {

void SuiteOption::declare(Options& options) {
  options.add({"--suite", "DIR", "folder of the cases; default: Rigor's own"}, dir);
  options.after_reading([this] {
    if (dir.empty()) dir = default_suite_dir();
  });
  options.before_run([this] {
    if (dir != default_suite_dir()) use_suite(dir);
  });
}

void ImportFlags::declare(Options& options) {
  options.add_flag("--ground", "put a plane under a robot's file", chosen.ground);
  options.add({"--keyframe", "NAME", "start an MJCF model from this keyframe"}, chosen.keyframe);
  options.add_flag("--lossy", "accept that the import of a robot's file loses physics", chosen.lossy);
  options.add_flag("--repair-inertia", "replace inertias that no body can have by the nearest", chosen.repair_inertia);
  options.before_run([this] { use_imports(chosen); });
}

void CaseWords::declare(Options& options) {
  options.add_words(words);
  suite.declare(options), imports.declare(options);
}

void PluginOption::declare(Options& options) {
  options.add({"--plugin", "P",
               "an engine from outside: a path that ends in .so, or a command line. RIGOR_PLUGINS names more, "
               "separated by colons"},
              plugins);
}

EngineTable PluginOption::table(double limit) const {
  EngineTable table = built_in_engines();
  std::vector<std::string> all = plugins_of_environment();
  all.insert(all.end(), plugins.begin(), plugins.end());
  for (auto plugin = all.begin(); plugin != all.end(); ++plugin) {
    if (std::find(all.begin(), plugin, *plugin) == plugin) add_plugin(table, *plugin, limit);
  }
  return table;
}

void EngineOptions::declare(Options& options) {
  options.add({"--engine", "E", "an engine: NAME[:METHOD][,key=value...][@TRACK]"}, engines);
  outside.declare(options);
}

void StepOption::declare(Options& options) {
  const auto read = [this](const std::string& text) {
    const StepSize step = parse_step_size(text, "--dt");
    if (std::find(dt.begin(), dt.end(), step) == dt.end()) dt.push_back(step);
  };
  options.add({"--dt", "DT", "step size in s, a number or a fraction such as 1/30; may be repeated"}, read,
              Options::Repeats::yes);
}

void DurationOption::declare(Options& options) {
  options.add({"--duration", "S", "length of the run in s"},
              [this](const std::string& text) { seconds = parse_step_size(text, "--duration").seconds; });
}

void JobsOption::declare(Options& options) {
  count = options.default_jobs();
  options.add({"--jobs", "N", "cells at once; default: one a core"},
              [this](const std::string& text) { count = parse_count(text, "--jobs"); });
}

void TimeoutOption::declare(Options& options) {
  options.add({"--timeout", "S", "CPU time that a cell or a truth may take, in s; default: 120"},
              [this](const std::string& text) { seconds = parse_step_size(text, "--timeout").seconds; });
}

void OutOption::declare(Options& options) { options.add({"--out", "DIR", "folder of the reports; default: out"}, dir); }

void ResumeOption::declare(Options& options) {
  options.add_flag("--resume", "continue an interrupted run in the same folder", is_on);
}

void ShardOption::declare(Options& options) {
  options.add({"--shard", "K/N", "run only the K-th of N parts of the grid; rigor merge joins them"},
              [this](const std::string& text) { shard = parse_shard(text, "--shard"); });
}

void DeviationsOption::declare(Options& options) {
  options.add({"--deviations", "DIR", "folder of ENGINE/known_deviations.toml; default: Rigor's own"}, dir);
  options.after_reading([this] {
    if (dir.empty()) dir = default_adapters_dir();
  });
}

void SeedOption::declare(Options& options) {
  constexpr int kMost = 1000000000;
  options.add({"--seed", "S", "seed of the draws; the same seed draws the same"}, [this](const std::string& text) {
    seed = static_cast<unsigned long>(parse_count(text, "--seed", kMost));
  });
}

void JsonOption::declare(Options& options) { options.add_flag("--json", "print JSON", is_on); }

}  // namespace rigor::inline cli
