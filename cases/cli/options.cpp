#include "cases/cli/options.h"

#include <algorithm>

#include "cases/report/scene/scene_formats.h"
#include "cases/report/trace/trace_formats.h"

namespace rigor {
namespace {

// "a, b or c".
template <typename Rows>
std::string choices_of(const Rows& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += (i == 0 ? "" : i + 1 == rows.size() ? " or " : ", ") + rows[i].name;
  return text;
}

struct Options {
  CLI::App& command;
  const CommandRow& row;
  CommandLine& line;
  Typed& typed;

  bool takes(const char* option) const {
    return std::find(row.options.begin(), row.options.end(), option) != row.options.end();
  }

  template <typename Value>
  void add(const char* name, Value& value, const std::string& help, const char* type) const {
    if (takes(name)) command.add_option(name, value, help)->type_name(type);
  }
  // Takes one value each time, or it would swallow the cases that follow.
  void add_repeatable(const char* name, std::vector<std::string>& values, const std::string& help,
                      const char* type) const {
    if (takes(name))
      command.add_option(name, values, help + "; may be repeated")->allow_extra_args(false)->type_name(type);
  }
  void add_flag(const char* name, bool& value, const std::string& help) const {
    if (takes(name)) command.add_flag(name, value, help);
  }

  // Options that choose runs.
  void add_runs() const {
    add_repeatable("--engine", line.engines, "an engine: NAME[:METHOD][,key=value...][@TRACK]", "E");
    add_repeatable("--plugin", line.plugins,
                   "an engine from outside: a path that ends in .so, or a command line. RIGOR_PLUGINS names more, "
                   "separated by colons",
                   "P");
    add_repeatable("--dt", typed.dt, "step size in s, a number or a fraction such as 1/30", "DT");
    add("--duration", typed.duration, "length of the run in s", "S");
    add("--every", typed.every, "print only each N-th sample", "N");
    add_flag("--contacts", line.contacts, "print the contact forces of each step in place of the bodies");
    add("--times", typed.times, "instants in s; default: every coarsest step of the run", "T,T...");
  }

  // Options of a grid and its results.
  void add_ways_to_run() const {
    add("--jobs", typed.jobs, "cells at once; default: one a core", "N");
    add("--out", line.out, "folder of the reports; default: out", "DIR");
    add("--timeout", typed.limit, "CPU time that a cell or a truth may take, in s; default: 120", "S");
    add("--shard", typed.shard, "run only the K-th of N parts of the grid; rigor merge joins them", "K/N");
    add_flag("--resume", line.resume, "continue an interrupted run in the same folder");
    add_flag("--verbose", line.verbose, "print every table and every reason");
    add_flag("--quick", line.quick, "check only gates whose cells are fast");
  }

  // Options of sweeps and tunings.
  void add_searches() const {
    add_repeatable("--vary", line.vary,
                   "dt, duration, a method's option or a path below scene, and its values: 10,20,50 or 0.1..0.9:9 or "
                   "1/1000..1/10:log:20",
                   "KEY=VALUES");
    add_repeatable("--metric", line.metrics, "measure this in place of the usual metrics", "M");
    add("--sample", typed.samples, "draw N points of the space in place of its full grid", "N");
    add("--seed", typed.seed, "seed of the draws; the same seed draws the same", "S");
    add_repeatable("--within", line.within, "a bound: 1mm (position), 1mrad (orientation), 2% energy, or METRIC=VALUE",
                   "BOUND");
  }

  // Options of robots' files; see kImportOptions.
  void add_imports() const {
    add_flag("--ground", line.import.ground, "put a plane under a robot's file");
    add("--keyframe", line.import.keyframe, "start an MJCF model from this keyframe", "NAME");
    add_flag("--lossy", line.import.lossy, "accept that the import of a robot's file loses physics");
    add_flag("--repair-inertia", line.import.repair_inertia, "replace inertias that no body can have by the nearest");
  }

  // Options of files and formats.
  void add_files() const {
    add("--factor", typed.factor, fmt::format("ignore errors that grow by less; default: {}", typed.factor), "F");
    add("--regression", line.regression, "print the values of this engine for adapters/ENGINE/regression.jsonl",
        "ENGINE");
    add_flag("--json", line.json, "print JSON");
    if (row.name == "export") {
      add("--format", line.format, choices_of(scene_formats()), "F");
    } else {
      add("--format", line.format, choices_of(trace_formats()) + "; default: csv", "F");
    }
    add("--file", line.file, "the history's file; default: history.jsonl", "FILE");
    add("--page", line.page, "also draw the history as a page", "FILE.html");
    add("--deviations", line.adapters_dir, "folder of ENGINE/known_deviations.toml; default: Rigor's own", "DIR");
    add("--suite", line.suite_dir, "folder of the cases; default: Rigor's own", "DIR");
  }
};

}  // namespace

std::vector<std::string> with_import_options(std::vector<std::string> options) {
  options.insert(options.end(), {"--ground", "--keyframe", "--lossy", "--repair-inertia"});
  std::sort(options.begin(), options.end());
  return options;
}

void add_options(CLI::App& command, const CommandRow& row, CommandLine& line, Typed& typed) {
  if (!row.words.empty()) command.add_option(row.words, line.words, row.words_summary);
  const Options options{command, row, line, typed};
  options.add_runs(), options.add_ways_to_run(), options.add_searches(), options.add_imports(), options.add_files();
}

}  // namespace rigor
