#include "cases/case/program_home.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"

namespace rigor::inline cases {

std::string home_folder(const std::string& inside, const std::string& as_built) {
  namespace fs = std::filesystem;
  const char* home = std::getenv("RIGOR_HOME");
  std::error_code error;
  if (home && *home) {
    const fs::path named = fs::path(home) / inside;
    if (fs::is_directory(named, error)) return named.string();
    throw InputError(fmt::format("RIGOR_HOME is '{}', in which there is no folder '{}'", home, inside));
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "rigor" / inside;
  return !error && fs::is_directory(installed, error) ? installed.string() : as_built;
}

}  // namespace rigor::inline cases
