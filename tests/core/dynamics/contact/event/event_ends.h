// Where contact by events takes a scene, all of it at the order of the integrator.
#pragma once

#include "tests/core/dynamics/contact/contact_runs.h"

namespace rigor::test {

inline BodyTable event_end(const Scene& scene, const char* integrator, double dt, int steps) {
  ContactRun run(scene, "event", integrator);
  run.run(dt, steps);
  BOOST_TEST(run.solver_warning() == "");
  BOOST_TEST(!run.reduced_order());
  return BodyTable(run.state());
}

// m and rad, of the first body.
inline double first_body_apart(const BodyTable& a, const BodyTable& b) {
  return (a.columns().position(0) - b.columns().position(0)).norm() +
         angle_between(a.columns().orientation(0), b.columns().orientation(0));
}

}  // namespace rigor::test
