// rigor open: shows the report of the last run in the browser, by the desktop's xdg-open.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cstring>
#include <filesystem>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "core/base/error.h"

extern char** environ;

namespace rigor {
namespace {

// Returns why the browser did not open; empty if it did.
std::string why_not_shown(const std::string& file) {
  std::string program = "xdg-open", argument = file;
  const std::array<char*, 3> words = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (const int error = posix_spawnp(&child, program.c_str(), nullptr, nullptr, words.data(), environ))
    return fmt::format("xdg-open cannot be started: {}", std::strerror(error));
  int status = 0;
  if (waitpid(child, &status, 0) != child) return "xdg-open was lost";
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  return "xdg-open found no browser";
}

class OpenCommand : public Command {
 public:
  void declare(Options& options) override { out_.declare(options); }

  int run(const Invocation&) override {
    std::error_code error;
    const std::filesystem::path file =
        std::filesystem::absolute(std::filesystem::path(out_.dir) / "report.html", error);
    if (error || !std::filesystem::is_regular_file(file, error))
      throw InputError(
          fmt::format("rigor open: there is no {}; 'rigor run' writes it, and --out names its folder", file.string()));
    const std::string why = why_not_shown(file.string());
    if (why.empty()) return kGood;
    say(fmt::format("{}; open this file in a browser: {}", why, file.string()));
    return kBroken;
  }

 private:
  OutOption out_;
};

}  // namespace

CommandRow open_row() {
  return {"open",
          "show the report of a run in the browser",
          "",
          "",
          {{"rigor open", "the report in out/"}, {"rigor open --out nightly", "the report in nightly/"}},
          make_command<OpenCommand>};
}

}  // namespace rigor
