// The program: what its command line asks for, done, and its exit code.
#pragma once

#include "cases/runner/executor.h"

namespace rigor {

// Returns an ExitCode, and says on stderr what went wrong. `executor`: of a grid's cases and a sweep's; null: processes
// of this machine. Throws Interrupted.
int run_program(int argc, const char* const* argv, const Executor* executor = nullptr);

}  // namespace rigor
