#include "cases/cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>
#include <thread>

#include "cases/cli/help.h"
#include "cases/report/json/commit.h"
#include "cases/report/json/machine.h"
#include "core/base/error.h"
#include "core/base/names_of.h"
#include "core/base/near_match.h"

namespace rigor::inline cli {
namespace {

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

// Refuses a word that no option or command took.
[[noreturn]] void refuse_word(const std::string& word, const CommandRow* row) {
  const bool is_option = word.starts_with("-");
  if (!row && !is_option) {
    throw InputError(fmt::format("there is no command '{}'{}; there is: {}", word,
                                 did_you_mean(word, names_of(commands())), listed(names_of(commands()))));
  }
  std::vector<std::string> known;
  if (!row) known.push_back("--version");
  for (const OptionFact& fact : row ? options_of(*row) : std::vector<OptionFact>()) known.push_back(fact.name);
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

// The values of one option as typed. They are read later, so that an unknown option is reported first.
struct Typed {
  std::string text;
  std::vector<std::string> texts;  // of an option that may be repeated
  bool is_set = false;             // of a flag
};

void declare_to(CLI::App& app, const CommandRow& row, const Options& options, std::vector<Typed>& typed) {
  app.set_help_flag("-h,--help", "print this and exit");
  app.allow_extras();
  if (options.words()) app.add_option(row.words, *options.words(), row.words_summary);
  typed.resize(options.rows().size());
  for (std::size_t i = 0; i < typed.size(); ++i) {
    const Options::Row& option = options.rows()[i];
    if (option.fact.type.empty()) {
      app.add_flag(option.fact.name, typed[i].is_set);
      continue;
    }
    // A repeatable option takes one value each time, or it would swallow the cases that follow.
    CLI::Option* added = option.repeats == Options::Repeats::yes
                             ? app.add_option(option.fact.name, typed[i].texts)->allow_extra_args(false)
                             : app.add_option(option.fact.name, typed[i].text);
    added->type_name(option.fact.type)->check(CLI::Validator(refuse_empty_or_option, ""));
  }
}

void read_typed(const Options& options, const std::vector<Typed>& typed) {
  for (std::size_t i = 0; i < typed.size(); ++i) {
    const Options::Row& option = options.rows()[i];
    if (typed[i].is_set) option.read("");
    if (!typed[i].text.empty()) option.read(typed[i].text);
    for (const std::string& text : typed[i].texts) option.read(text);
  }
  options.end_reading();
}

int cores() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

// A row of the table, with the command that it makes.
struct Declared {
  const CommandRow& row;
  std::unique_ptr<Command> command;
  std::shared_ptr<Options> options;
  std::vector<Typed> typed;
};

}  // namespace

int CommandLine::run() const {
  options->prepare_run();
  return command->run(invocation);
}

CommandLine parse_command_line(int argc, const char* const* argv, int jobs) {
  CLI::App app("", "rigor");
  app.set_version_flag("--version", "rigor " RIGOR_VERSION);
  app.set_help_flag("-h,--help", "print this and exit");
  app.allow_extras();
  app.require_subcommand(0, 1);  // after the first, the name of a command is a word like others
  std::deque<Declared> all;
  for (const CommandRow& row : commands()) {
    Declared& declared = all.emplace_back(row, row.make(), std::make_shared<Options>(jobs > 0 ? jobs : cores()));
    declared.command->declare(*declared.options);
    declare_to(*app.add_subcommand(row.name, row.summary), row, *declared.options, declared.typed);
  }
  const std::vector<std::string> words = words_of(argc, argv);
  refuse_empty_words(words);
  CommandLine line;
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    line.printed = chosen.empty() ? help_text() : help_text(*find_command(chosen.front()->get_name()));
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
  for (Declared& declared : all) {
    if (&declared.row != row) continue;
    read_typed(*declared.options, declared.typed);
    line = {{row->name, arguments_of(words)}, std::move(declared.command), "", declared.options};
  }
  return line;
}

}  // namespace rigor::inline cli
