#include "cases/cli/browser.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cstring>

extern char** environ;

namespace rigor::inline cli {

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

}  // namespace rigor::inline cli
