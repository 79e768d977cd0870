// rigor completion: completions for shells, the manual page and the reference, from the tables of the program.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cases/case/suite.h"
#include "cases/cli/commands.h"
#include "cases/cli/help.h"
#include "cases/cli/output.h"
#include "cases/cli/reference.h"
#include "cases/report/json/machine.h"
#include "core/base/error.h"
#include "core/base/names_of.h"
#include "core/base/near_match.h"

namespace rigor::inline cli {
namespace {

std::vector<std::string> option_names(const CommandRow& row) {
  std::vector<std::string> names;
  for (const OptionFact& option : options_of(row)) names.push_back(option.name);
  names.push_back("--help");
  return names;
}

// Ids and families of Rigor's own suite.
std::vector<std::string> case_words() {
  std::set<std::string> words;
  for (const std::string& id : suite_ids(default_suite_dir())) {
    words.insert(id);
    for (auto slash = id.find('/'); slash != std::string::npos; slash = id.find('/', slash + 1))
      words.insert(id.substr(0, slash));
  }
  return {words.begin(), words.end()};
}

std::vector<std::string> engine_words(const EngineTable& engines, const std::string& colon) {
  std::vector<std::string> words;
  for (const EngineInfo& engine : engines.infos()) {
    words.push_back(engine.name);
    for (const MethodInfo& method : engine.methods) words.push_back(engine.name + colon + method.name);
  }
  return words;
}

// What a command's plain words may be, beside files.
std::vector<std::string> plain_words(const CommandRow& row) {
  return row.words == "CASE" ? case_words() : row.known_words;
}

// The values of --format; empty for a command without it.
std::vector<std::string> formats_of(const CommandRow& row) {
  for (const OptionFact& option : options_of(row)) {
    if (option.name == "--format") return option.choices;
  }
  return {};
}

std::string bash(const EngineTable& engines) {
  std::string text = fmt::format(
      "# rigor completion bash > /usr/share/bash-completion/completions/rigor\n_rigor() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} words=\"\" formats=\"\"\n"
      "  local cases=\"{}\"\n"
      "  if [ \"$COMP_CWORD\" = 1 ]; then words=\"{} help version --help --version\"; else\n    case "
      "${{COMP_WORDS[1]}} in\n",
      fmt::join(case_words(), " "), fmt::join(names_of(commands()), " "));
  for (const CommandRow& row : commands()) {
    const std::string plain = row.words == "CASE" ? "$cases" : fmt::format("{}", fmt::join(plain_words(row), " "));
    text += fmt::format("      {}) words=\"{} {}\" formats=\"{}\" ;;\n", row.name, fmt::join(option_names(row), " "),
                        plain, fmt::join(formats_of(row), " "));
  }
  return text + fmt::format(
                    "    esac\n  fi\n  case ${{COMP_WORDS[COMP_CWORD-1]}} in\n    --engine) words=\"{}\" ;;\n"
                    "    --format) words=$formats ;;\n  esac\n"
                    "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}}\n"
                    "complete -o default -F _rigor rigor\n",
                    fmt::join(engine_words(engines, "\\\\:"), " "));
}

// A quote ends a word of zsh, and a colon its name.
std::string zsh_word(std::string text) {
  std::replace(text.begin(), text.end(), '\'', '`'), std::replace(text.begin(), text.end(), ':', ';');
  return text;
}

std::string zsh(const EngineTable& engines) {
  std::string text =
      "#compdef rigor\n# rigor completion zsh > a folder of $fpath, as _rigor\nlocal -a names cases\nnames=(\n";
  for (const CommandRow& row : commands()) text += fmt::format("  '{}:{}'\n", row.name, zsh_word(row.summary));
  text += fmt::format(")\ncases=({})\n", fmt::join(case_words(), " "));
  text += "if (( CURRENT == 2 )); then _describe command names; return; fi\n";
  text += fmt::format("if [[ $words[CURRENT-1] == --engine ]]; then compadd -- {}; return; fi\ncase $words[2] in\n",
                      fmt::join(engine_words(engines, ":"), " "));
  for (const CommandRow& row : commands()) {
    text += fmt::format("  {})", row.name);
    if (const auto formats = formats_of(row); !formats.empty())
      text +=
          fmt::format(" [[ $words[CURRENT-1] == --format ]] && {{ compadd -- {}; return; }};", fmt::join(formats, " "));
    text += fmt::format(" [[ $PREFIX == -* ]] && compadd -- {}", fmt::join(option_names(row), " "));
    const auto plain = plain_words(row);
    if (!plain.empty())
      text += row.words == "CASE" ? " || compadd -a cases" : fmt::format(" || compadd -- {}", fmt::join(plain, " "));
    text += " ;;\n";
  }
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
      ".TH RIGOR 1 \"\" \"rigor {}\"\n.SH NAME\nrigor \\- measure how accurate rigid\\-body simulators are\n"
      ".SH SYNOPSIS\n.B rigor\n.I COMMAND\n[words] [options]\n.SH COMMANDS\n",
      this_machine().program_version);
  for (const CommandRow& row : commands()) {
    text += fmt::format(".SS {}\n.nf\n{}.fi\n", row.name, roff(help_text(row)));
  }
  text += ".SH EXAMPLES\n";
  for (const CommandRow& row : commands()) {
    for (const Example& example : row.examples)
      text += fmt::format(".TP\n.B {}\n{}\n", roff(example.call), roff(example.does));
  }
  text += ".SH \"EXIT STATUS\"\n";
  for (const NamedFact& fact : exit_codes()) text += fmt::format(".TP\n.B {}\n{}\n", fact.name, fact.meaning);
  text += ".SH ENVIRONMENT\n";
  for (const NamedFact& fact : environment_variables())
    text += fmt::format(".TP\n.B {}\n{}\n", fact.name, roff(fact.meaning));
  return text;
}

struct Completion {
  std::string name;
  std::string (*text)(const EngineTable& engines);
};
const std::vector<Completion> kCompletions = {
    {"bash", bash}, {"man", manual}, {"reference", reference_text}, {"zsh", zsh}};

class CompletionCommand : public Command {
 public:
  void declare(Options& options) override { options.add_words(words_); }

  int run(const Invocation&) override {
    const std::vector<std::string> names = names_of(kCompletions);
    const std::string word = words_.size() == 1 ? words_.front() : "";
    for (const Completion& kind : kCompletions) {
      if (kind.name == word) return print(kind.text(built_in_engines())), kGood;
    }
    throw InputError(fmt::format("rigor completion: takes one of {}{}", listed(names), did_you_mean(word, names)));
  }

 private:
  std::vector<std::string> words_;
};

}  // namespace

CommandRow completion_row() {
  return {"completion",
          "print completions for a shell, the manual page, or the reference in Markdown",
          "KIND",
          "bash, zsh, man or reference",
          {{"rigor completion bash > ~/.local/share/bash-completion/completions/rigor", "for bash"},
           {"rigor completion man | man -l -", "read the manual page"}},
          make_command<CompletionCommand>,
          names_of(kCompletions)};
}

}  // namespace rigor::inline cli
