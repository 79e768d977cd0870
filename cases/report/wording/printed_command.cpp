#include "cases/report/wording/printed_command.h"

#include <algorithm>
#include <cctype>

#include "adapters/plugin/plugins.h"

namespace rigor::inline report {
namespace {

std::string& named_suite() {
  static std::string folder;
  return folder;
}

ImportOptions& imports_in_use() {
  static ImportOptions options;
  return options;
}

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || std::string("_-./:=,@%+").find(c) != std::string::npos;
}

std::string quoted_word(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::string pasted(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + quoted_word(word);
  return line;
}

void use_suite(const std::string& folder) { named_suite() = folder; }
void use_imports(const ImportOptions& options) { imports_in_use() = options; }

std::vector<std::string> where_from(const std::string& run) {
  std::vector<std::string> words;
  const std::string plugin = plugin_of(run.substr(0, run.find_first_of(":,@")));
  if (!plugin.empty()) words.insert(words.end(), {"--plugin", plugin});
  if (!named_suite().empty()) words.insert(words.end(), {"--suite", named_suite()});
  const ImportOptions& imports = imports_in_use();
  for (const auto& [is_used, option] : {std::pair{imports.ground, "--ground"},
                                        {imports.lossy, "--lossy"},
                                        {imports.repair_inertia, "--repair-inertia"}}) {
    if (is_used) words.emplace_back(option);
  }
  if (!imports.keyframe.empty()) words.insert(words.end(), {"--keyframe", imports.keyframe});
  return words;
}

std::string diagnose_command_text(const std::string& case_id, const std::string& run) {
  std::vector<std::string> words = {"rigor", "diagnose", case_id, "--engine", run};
  const std::vector<std::string> from = where_from(run);
  words.insert(words.end(), from.begin(), from.end());
  return pasted(words);
}

}  // namespace rigor::inline report
