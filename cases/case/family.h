// A family of cases: the folder that they stand in. Its family.toml states the gates that hold for all of them, chosen
// by what a run is and by what a scene has; a case file keeps those that are special to it.
#pragma once

#include <string>
#include <vector>

#include "cases/case/gate_reader.h"

namespace rigor {

inline constexpr const char* kFamilyFile = "family.toml";  // in a folder of cases; no case itself

struct Family {
  std::vector<GateTable> gates;
};

// Throws InputError, "file:line:column: key: what was found, what is allowed", as for a case.
Family read_family(const std::string& path, const Vocabulary& words);

// Appends those of the family's gates that are about such a case. Where the case states an order, a ranking or a
// regression of the same metric for a run itself, its own counts and not the family's.
void add_family_gates(const Family& family, const Vocabulary& words, Case& definition);

}  // namespace rigor
