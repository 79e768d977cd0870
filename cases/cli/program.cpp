#include "cases/cli/program.h"

#include <algorithm>
#include <csignal>
#include <exception>
#include <stdexcept>

#include "cases/cli/command_line.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "core/base/error.h"
#include "core/base/json_words.h"

namespace rigor::inline cli {
namespace {

int answer(int argc, const char* const* argv, const Executor* executor) {
  // Each of several processes is one job already.
  CommandLine line = parse_command_line(argc, argv, executor ? 1 : 0);
  line.invocation.executor = executor;
  const bool is_shared = line.command && line.command->shared();
  if (!line.invocation.leads() && !is_shared) throw Dismissed();
  return line.command ? line.run() : (print_table(line.printed), int{kGood});
}

// Only one of several processes speaks.
int refuse(const std::string& why, ExitCode code, const Executor* executor) {
  if (executor && !executor->leads()) {
    executor->stay_out(why);
  } else {
    say(why);
  }
  return code;
}

}  // namespace

int run_program(int argc, const char* const* argv, const Executor* executor) {
  // A write then fails with a reason, which is reported.
  std::signal(SIGPIPE, SIG_IGN), std::signal(SIGXFSZ, SIG_IGN);
  try {
    take_standard_streams();
    return answer(argc, argv, executor);
  } catch (const InputError& error) {
    return refuse(error.what(), kBadInput, executor);
  } catch (const std::exception& error) {
    return refuse(in_words(error), kBroken, executor);
  } catch (const Dismissed&) {
    executor->stay_out("");
    return kGood;
  }
}

std::string interruption_text(int argc, const char* const* argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  const bool can_resume = std::any_of(commands().begin(), commands().end(), [&](const CommandRow& row) {
    return row.name == name && has_option(row, "--resume");
  });
  return can_resume ? "interrupted; no output was changed. The same command with --resume continues the run"
                    : "interrupted; no output was changed";
}

}  // namespace rigor::inline cli
