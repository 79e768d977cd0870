#include "cases/cli/commands.h"

namespace rigor {

const std::vector<CommandRow>& commands() {
  static const std::vector<std::string> grid_options = {"--deviations", "--dt",     "--duration", "--engine",
                                                        "--jobs",       "--out",    "--plugin",   "--resume",
                                                        "--suite",      "--timeout"};
  static const std::vector<std::string> gate_options = {"--deviations", "--dt",    "--duration", "--engine",
                                                        "--jobs",       "--out",   "--plugin",   "--quick",
                                                        "--resume",     "--suite", "--timeout"};
  static const std::string grid_words = "cases by id, family, file or folder; default: the whole suite";
  static const std::vector<CommandRow> table = {
      {"list",
       "say what there is",
       "KIND",
       "cases, engines, integrators, metrics or truths; default: all",
       {"--plugin", "--suite"},
       list_command},
      {"run", "simulate and judge; print the table and write the reports", "CASE", grid_words, grid_options,
       run_command},
      {"gate", "the same, and exit 1 if a gate does not hold", "CASE", grid_words, gate_options, gate_command},
      {"compare",
       "say what got better or worse from one result to another; exit 1 if worse",
       "FILE",
       "OLD and NEW, each a results.json or a baseline",
       {"--factor"},
       compare_command},
      {"baseline",
       "print a result's short form, one line a cell, to keep and to compare with",
       "FILE",
       "a results.json",
       {"--regression"},
       baseline_command},
      {"trace",
       "print one run's trajectory as CSV",
       "CASE",
       "a case or a file",
       {"--dt", "--duration", "--engine", "--every", "--plugin", "--suite", "--timeout"},
       trace_command},
      {"truth",
       "print the truth's states, and its own error, as CSV",
       "CASE",
       "a case or a file",
       {"--duration", "--suite", "--timeout", "--times"},
       truth_command},
      {"settle",
       "print a case file with the nearest initial velocities that its joints allow",
       "FILE",
       "a case file",
       {},
       settle_command},
      {"conform",
       "say whether an engine, one from outside above all, does what the seam asks; exit 1 if not",
       "",
       "",
       {"--engine", "--json", "--plugin", "--timeout"},
       conform_command},
  };
  return table;
}

}  // namespace rigor
