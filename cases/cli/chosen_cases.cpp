#include "cases/cli/chosen_cases.h"

#include <algorithm>

#include "cases/case/suite.h"
#include "cases/cli/output.h"
#include "cases/import/import.h"
#include "cases/runner/grid.h"
#include "core/base/error.h"

namespace rigor {

std::vector<Case> chosen_cases(const CommandLine& line, const Vocabulary& words) {
  std::vector<Case> cases = select_cases(line.words, line.suite_dir, words);
  for (const Case& definition : cases) {
    if (!is_model_file(definition.id)) continue;
    if (!leads(line)) continue;
    for (const std::string& sentence : left_out_of(definition.text)) say(harmless("left out: " + sentence));
  }
  return cases;
}

std::vector<Case> overridden_cases(const CommandLine& line, const Vocabulary& words) {
  std::vector<Case> suited;
  std::vector<std::string> faults;
  for (Case& definition : chosen_cases(line, words)) {
    const bool is_named = std::find(line.words.begin(), line.words.end(), definition.id) != line.words.end();
    try {
      override_run(definition, {line.dt, line.duration});
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
