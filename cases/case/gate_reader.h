// Reads a [[gate]] table: of a case file, or of the family.toml beside several.
#pragma once

#include <string>
#include <vector>

#include "cases/case/case.h"
#include "cases/case/vocabulary.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline cases {

// One of the steps a gate names, or those to one side of it: "1/30", "<=1/240".
struct StepTerm {
  std::string sign;  // "", "<", "<=", ">", ">="
  StepSize dt;
  std::string label;  // "file:line:column: gate.dt[0]"
};

// A table as it stands, before it is known which case it judges.
struct GateTable {
  Gate gate;                         // but for its metric and dt
  std::vector<std::string> metrics;  // one gate each
  std::vector<StepTerm> steps;       // empty: every dt of the run
  std::string order_label;           // where at_least_order stands
  // In a family only: of which cases. Features of the scene (feature.h; "contact" is any contact), with ! those it
  // must not have; and truths. Empty: of all.
  std::vector<std::string> scene, truths;
  std::vector<std::string> except;  // cases of the family that it is not about, by the names of their files
};

// The keys that a gate may have. Throws InputError with the place of any other key.
GateTable read_gate_table(const TableReader& table, const Vocabulary& words);
GateTable read_family_gate_table(const TableReader& table, const Keys& cases,
                                 const Vocabulary& words);  // family.toml beside them, by file
const Keys& gate_keys();
const Keys& family_gate_keys();
// The words that select scenes: those of features, their parts before a colon, and two properties. Sorted.
Keys known_scene_words();

// Of a case that names them itself: throws InputError for a step that its run does not have.
std::vector<Gate> gates_of(const GateTable& table, const Case& of);

// The steps of a run that the terms select; all if there are no terms.
std::vector<StepSize> selected_steps(const std::vector<StepTerm>& terms, const std::vector<StepSize>& of_run);

}  // namespace rigor::inline cases
