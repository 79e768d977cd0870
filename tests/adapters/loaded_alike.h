// An engine's own loader against our import of the same file, both stepped by that engine: what differs is the import.
#pragma once

#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <limits>

#include "tests/adapters/free_body_measures.h"

namespace rigor::test {

inline constexpr double kLoadedStep = 1e-3;  // s

// Limits are not compared here, because an engine's own limits are soft, or follow its loader.
inline Scene without_limits(Scene scene) {
  for (Joint& joint : scene.joints) {
    joint.lower = -std::numeric_limits<double>::infinity(), joint.upper = -joint.lower, joint.restitution = 0;
  }
  return scene;
}

struct Apart {
  double position = 0, turn = 0, path = 0;  // m, rad; how far the body that moved most has come
};

// Own: a world as the engine's loader made it: step(), place(), has(name), centre(name) in m, turn(name).
template <typename Own>
Apart apart_after(Own& own, const std::string& engine, const Scene& scene, double duration) {
  const auto world = load_run(engine, scene);
  std::vector<Quat> own_start;
  for (const Body& body : scene.bodies) {
    BOOST_TEST_REQUIRE(own.has(body.name), body.name);
    own_start.push_back(own.turn(body.name));
  }
  for (int i = 0; i < std::lround(duration / kLoadedStep); ++i) own.step(), world->step(kLoadedStep);
  own.place();
  Snapshot found;
  world->read(found);
  Apart apart;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const BodyState ours = found.bodies().body(i);
    apart.position = std::max(apart.position, (ours.position - own.centre(body.name)).norm());
    apart.path = std::max(apart.path, (ours.position - body.position).norm());
    apart.turn = std::max(apart.turn, angle_between(own.turn(body.name) * own_start[i].conjugate(),
                                                    ours.orientation * body.orientation.conjugate()));
  }
  return apart;
}

// 1e-9 is what an import has to keep to at 1/1000; a moment that was turned the wrong way is seen at once.
inline void check_alike(const std::string& what, const Apart& apart) {
  BOOST_TEST_MESSAGE(fmt::format("{}: {:.2g} m and {:.2g} rad apart after 1 s, in which a body moved by {:.2g} m", what,
                                 apart.position, apart.turn, apart.path));
  BOOST_TEST(apart.path > 0.1, what);
  BOOST_TEST(apart.position < 1e-9, what << " " << apart.position);
  BOOST_TEST(apart.turn < 1e-9, what << " " << apart.turn);
}

}  // namespace rigor::test
