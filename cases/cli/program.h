// The program: does what its command line says and returns the exit code.
#pragma once

#include <string>

#include "cases/runner/executor.h"

namespace rigor::inline cli {

// Returns an ExitCode and says on stderr what went wrong. `executor` runs the cases of a grid and the rows of a sweep;
// null: processes of this machine. Throws Interrupted.
int run_program(int argc, const char* const* argv, const Executor* executor = nullptr);

// The message after Interrupted. Names --resume only if the command takes it.
std::string interruption_text(int argc, const char* const* argv);

}  // namespace rigor::inline cli
