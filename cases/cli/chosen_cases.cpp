#include "cases/cli/chosen_cases.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/case/suite.h"
#include "cases/cli/output.h"
#include "cases/import/import.h"
#include "core/base/error.h"

namespace rigor {
namespace {

void say_how_imported(const Case& definition) {
  const std::string& file = definition.id;
  const std::string falling = falls_freely(definition.scene);
  if (!falling.empty())
    say(fmt::format("{}: there is no ground, so '{}' falls freely; rigor import prints a case file to add one", file,
                    falling));
  const std::vector<std::string> losses = losses_of(definition.text);
  if (losses.empty()) return;
  say(fmt::format("{}: physics left out or assumed (rigor import lists each place):", file));
  for (const std::string& loss : losses) say("  " + loss);
}

}  // namespace

std::vector<Case> chosen_cases(const CaseWords& cases, const Invocation& invocation, const Vocabulary& words) {
  std::vector<Case> chosen = select_cases(cases.words, cases.suite.dir, words);
  for (const Case& definition : chosen) {
    if (is_model_file(definition.id) && invocation.leads()) say_how_imported(definition);
  }
  return chosen;
}

std::vector<Case> overridden_cases(const CaseWords& cases, const Invocation& invocation, const Overrides& overrides,
                                   const Vocabulary& words) {
  std::vector<Case> suited;
  std::vector<std::string> faults;
  for (Case& definition : chosen_cases(cases, invocation, words)) {
    const bool is_named = std::find(cases.words.begin(), cases.words.end(), definition.id) != cases.words.end();
    try {
      override_run(definition, overrides);
      suited.push_back(std::move(definition));
    } catch (const InputError& error) {
      if (is_named) throw;
      faults.push_back(error.what());
    }
  }
  if (suited.empty()) throw InputError(faults.front());
  for (const std::string& fault : faults) say("left out: " + fault);
  return suited;
}

}  // namespace rigor
