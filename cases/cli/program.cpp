#include "cases/cli/program.h"

#include <algorithm>
#include <csignal>
#include <exception>
#include <stdexcept>

#include "adapters/plugin/plugins.h"
#include "cases/case/suite.h"
#include "cases/cli/command_line.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/report/wording/printed_command.h"
#include "core/base/error.h"
#include "core/base/json_words.h"

namespace rigor {
namespace {

// The built-in engines, and those from outside if the command takes them.
EngineTable engines_for(const CommandRow& row, const CommandLine& line) {
  EngineTable table = built_in_engines();
  if (std::find(row.options.begin(), row.options.end(), "--plugin") == row.options.end()) return table;
  std::vector<std::string> plugins = plugins_of_environment();
  plugins.insert(plugins.end(), line.plugins.begin(), line.plugins.end());
  for (auto plugin = plugins.begin(); plugin != plugins.end(); ++plugin) {
    if (std::find(plugins.begin(), plugin, *plugin) == plugin) add_plugin(table, *plugin, line.limit);
  }
  return table;
}

int answer(int argc, const char* const* argv, const Executor* executor) {
  // Each of several processes is one job already.
  CommandLine line = parse_command_line(argc, argv, executor ? 1 : 0);
  line.executor = executor;
  for (const CommandRow& row : commands()) {
    const bool is_shared = std::find(row.options.begin(), row.options.end(), "--shard") != row.options.end();
    if (!leads(line) && (!line.printed.empty() || (row.name == line.command && !is_shared))) throw Dismissed();
    if (!line.printed.empty() || row.name != line.command) continue;
    if (!line.suite_dir.empty() && line.suite_dir != default_suite_dir()) use_suite(line.suite_dir);
    use_imports(line.import);
    return row.run(line, engines_for(row, line));
  }
  return print_table(line.printed), kGood;
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
  const auto takes_resume = [&](const CommandRow& row) {
    return row.name == name && std::find(row.options.begin(), row.options.end(), "--resume") != row.options.end();
  };
  const bool can_resume = std::any_of(commands().begin(), commands().end(), takes_resume);
  return can_resume ? "interrupted; no output was changed. The same command with --resume continues the run"
                    : "interrupted; no output was changed";
}

}  // namespace rigor
