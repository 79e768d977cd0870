#include "cases/cli/chosen_cases.h"

#include "cases/case/suite.h"
#include "cases/cli/output.h"
#include "cases/import/import.h"

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

}  // namespace rigor
