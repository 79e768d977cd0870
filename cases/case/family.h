// A family of cases: all cases in one folder. Its family.toml states the gates for all of them, selected by properties
// of the run and the scene. A case file holds only its special gates.
#pragma once

#include <string>
#include <vector>

#include "cases/case/gate_reader.h"

namespace rigor::inline cases {

inline constexpr const char* kFamilyFile = "family.toml";  // in a folder of cases; no case itself

struct Family {
  std::vector<GateTable> gates;
};

// Throws InputError, "file:line:column: key: what was found, what is allowed", as for a case.
Family read_family(const std::string& path, const Vocabulary& words);

// Appends the family's gates that apply to the case. If the case itself states an order, a ranking or a regression of
// the same metric for a run, that gate replaces the family's.
void add_family_gates(const Family& family, const Vocabulary& words, Case& definition);

}  // namespace rigor::inline cases
