// rigor completion: what a shell completes, and the manual's page, made from the table of commands and their --help.
#include <fmt/format.h>

#include <algorithm>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/report/json/machine.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor {
namespace {

std::vector<std::string> options_of(const CommandRow& row) {
  std::vector<std::string> options = row.options;
  options.push_back("--help");
  return options;
}

std::string bash(const EngineTable& engines) {
  std::vector<std::string> names, engine_names;
  for (const CommandRow& row : commands()) names.push_back(row.name);
  for (const EngineInfo& engine : engines.infos()) {
    engine_names.push_back(engine.name);
    for (const MethodInfo& method : engine.methods) engine_names.push_back(engine.name + "\\\\:" + method.name);
  }
  std::string text = fmt::format(
      "# rigor completion bash > /usr/share/bash-completion/completions/rigor\n_rigor() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} words=\"\"\n"
      "  if [ \"$COMP_CWORD\" = 1 ]; then words=\"{} --help --version\"; else\n    case ${{COMP_WORDS[1]}} in\n",
      fmt::join(names, " "));
  for (const CommandRow& row : commands())
    text += fmt::format("      {}) words=\"{}\" ;;\n", row.name, fmt::join(options_of(row), " "));
  return text + fmt::format(
                    "    esac\n  fi\n  [ \"${{COMP_WORDS[COMP_CWORD-1]}}\" = --engine ] && words=\"{}\"\n"
                    "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}}\n"
                    "complete -o default -F _rigor rigor\n",
                    fmt::join(engine_names, " "));
}

// A quote ends a word of zsh, and a colon its name.
std::string zsh_word(std::string text) {
  std::replace(text.begin(), text.end(), '\'', '`'), std::replace(text.begin(), text.end(), ':', ';');
  return text;
}

std::string zsh(const EngineTable&) {
  std::string text =
      "#compdef rigor\n# rigor completion zsh > a folder of $fpath, as _rigor\nlocal -a names\nnames=(\n";
  for (const CommandRow& row : commands()) text += fmt::format("  '{}:{}'\n", row.name, zsh_word(row.summary));
  text += ")\nif (( CURRENT == 2 )); then _describe command names; return; fi\ncase $words[2] in\n";
  for (const CommandRow& row : commands())
    text += fmt::format("  {}) [[ $PREFIX == -* ]] && compadd -- {} ;;\n", row.name, fmt::join(options_of(row), " "));
  return text + "esac\n[[ $PREFIX == -* ]] || _files\n";
}

// In roff a backslash, and a dot that begins a line, are commands.
std::string roff(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((i == 0 || text[i - 1] == '\n') && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    out += text[i] == '\\' ? "\\e" : text[i] == '-' ? "\\-" : std::string(1, text[i]);
  }
  return out;
}

std::string manual(const EngineTable&) {
  std::string text = fmt::format(
      ".TH RIGOR 1 \"\" \"rigor {}\"\n.SH NAME\nrigor \\- says how right a rigid\\-body simulator is\n"
      ".SH SYNOPSIS\n.B rigor\n.I COMMAND\n[words] [options]\n.SH COMMANDS\n",
      this_machine().program_version);
  for (const CommandRow& row : commands()) {
    const char* words[] = {"rigor", row.name.c_str(), "--help"};
    text += fmt::format(".SS {}\n.nf\n{}.fi\n", row.name, roff(parse_command_line(3, words).printed));
  }
  return text +
         ".SH \"EXIT STATUS\"\n0 good; 1 a gate failed or a result got worse; 2 bad usage or bad input; 3 an engine or "
         "Rigor itself failed.\n"
         ".SH ENVIRONMENT\n.B RIGOR_HOME\nthe folder of suite/ and adapters/, in place of those installed or built "
         "with.\n";
}

struct Completion {
  std::string name;
  std::string (*text)(const EngineTable& engines);
};
const std::vector<Completion> kCompletions = {{"bash", bash}, {"man", manual}, {"zsh", zsh}};

}  // namespace

int completion_command(const CommandLine& line, const EngineTable& engines) {
  std::vector<std::string> names;
  for (const Completion& kind : kCompletions) names.push_back(kind.name);
  const std::string word = line.words.size() == 1 ? line.words.front() : "";
  for (const Completion& kind : kCompletions) {
    if (kind.name == word) return print(kind.text(engines)), kGood;
  }
  throw InputError(fmt::format("rigor completion: takes one of {}{}", listed(names), did_you_mean(word, names)));
}

}  // namespace rigor
