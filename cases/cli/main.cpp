// rigor: parse, run, answer with an exit code: 0 good, 1 a gate failed, 2 bad usage or input, 3 an engine or Rigor
// failed.
#include <algorithm>
#include <csignal>
#include <exception>

#include "adapters/plugin/plugins.h"
#include "cases/cli/command_line.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/runner/process_pool.h"
#include "core/base/error.h"

namespace {

// Those of the program and, for a command that takes them, those from outside.
rigor::EngineTable engines_for(const rigor::CommandRow& row, const rigor::CommandLine& line) {
  rigor::EngineTable table = rigor::built_in_engines();
  if (std::find(row.options.begin(), row.options.end(), "--plugin") == row.options.end()) return table;
  std::vector<std::string> plugins = rigor::plugins_of_environment();
  plugins.insert(plugins.end(), line.plugins.begin(), line.plugins.end());
  for (auto plugin = plugins.begin(); plugin != plugins.end(); ++plugin) {
    if (std::find(plugins.begin(), plugin, *plugin) == plugin) rigor::add_plugin(table, *plugin, line.limit);
  }
  return table;
}

int answer(int argc, const char* const* argv) {
  const rigor::CommandLine line = rigor::parse_command_line(argc, argv);
  if (!line.printed.empty()) return rigor::print_table(line.printed), rigor::kGood;
  for (const rigor::CommandRow& row : rigor::commands()) {
    if (row.name == line.command) return row.run(line, engines_for(row, line));
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
