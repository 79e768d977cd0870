// The two ways in which the reference of a jointed scene is solved (jointed_reference.cpp), each compiled by itself.
#pragma once

#include <memory>

#include "cases/truth/solved/extrapolation.h"
#include "cases/truth/solved/jointed/stopped_solution.h"
#include "cases/truth/solved/solving.h"

namespace rigor::inline truth::solving {

struct Way {
  int columns;       // of the extrapolation
  double tolerance;  // of a step, relative and absolute
  double rest_time;  // s; stops.h
};

template <typename Motion>
Nodes nodes_of(const Scene& scene, const Way& way, const std::vector<double>& switches) {
  const Motion motion(scene);
  const Extrapolation<typename Motion::State::value_type> stepper(way.columns, way.tolerance);
  if (Stops<Motion>::are_in(scene)) return StoppedSolution(motion, stepper, way.rest_time).solve(switches);
  return solve(motion, stepper, switches, kMostTries);
}

// Solves with JointedMotion in extended precision, and interpolates between nodes in double.
Nodes newton_euler_nodes(const Scene& scene, const Way& way, const std::vector<double>& switches);
std::unique_ptr<DoubleMotion> newton_euler_in_double(const Scene& scene, const Nodes& nodes);

// Solves with NaturalCoordinates, in double or extended precision; writes to `judged`.
enum class Precision { plain, extended };
void compare_with_natural(Judged& judged, Precision precision, const Scene& scene, const Way& way,
                          const std::vector<double>& switches);

}  // namespace rigor::inline truth::solving
