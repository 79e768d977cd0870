// Command lines that reports and messages print. Each can be pasted into a shell as it is.
#pragma once

#include <string>
#include <vector>

#include "cases/import/import_options.h"

namespace rigor::inline report {

// "rigor run 'my case'": the words with blanks between them, in quotes where a shell needs them.
std::string pasted(const std::vector<std::string>& words);

// "--plugin P" and "--suite DIR", where the run's engine comes from outside and where use_suite named a folder; and
// the options of use_imports.
std::vector<std::string> where_from(const std::string& run);
void use_suite(const std::string& folder);
void use_imports(const ImportOptions& options);

// The command that says which known mistake the run's error in this case looks like.
std::string diagnose_command_text(const std::string& case_id, const std::string& run);

}  // namespace rigor::inline report
