// rigor: parse, run, answer with an exit code: 0 good, 1 a gate failed, 2 bad usage or input, 3 an engine or Rigor
// failed.
#include <csignal>
#include <exception>

#include "cases/cli/command_line.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/runner/process_pool.h"
#include "core/base/error.h"

namespace {

int answer(int argc, const char* const* argv) {
  const rigor::CommandLine line = rigor::parse_command_line(argc, argv);
  if (!line.printed.empty()) return rigor::print_table(line.printed), rigor::kGood;
  for (const rigor::CommandRow& row : rigor::commands()) {
    if (row.name == line.command) return row.run(line, rigor::built_in_engines());
  }
  throw std::logic_error("a command that is not in the table");
}

}  // namespace

int main(int argc, char** argv) {
  // Such a write then fails with a reason, which is said.
  std::signal(SIGPIPE, SIG_IGN), std::signal(SIGXFSZ, SIG_IGN);
  try {
    rigor::take_standard_streams();
    return answer(argc, argv);
  } catch (const rigor::InputError& error) {
    rigor::say(error.what());
    return rigor::kBadInput;
  } catch (const rigor::Interrupted& interruption) {
    rigor::say("interrupted; no output was changed. What was computed is kept: --resume goes on from it");
    std::signal(interruption.signal, SIG_DFL);
    std::raise(interruption.signal);
  } catch (const std::exception& error) {
    rigor::say(error.what());
  }
  return rigor::kBroken;
}
