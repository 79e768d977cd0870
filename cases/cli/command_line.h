// A command line: the command with its options, read.
#pragma once

#include <memory>
#include <string>

#include "cases/cli/commands.h"

namespace rigor::inline cli {

struct CommandLine {
  Invocation invocation;
  std::unique_ptr<Command> command;  // null if there is only something to print
  std::string printed;               // --help or --version: what to print instead of doing anything

  // Does what the command line says. Returns an ExitCode.
  int run() const;
  std::shared_ptr<const Options> options;  // of the command
};

// Throws InputError with the nearest match of an unknown word. `jobs` is the default of --jobs; 0 means one a core.
CommandLine parse_command_line(int argc, const char* const* argv, int jobs = 0);

}  // namespace rigor::inline cli
