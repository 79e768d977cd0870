// The truth by events against solutions that share nothing with it, and the scenes for that.
#pragma once

#include <optional>

#include "tests/cases/judged.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"
#include "tests/cases/truth/solved/own_motion.h"

namespace rigor::test {

inline constexpr double kG = 9.81;
inline constexpr double kOwnError = 1e-10;  // m and rad, of the solvers here: half their steps change less

struct Due {
  double t;
  std::optional<Vec3> position;
  std::optional<Quat> orientation = {};
};

// The body's states must be within what the truth claims, and this must be little.
inline void check_within_claim(const Scene& scene, double duration, int body, const std::vector<Due>& due,
                               double most = 1e-7) {
  const auto truth = make_truth("events", scene, duration);
  BOOST_TEST(truth->error(duration) < most);
  for (const Due& one : due) {
    const BodyTable found = truth_at(*truth, one.t, scene.bodies.size());
    const double claim = truth->error(one.t) + kOwnError;
    if (one.position) {
      const double off = (found.columns().position(body) - *one.position).norm();
      BOOST_TEST(off <= claim, "at " << one.t << " s off by " << off << " m, of " << claim);
    }
    if (one.orientation) {
      const double off = angle_between(found.columns().orientation(body), *one.orientation);
      BOOST_TEST(off <= claim, "at " << one.t << " s off by " << off << " rad, of " << claim);
    }
  }
}

inline TimedForce push(int body, const Vec3& force, double from, double until) {
  TimedForce timed;
  timed.body = body, timed.force = force, timed.from = from, timed.until = until;
  return timed;
}

inline Scene on_ground(std::vector<Body> bodies, double friction) {
  Scene scene;
  scene.gravity = {0, 0, -kG};
  scene.bodies = std::move(bodies);
  scene.bodies.push_back(plane());
  scene.contact_default = {0, friction};
  return scene;
}

}  // namespace rigor::test
