#include "cases/cli/paste.h"

#include <cctype>

#include "cases/case/suite.h"

namespace rigor {

std::string shell_word(const std::string& text) {
  const std::string plain = "_@%+=:,./-";
  bool is_plain = !text.empty();
  for (const char c : text)
    is_plain = is_plain && (std::isalnum(static_cast<unsigned char>(c)) || plain.find(c) != std::string::npos);
  if (is_plain) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string same_sources(const CommandLine& line) {
  std::string options;
  if (!line.suite_dir.empty() && line.suite_dir != default_suite_dir())
    options += " --suite " + shell_word(line.suite_dir);
  for (const std::string& plugin : line.plugins) options += " --plugin " + shell_word(plugin);
  return options;
}

}  // namespace rigor
