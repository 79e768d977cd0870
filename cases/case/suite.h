// Finds cases: those of the suite by id or family, and files or folders anywhere.
#pragma once

#include <string>
#include <vector>

#include "cases/case/case.h"
#include "cases/case/vocabulary.h"
#include "cases/import/import_options.h"

namespace rigor::inline cases {

// The ids of all cases below `suite_dir`, sorted: "springs/fixed-spring".
std::vector<std::string> suite_ids(const std::string& suite_dir);

// The cases that the words name, each once. A word is a case's id, its last part if that is unique, a family (its
// folder), a .toml file, a robot's file, or a folder of case files. No words: the whole suite. Throws InputError with a
// near match for an unknown word, for a folder without cases, and for a robot that would lose physics.
std::vector<Case> select_cases(const std::vector<std::string>& words, const std::string& suite_dir,
                               const Vocabulary& vocabulary, const ImportOptions& options = {});

std::string default_suite_dir();

}  // namespace rigor::inline cases
