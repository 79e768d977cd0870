// All loads of a system except gravity, in columns for the kernels; the same as Loads::evaluate(). Several springs are
// evaluated at once. Each body then sums its own springs in their order, so the result does not depend on how many were
// evaluated at once.
#pragma once

#include "core/dynamics/kernels/kernels.h"
#include "core/dynamics/model/system.h"
#include "core/engine/columns.h"

namespace rigor::inline dynamics {

class WrenchColumns {
 public:
  explicit WrenchColumns(const System& system);

  // Columns of WrenchColumn, as Loads::evaluate() has them; null where nothing acts in that step. Valid until the next
  // call.
  // `instant` as in JointDrive::effort().
  const double* over_step(BodyColumns state, double t, double dt, std::optional<double> instant = {});

 private:
  void set_spring(std::size_t k, const Spring& spring);
  void list_pulls_on_bodies();
  void sum_pulls(std::size_t first, std::size_t last);
  bool add_forces(BodyColumns state, double t, double dt, bool is_clear);
  void add_drives(BodyColumns state, double t, double dt, std::optional<double> instant, bool is_clear);

  const Loads& loads_;
  const BodyConstants& bodies_;
  Columns constants_, pulls_, wrenches_;
  std::vector<std::int32_t> a_, b_;  // rows of the springs' bodies
  // The ends of springs on body i: pulls_on_[first_pull_[i]] up to the next body's, in the springs' order. An end is
  // 2 spring for a, 2 spring + 1 for b.
  std::vector<std::size_t> first_pull_, pulls_on_;
};

}  // namespace rigor::inline dynamics
