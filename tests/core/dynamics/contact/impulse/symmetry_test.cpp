// Contact by impulses under exact symmetries of mechanics: other units, a turn, a mirror, another order of the bodies.
// Generated scenes are compared over a second at 1/200 s.
#include "tests/core/dynamics/contact/impulse/equivalent_scenes.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_symmetry)

namespace {

constexpr double kDt = 1.0 / 200;
constexpr int kSteps = 200;
constexpr std::uint32_t kScenes = 60;

const Relation kIdentity{"itself", [](const Scene& scene) { return scene; }};

using Motion = std::vector<std::vector<Vec3>>;

double farthest_apart(const Motion& x, const Motion& y) {
  double most = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    for (std::size_t i = 0; i < x[k].size(); ++i) most = std::max(most, (x[k][i] - y[k][i]).norm());
  }
  return most;
}

// The change of the motion by a nanometre at the start.
double change_by_a_nanometre(const Scene& scene, const Motion& motion, const std::string& integrator) {
  Scene other = scene;
  for (Body& body : other.bodies) {
    if (!body.fixed) body.position += 1e-9 * Vec3(0.3, -0.5, 0.8);
  }
  return farthest_apart(motion, motion_of(other, kIdentity, kDt, kSteps, integrator));
}

void check_relations(std::uint32_t seed, const std::string& integrator) {
  const Scene scene = generated_contact_scene(seed);
  const Motion motion = motion_of(scene, kIdentity, kDt, kSteps, integrator);
  const double sensitivity = change_by_a_nanometre(scene, motion, integrator);
  // A relation changes the start by some roundings of a metre, 1e-15 m; the nanometre changes it by 1e-9 m. If the
  // motion amplifies the nanometre by less than 100, the bound is a thousand roundings of a metre. If it amplifies
  // more, the motion is chaotic (60 of 400 scenes), and rounding may have at most ten times the effect of the
  // nanometre.
  const double most = sensitivity < 1e-7 ? 1e-11 : 10 * sensitivity;
  for (const Relation& relation : exact_relations()) {
    const double apart = farthest_apart(motion, motion_of(scene, relation, kDt, kSteps, integrator));
    BOOST_TEST(apart <= most, "scene " << seed << ", " << relation.name << ": " << apart << " m, a nanometre makes "
                                       << sensitivity << " m");
    if (relation.is_exact) BOOST_TEST(apart == 0, "scene " << seed << ", " << relation.name << ": " << apart << " m");
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(generated_scenes_move_alike_in_all_units_axes_and_orders) {
  for (std::uint32_t seed = 0; seed < kScenes; ++seed) check_relations(seed, "velocity-verlet");
}

BOOST_AUTO_TEST_CASE(so_they_do_by_other_integrators) {
  for (const char* integrator : {"semi-implicit-euler", "rk4"}) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) check_relations(seed, integrator);
  }
}

// No rule says which corner of a level box comes first. The effect of one corner before the other remains: the
// tolerance of impacts (1e-3 of 4 g h = 0.05 m/s) over a second, 5e-5 m; 1e-6 m measured.
BOOST_AUTO_TEST_CASE(a_level_box_lands_as_its_mirror_image_does) {
  const Scene scene = on_floor({solid("box", Box{{0.3, 0.5, 0.2}}, {0.05, -0.02, 0.5})}, {0.3, 0.9});
  const Motion motion = motion_of(scene, kIdentity, kDt, kSteps);
  for (const Relation& relation : exact_relations())
    BOOST_TEST(farthest_apart(motion, motion_of(scene, relation, kDt, kSteps)) < 5e-5, relation.name);
}

// Without gravity the speeds say how long a sub-step may be.
BOOST_AUTO_TEST_CASE(scenes_without_gravity_do_not_depend_on_units) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    Scene scene = generated_contact_scene(seed);
    scene.gravity.setZero();
    for (Body& body : scene.bodies) body.velocity.z() -= 1;
    const Motion motion = motion_of(scene, kIdentity, kDt, kSteps);
    for (const auto& [length, time] : {std::pair(8.0, 1.0), std::pair(1.0, 4.0), std::pair(0.125, 16.0)}) {
      const Relation units{"units", [&](const Scene& s) { return in_other_units(s, length, time); }, length, time};
      BOOST_TEST(farthest_apart(motion, motion_of(scene, units, kDt, kSteps)) == 0, "scene " << seed);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
