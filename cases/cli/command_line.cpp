#include "cases/cli/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <thread>

#include "cases/case/suite.h"
#include "cases/cli/commands.h"
#include "cases/cli/help.h"
#include "cases/cli/options.h"
#include "cases/gates/deviations.h"
#include "cases/report/json/commit.h"
#include "cases/report/json/machine.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor {
namespace {

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

// An option without a value would take the next option as its value. A variable that is not set leaves an empty value.
std::string refuse_empty_or_option(std::string& value) {
  if (value.empty()) return "needs a value, and what is given is empty";
  return value.starts_with("--") ? fmt::format("needs a value, and '{}' follows", value) : "";
}

// "--out=" would take the next word as its value.
void refuse_empty_words(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word.starts_with("--") && word.ends_with("="))
      throw InputError(fmt::format("{}: needs a value, and what is given is empty", word.substr(0, word.size() - 1)));
  }
}

// Without the options in which the parts of one grid may differ.
std::vector<std::string> arguments_of(const std::vector<std::string>& words) {
  const std::vector<std::string> differ = {"--jobs", "--out", "--shard"};
  const auto is_one = [&](const std::string& word) {
    return std::find(differ.begin(), differ.end(), word) != differ.end();
  };
  std::vector<std::string> arguments;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
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

// Refuses a word that no option or command took.
[[noreturn]] void refuse_word(const std::string& word, const CommandRow* row) {
  const bool is_option = word.starts_with("-");
  if (!row && !is_option) {
    throw InputError(fmt::format("there is no command '{}'{}; there is: {}", word, did_you_mean(word, command_names()),
                                 listed(command_names())));
  }
  std::vector<std::string> known = row ? row->options : std::vector<std::string>{"--version"};
  known.insert(known.end(), {"--help", "-h"});
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

// The words after the program's name. "help" and "version" stand for the options of these names.
std::vector<std::string> words_of(int argc, const char* const* argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.size() == 1 && words[0] == "version") return {"--version"};
  if (words.empty() || words[0] != "help") return words;
  if (words.size() == 1) return {"--help"};
  if (!find_command(words[1])) refuse_word(words[1], nullptr);
  return {words[1], "--help"};
}

// Looked for only where a command reads them: a wrong RIGOR_HOME must not stop --help.
void take_default_folders(const CommandRow& row, CommandLine& line) {
  const auto takes = [&](const char* option) {
    return std::find(row.options.begin(), row.options.end(), option) != row.options.end();
  };
  if (takes("--suite") && line.suite_dir.empty()) line.suite_dir = default_suite_dir();
  if (takes("--deviations") && line.adapters_dir.empty()) line.adapters_dir = default_adapters_dir();
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
  CLI::App app("", "rigor");
  app.set_version_flag("--version", "rigor " RIGOR_VERSION);
  app.set_help_flag("-h,--help", "print this and exit");
  app.allow_extras();
  for (const CommandRow& row : commands()) {
    CLI::App* command = app.add_subcommand(row.name, row.summary);
    command->set_help_flag("-h,--help", "print this and exit");
    command->allow_extras();
    add_options(*command, row, line, typed);
    for (CLI::Option* option : command->get_options([](const CLI::Option* o) { return o->get_expected_max() > 0; })) {
      option->check(CLI::Validator(refuse_empty_or_option, ""));
    }
  }
  const std::vector<std::string> words = words_of(argc, argv);
  refuse_empty_words(words);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    line.printed = chosen.empty() ? help_text() : help_text(*find_command(chosen.front()->get_name()), *chosen.front());
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
  if (!row) throw InputError(first_steps());
  line.command = row->name;
  line.arguments = arguments_of(words);
  read_typed(typed, line);
  take_default_folders(*row, line);
  return line;
}

}  // namespace rigor
