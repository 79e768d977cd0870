#include "cases/cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <thread>

#include "cases/case/suite.h"
#include "cases/cli/commands.h"
#include "cases/gates/deviations.h"
#include "cases/report/json/commit.h"
#include "cases/report/json/machine.h"
#include "cases/results/changes.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor {
namespace {

// As typed; numbers are read afterwards, so that each is refused in the same words as one in a case file.
struct Typed {
  std::vector<std::string> dt;
  std::string duration, jobs, shard, samples, seed, every = "1", limit = "120", times,
                                                    factor = fmt::format("{:g}", kDefaultFactor);
};

int parse_count(const std::string& text, const std::string& what, int most = 100000) {
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1 || count > most) {
    throw InputError(fmt::format("{}: '{}' is not a whole number from 1 to {}", what, text, most));
  }
  return count;
}

double parse_factor(const std::string& text) {
  double factor = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
  if (error != std::errc() || end != text.data() + text.size() || !(factor >= 1) || !std::isfinite(factor))
    throw InputError(fmt::format("--factor: '{}' is not a number of 1 or more", text));
  return factor;
}

std::vector<double> parse_times(const std::string& text) {
  std::vector<double> times;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string word = text.substr(at, comma - at);
    const bool is_zero =
        !word.empty() && word.find_first_not_of("0.") == std::string::npos && word.find('0') != std::string::npos;
    times.push_back(is_zero ? 0.0 : parse_step_size(word, "--times").seconds);
    at = comma + 1;
  }
  return times;
}

// The options of a command that its row takes.
struct Options {
  CLI::App& command;
  const CommandRow& row;
  CommandLine& line;
  Typed& typed;

  bool takes(const char* option) const {
    return std::find(row.options.begin(), row.options.end(), option) != row.options.end();
  }

  // What runs, and for how long.
  void add_runs() const {
    if (takes("--engine")) {
      command.add_option("--engine", line.engines, "ENGINE[:METHOD][,key=value...][@TRACK]; may be repeated")
          ->allow_extra_args(false)
          ->type_name("E");
    }
    if (takes("--plugin")) {
      command
          .add_option(
              "--plugin", line.plugins,
              "an engine from outside: a path that ends in .so, or a command line; may be repeated. RIGOR_PLUGINS "
              "names more, separated by colons")
          ->allow_extra_args(false)
          ->type_name("P");
    }
    if (takes("--dt")) {
      command.add_option("--dt", typed.dt, "step size in s, a number or a fraction such as 1/30; may be repeated")
          ->allow_extra_args(false)
          ->type_name("DT");
    }
    if (takes("--duration")) command.add_option("--duration", typed.duration, "length of the run in s")->type_name("S");
    if (takes("--every")) command.add_option("--every", typed.every, "only each N-th sample")->type_name("N");
    if (takes("--times")) {
      command.add_option("--times", typed.times, "instants in s; default: the run, in its coarsest steps")
          ->type_name("T,T...");
    }
  }

  // How a grid is run, and where to.
  void add_ways_to_run() const {
    if (takes("--jobs")) command.add_option("--jobs", typed.jobs, "cells at once; default: one a core")->type_name("N");
    if (takes("--out"))
      command.add_option("--out", line.out, "folder for the reports")->type_name("DIR")->capture_default_str();
    if (takes("--timeout")) {
      command.add_option("--timeout", typed.limit, "seconds of CPU time that a cell, or a truth, may take")
          ->type_name("S")
          ->capture_default_str();
    }
    if (takes("--shard")) {
      command.add_option("--shard", typed.shard, "only the K-th of N parts of the grid, for 'rigor merge'")
          ->type_name("K/N");
    }
    if (takes("--resume"))
      command.add_flag("--resume", line.resume, "go on from where a run to the same folder was stopped");
    if (takes("--quick"))
      command.add_flag("--quick", line.quick, "only gates whose cells take a moment; for each change, not each night");
  }

  // What a sweep or a tuning looks at.
  void add_searches() const {
    if (takes("--vary")) {
      command
          .add_option(
              "--vary", line.vary,
              "dt, duration, a method's option or a path below scene, and its values: 10,20,50 or 0.1..0.9:9 or "
              "1/1000..1/10:log:20; may be repeated")
          ->allow_extra_args(false)
          ->type_name("KEY=VALUES");
    }
    if (takes("--metric")) {
      command.add_option("--metric", line.metrics, "measure this and not the usual ones; may be repeated")
          ->allow_extra_args(false)
          ->type_name("M");
    }
    if (takes("--sample"))
      command.add_option("--sample", typed.samples, "draw N points of the space instead of its full grid")
          ->type_name("N");
    if (takes("--seed"))
      command.add_option("--seed", typed.seed, "of what is drawn; the same seed draws the same")->type_name("S");
    if (takes("--within")) {
      command
          .add_option("--within", line.within,
                      "a bound: 1mm (position), 1mrad (orientation), 2% energy, or METRIC=VALUE; may be repeated")
          ->allow_extra_args(false)
          ->type_name("BOUND");
    }
  }

  // What else is read, and what is printed.
  void add_files() const {
    if (takes("--factor")) {
      command.add_option("--factor", typed.factor, "errors that grow by no more than this are noise")
          ->type_name("F")
          ->capture_default_str();
    }
    if (takes("--regression")) {
      command
          .add_option("--regression", line.regression,
                      "print what the regressions found of this engine instead, for adapters/ENGINE/regression.jsonl")
          ->type_name("ENGINE");
    }
    if (takes("--json")) command.add_flag("--json", line.json, "print JSON instead");
    if (takes("--keyframe"))
      command.add_option("--keyframe", line.keyframe, "of an MJCF file: start from this one, not from the model's own")
          ->type_name("NAME");
    if (takes("--format")) {
      command
          .add_option("--format", line.format,
                      row.name == "export" ? "mjcf or sdf" : "csv (the default), gltf, jsonl or mcap")
          ->type_name("F");
    }
    if (takes("--file"))
      command.add_option("--file", line.file, "the history's file")->type_name("FILE")->capture_default_str();
    if (takes("--page")) command.add_option("--page", line.page, "draw it there as a page too")->type_name("FILE.html");
    if (takes("--deviations")) {
      command.add_option("--deviations", line.adapters_dir, "folder of ENGINE/known_deviations.toml")
          ->type_name("DIR")
          ->capture_default_str();
    }
    if (takes("--suite")) {
      command.add_option("--suite", line.suite_dir, "folder of the cases")->type_name("DIR")->capture_default_str();
    }
  }
};

void add_options(CLI::App& command, const CommandRow& row, CommandLine& line, Typed& typed) {
  if (!row.words.empty()) command.add_option(row.words, line.words, row.words_summary);
  // Options that may be repeated take one value each time, or they would swallow the cases that follow.
  const Options options{command, row, line, typed};
  options.add_runs(), options.add_ways_to_run(), options.add_searches(), options.add_files();
}

// An option without its value would take the next option for one; and an empty value, which a variable that is not set
// leaves behind, does not count as none.
std::string refuse_empty_or_option(std::string& value) {
  if (value.empty()) return "needs a value, and what is given is empty";
  return value.starts_with("--") ? fmt::format("needs a value, and '{}' follows", value) : "";
}

// "--out=" would take the next word for its value, and an empty word means no case.
void refuse_empty_words(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("--") && word.ends_with("="))
      throw InputError(fmt::format("{}: needs a value, and what is given is empty", word.substr(0, word.size() - 1)));
  }
}

// What two parts of one grid may be asked differently is left out.
std::vector<std::string> arguments_of(int argc, const char* const* argv) {
  const std::vector<std::string> differ = {"--jobs", "--out", "--shard"};
  const auto is_one = [&](const std::string& word) {
    return std::find(differ.begin(), differ.end(), word) != differ.end();
  };
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (is_one(word)) {
      ++i;
    } else if (!is_one(word.substr(0, word.find('='))) && word != "--resume") {
      arguments.push_back(word);
    }
  }
  return arguments;
}

// The compiler, and each engine with its precision.
std::string versions_of_parts() {
  const Machine machine = this_machine();
  std::string text = commit().empty() ? "" : fmt::format("commit {}\n", commit());
  text += fmt::format("{}, {}\n", machine.compiler, machine.build_type);
  for (const EngineInfo& engine : engines().infos())
    text += fmt::format("{} {}, {} precision\n", engine.name, engine.version, engine.precision);
  return text;
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const CommandRow& row : commands()) names.push_back(row.name);
  return names;
}

// What no option or command took.
[[noreturn]] void refuse_word(const std::string& word, const CommandRow* row) {
  const bool is_option = word.starts_with("-");
  if (!row && !is_option) {
    throw InputError(fmt::format("there is no command '{}'{}; there is: {}", word, did_you_mean(word, command_names()),
                                 listed(command_names())));
  }
  std::vector<std::string> known = row ? row->options : std::vector<std::string>{"--version"};
  known.push_back("--help");
  const std::string name = word.substr(0, word.find('='));
  if (is_option) {
    throw InputError(fmt::format("{} has no option '{}'{}; it has: {}", row ? "rigor " + row->name : "rigor", name,
                                 did_you_mean(name, known), listed(known)));
  }
  throw InputError(fmt::format("rigor {}: '{}' is one word too many", row->name, word));
}

const CommandRow* find_command(const std::string& name) {
  for (const CommandRow& row : commands()) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

void read_typed(const Typed& typed, CommandLine& line) {
  for (const std::string& text : typed.dt) {
    const StepSize dt = parse_step_size(text, "--dt");
    if (std::find(line.dt.begin(), line.dt.end(), dt) == line.dt.end()) line.dt.push_back(dt);
  }
  if (!typed.duration.empty()) line.duration = parse_step_size(typed.duration, "--duration").seconds;
  if (!typed.jobs.empty()) line.jobs = parse_count(typed.jobs, "--jobs");
  line.every = parse_count(typed.every, "--every");
  line.limit = parse_step_size(typed.limit, "--timeout").seconds;
  line.factor = parse_factor(typed.factor);
  if (!typed.samples.empty()) line.samples = static_cast<std::size_t>(parse_count(typed.samples, "--sample", 1000000));
  if (!typed.seed.empty()) line.seed = static_cast<unsigned long>(parse_count(typed.seed, "--seed", 1000000000));
  if (!typed.shard.empty()) line.shard = parse_shard(typed.shard, "--shard");
  if (!typed.times.empty()) line.times = parse_times(typed.times);
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv, int jobs) {
  CommandLine line;
  line.jobs = jobs > 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  Typed typed;
  line.suite_dir = default_suite_dir(), line.adapters_dir = default_adapters_dir();
  CLI::App app("How right is a rigid-body simulator?", "rigor");
  app.set_version_flag("--version", "rigor " RIGOR_VERSION);
  app.set_help_flag("--help", "print this and leave");
  app.allow_extras();
  for (const CommandRow& row : commands()) {
    CLI::App* command = app.add_subcommand(row.name, row.summary);
    command->set_help_flag("--help", "print this and leave");
    command->allow_extras();
    add_options(*command, row, line, typed);
    for (CLI::Option* option : command->get_options([](const CLI::Option* o) { return o->get_expected_max() > 0; })) {
      option->check(CLI::Validator(refuse_empty_or_option, ""));
    }
  }
  refuse_empty_words(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    line.printed = chosen.empty() ? app.help() : chosen.front()->help();
    return line;
  } catch (const CLI::CallForVersion&) {
    line.printed = app.version() + "\n" + versions_of_parts();
    return line;
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  }
  const auto chosen = app.get_subcommands();
  const auto unknown = app.remaining(true);
  const CommandRow* row = chosen.empty() ? nullptr : find_command(chosen.front()->get_name());
  if (!unknown.empty()) refuse_word(unknown.front(), row);
  if (!row)
    throw InputError(
        fmt::format("what to do? To begin with:\n"
                    "  rigor run springs/fixed-spring   one case by every engine, and a report in out/\n"
                    "  rigor list                       what there is\n"
                    "  rigor new my-case                a case of your own, which runs\n"
                    "  rigor gate --quick               exit code 1 where an engine is not as right as it was\n"
                    "Of all commands ({}) rigor --help says more",
                    listed(command_names())));
  line.command = row->name;
  line.arguments = arguments_of(argc, argv);
  read_typed(typed, line);
  return line;
}

}  // namespace rigor
