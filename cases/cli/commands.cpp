#include "cases/cli/commands.h"

#include <algorithm>

namespace rigor::inline cli {

// One declaration and one row a command; each is defined in the file of its name.
CommandRow baseline_row();
CommandRow compare_row();
CommandRow completion_row();
CommandRow conform_row();
CommandRow diagnose_row();
CommandRow diverge_row();
CommandRow export_row();
CommandRow fit_row();
CommandRow gate_row();
CommandRow history_row();
CommandRow import_row();
CommandRow list_row();
CommandRow merge_row();
CommandRow new_row();
CommandRow open_row();
CommandRow play_row();
CommandRow repeat_row();
CommandRow run_row();
CommandRow settle_row();
CommandRow show_row();
CommandRow site_row();
CommandRow sweep_row();
CommandRow trace_row();
CommandRow truth_row();
CommandRow tune_row();

std::vector<OptionFact> options_of(const CommandRow& row) {
  const std::unique_ptr<Command> command = row.make();
  Options options(1);
  command->declare(options);
  std::vector<OptionFact> facts;
  for (const Options::Row& option : options.rows()) facts.push_back(option.fact);
  std::sort(facts.begin(), facts.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return facts;
}

bool has_option(const CommandRow& row, const std::string& name) {
  const std::vector<OptionFact> options = options_of(row);
  return std::any_of(options.begin(), options.end(), [&](const OptionFact& fact) { return fact.name == name; });
}

const std::vector<NamedFact>& exit_codes() {
  static const std::vector<NamedFact> table = {{"0", "good"},
                                               {"1", "a gate failed or a result got worse"},
                                               {"2", "bad usage or bad input"},
                                               {"3", "an engine or Rigor itself failed"}};
  return table;
}

const std::vector<NamedFact>& environment_variables() {
  static const std::vector<NamedFact> table = {
      {"RIGOR_DATA", "the folder of recordings that cases name and do not bring along"},
      {"RIGOR_HOME", "the folder of suite/ and adapters/, in place of Rigor's own"},
      {"RIGOR_PLUGINS", "engines from outside, separated by colons; see --plugin"},
      {"COLUMNS", "the width of tables, 60 to 100"}};
  return table;
}

const std::vector<CommandRow>& commands() {
  static const std::vector<CommandRow> table = {
      list_row(),     run_row(),      gate_row(),    sweep_row(),      tune_row(),   fit_row(),  merge_row(),
      compare_row(),  baseline_row(), history_row(), site_row(),       open_row(),   play_row(), trace_row(),
      truth_row(),    new_row(),      import_row(),  export_row(),     settle_row(), show_row(), conform_row(),
      diagnose_row(), diverge_row(),  repeat_row(),  completion_row(),
  };
  return table;
}

}  // namespace rigor::inline cli
