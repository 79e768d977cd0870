// A jointed scene of the suite, stepped by the core behind the seam.
#pragma once

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "adapters/core/core_engine.h"
#include "cases/case/suite.h"
#include "core/engine/engine.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::test {

inline Scene suite_scene(const std::string& id) {
  const TomlFile file = TomlFile::read(default_suite_dir() + "/" + id + ".toml");
  return read_scene(file.root(case_keys()).at("scene"));
}

// Steps it until the time `end`, which must be a whole number of steps; the world's own warning is an error.
inline void step_until(World& world, double dt, double end) {
  const long count = std::lround(end / dt);
  for (long n = 0; n < count; ++n) {
    world.step(dt);
    const std::string warning = world.solver_warning();
    if (!warning.empty()) BOOST_FAIL("at " << static_cast<double>(n + 1) * dt << " s: " << warning);
  }
}

inline BodyTable state_after(const Scene& scene, const std::string& method, double dt, double end) {
  const auto world = CoreEngine().load(scene, {.method = method, .options = {}});
  step_until(*world, dt, end);
  Snapshot snapshot;
  world->read(snapshot);
  return BodyTable(snapshot.bodies());
}

// The largest difference of any component, of positions, orientations [rad], velocities and angular velocities.
struct Difference {
  double pose = 0, velocity = 0;
};
inline Difference difference(const BodyState& a, const BodyState& b) {
  return {std::max((a.position - b.position).norm(), angle_between(a.orientation, b.orientation)),
          std::max((a.velocity - b.velocity).norm(), (a.angular_velocity - b.angular_velocity).norm())};
}

inline std::size_t body_index(const Scene& scene, const std::string& name) {
  std::size_t i = 0;
  while (scene.bodies.at(i).name != name) ++i;
  return i;
}

}  // namespace rigor::test
