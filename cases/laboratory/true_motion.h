// The truth of a scene that sliders may have changed, and that truth as a table on the steps of the runs.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "cases/case/case.h"
#include "cases/truth/truth.h"
#include "core/engine/body_table.h"

namespace rigor::inline laboratory {

struct TrueMotion {
  std::unique_ptr<Truth> truth;  // null: there is none
  std::string kind;              // the row of truths.cpp; empty where there is none
  std::string why_none;          // a sentence
};

// The case's own truth where it takes the scene as it is now. Else `reference` where nothing touches, and `events`
// elsewhere. A bound on the work keeps scenes without a truth that would need more than a moment.
TrueMotion true_motion(const Case& changed);

// The truth at n dt, n = 0 to the last step. A row of 13 numbers per body (kColumnNames), then its own error.
struct TruthTable {
  double dt = 0;  // s
  std::size_t bodies = 0;
  double kinetic = 0, change = 0;  // J, see EnergyExtremes; scales for errors of energy
  std::vector<double> numbers;
  std::string kind;
  bool is_provisional = false;  // stepped by the core's dormand-prince at a tight tolerance; its error is not known

  std::size_t columns() const { return 13 * bodies + 1; }
  std::size_t rows() const { return bodies == 0 ? 0 : numbers.size() / columns(); }
  void read(std::size_t row, MutableBodyColumns out) const;
  double error(std::size_t row) const { return numbers[row * columns() + 13 * bodies]; }
};

TruthTable truth_table(const Case& changed, const TrueMotion& motion, double dt);

// A stand-in until the truth is solved. Throws InputError for a scene that dormand-prince does not take.
TruthTable provisional_table(const Case& changed, double dt);

}  // namespace rigor::inline laboratory
