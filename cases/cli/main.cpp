// rigor: reads the command line, does what it says, exits with 0 good, 1 a gate failed, 2 bad usage or input, 3 an
// engine or Rigor failed.
#include <csignal>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/program.h"

int main(int argc, char** argv) {
  try {
    return rigor::run_program(argc, argv);
  } catch (const rigor::Interrupted& interruption) {
    rigor::say(rigor::interruption_text(argc, argv));
    std::signal(interruption.signal, SIG_DFL);
    std::raise(interruption.signal);
  }
  return rigor::kBroken;
}
