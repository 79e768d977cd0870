#include "adapters/plugin/plugins.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "adapters/plugin/library_engine.h"
#include "adapters/plugin/process_engine.h"
#include "core/base/content_hash.h"
#include "core/base/error.h"

namespace rigor::inline adapters {
namespace {

// Our own stderr, kept: in a cell's process descriptor 2 is something else.
int log_descriptor() {
  static const int descriptor = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  return descriptor;
}

// The plug-in's name and its files, as far as its words name files. A run does not continue the results of another
// version.
std::string identity_of(const std::string& plugin) {
  std::uint64_t hash = content_hash(plugin);
  std::istringstream words(plugin);
  for (std::string word; words >> word;) {
    std::error_code none;
    if (std::filesystem::is_regular_file(word, none)) hash = hash_of_file(word, hash);
  }
  return fmt::format("{} {:016x}", plugin, hash);
}

std::unique_ptr<Engine> engine_of(const std::string& plugin, double limit) {
  if (plugin.ends_with(".so")) return std::make_unique<LibraryEngine>(plugin, limit);
  return std::make_unique<ProcessEngine>(PluginStart{plugin, limit, log_descriptor()});
}

std::map<std::string, std::string>& plugins_by_engine() {
  static std::map<std::string, std::string> plugins;
  return plugins;
}

}  // namespace

std::string plugin_of(const std::string& engine) {
  const auto found = plugins_by_engine().find(engine);
  return found == plugins_by_engine().end() ? "" : found->second;
}

void add_plugin(EngineTable& table, const std::string& plugin, double limit) {
  if (plugin.find_first_not_of(" \t") == std::string::npos)
    throw InputError("a plug-in is a path that ends in .so, or a command line; this one is empty");
  std::unique_ptr<Engine> engine = engine_of(plugin, limit);
  const std::string name = engine->info().name;
  try {
    table.add(std::move(engine), identity_of(plugin));
    plugins_by_engine()[name] = plugin;
  } catch (const InputError& error) {
    throw InputError(fmt::format("plug-in '{}': {}", plugin, error.what()));
  }
}

std::vector<std::string> plugins_of_environment() {
  const char* value = std::getenv("RIGOR_PLUGINS");
  std::vector<std::string> plugins;
  std::istringstream parts(value ? value : "");
  for (std::string part; std::getline(parts, part, ':');) {
    if (!part.empty()) plugins.push_back(part);
  }
  return plugins;
}

}  // namespace rigor::inline adapters
