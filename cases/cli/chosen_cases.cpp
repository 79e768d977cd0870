#include "cases/cli/chosen_cases.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/case/suite.h"
#include "cases/cli/output.h"
#include "cases/import/import.h"
#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

// What is lost or was assumed, and how much is without effect.
void say_how_imported(const Case& definition) {
  say_if_it_falls(definition.id, definition.scene);
  for (const auto& [kind, word] : {std::pair{LossKind::physical, "lost"}, {LossKind::assumed, "assumed"}}) {
    for (const Loss& loss : losses_of(definition.losses, kind))
      say(fmt::format("{}: {}: {}", definition.id, word, sentence_of(loss)));
  }
  const std::size_t visual = losses_of(definition.losses, LossKind::visual).size();
  if (visual > 0)
    say(fmt::format("{}: kinds of elements without effect on the motion: {}; rigor import lists them", definition.id,
                    visual));
}

}  // namespace

void say_if_it_falls(const std::string& file, const Scene& scene) {
  const std::string falling = falls_freely(scene);
  if (!falling.empty())
    say(fmt::format("{}: it stands in empty space, so '{}' falls freely; --ground adds a plane", file, falling));
}

std::vector<Case> chosen_cases(const CaseWords& cases, const Invocation& invocation, const Vocabulary& words) {
  std::vector<Case> chosen = select_cases(cases.words, cases.suite.dir, words, cases.imports.chosen);
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

}  // namespace rigor::inline cli
