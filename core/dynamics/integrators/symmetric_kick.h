// The change of velocities by the loads at fixed positions, symmetric in time. With dampers the loads are W(V) = W(V0)
// + D (V - V0), linear in the velocities V, and the kick over h is the midpoint rule
//   (M - h/2 D) (V1 - V0) = h W(V0).
// Without dampers it is exact. Compositions of symmetric maps need it: they go backwards in some of their stages.
#pragma once

#include <string>

#include "core/dynamics/model/block_system.h"
#include "core/dynamics/model/system.h"
#include "core/dynamics/model/wrench_columns.h"

namespace rigor::inline dynamics {

class SymmetricKick {
 public:
  explicit SymmetricKick(const System& system);

  bool damped() const { return system_.loads.damped(); }

  // Between begin() and end() the rotation is stored as each body's angular momentum in W. Converting to w and back at
  // every kick would add a rounding of L each time. end() writes w.
  void begin(BodyColumns state);
  void end(MutableBodyColumns state) const;
  double* carried() { return carried_.data(); }  // columns of CarriedColumn
  Columns& carried_columns() { return carried_; }

  // Over h, inside the step [t, t + dt] in which timed forces count with their mean. False where the equations for the
  // velocities are singular (an h < 0 with strong damping); the state is then left as it is.
  bool apply(MutableBodyColumns state, double h, double t, double dt, std::optional<double> instant = {});

 private:
  bool damped_kick(MutableBodyColumns state, double h, double t, double dt);

  const System& system_;
  Columns carried_;
  WrenchColumns loads_;
  BlockSystem equations_;
  Wrenches wrenches_;
  Eigen::VectorXd impulse_, change_;
};

inline constexpr const char* kNoSymmetricKick = "the equations for the damped velocities were singular";

}  // namespace rigor::inline dynamics
