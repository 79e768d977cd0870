#include "cases/cli/commands.h"

namespace rigor {

// One declaration and one row a command; each is defined in the file of its name.
CommandRow baseline_row();
CommandRow compare_row();
CommandRow completion_row();
CommandRow conform_row();
CommandRow diagnose_row();
CommandRow export_row();
CommandRow gate_row();
CommandRow history_row();
CommandRow import_row();
CommandRow list_row();
CommandRow merge_row();
CommandRow new_row();
CommandRow open_row();
CommandRow run_row();
CommandRow settle_row();
CommandRow sweep_row();
CommandRow trace_row();
CommandRow truth_row();
CommandRow tune_row();

const std::vector<CommandRow>& commands() {
  static const std::vector<CommandRow> table = {
      list_row(),     run_row(),     gate_row(),    sweep_row(),    tune_row(),       merge_row(), compare_row(),
      baseline_row(), history_row(), open_row(),    trace_row(),    truth_row(),      new_row(),   import_row(),
      export_row(),   settle_row(),  conform_row(), diagnose_row(), completion_row(),
  };
  return table;
}

}  // namespace rigor
