// Reads a case file, whole: scene, run, truth and gates, every value with its line and column.
#pragma once

#include <string>
#include <vector>

#include "cases/case/case.h"
#include "cases/case/vocabulary.h"

namespace rigor::inline cases {

// Throws InputError, "file:line:column: key: what was found, what is allowed (near match)", for anything the format
// does not allow, and for a metric, truth, engine or step size that is not among `words`.
Case read_case(const std::string& path, const std::string& id, const Vocabulary& words);
// The same of a text that is in no file; the path is for messages. Gates may be left out, unread, by a reader that has
// not all engines.
enum class Gates { read, left_out };
Case read_case_text(const std::string& text, const std::string& path, const std::string& id, const Vocabulary& words,
                    Gates gates = Gates::read);

}  // namespace rigor::inline cases
