// A box that turns over its edge: against the energy, and against the same pendulum by another method.
#include <cmath>

#include "core/base/error.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_contact_toppling)

namespace {

constexpr double kG = 9.81, kWidth = 0.4, kHeight = 1;

Scene toppling(double rate, double friction) {
  Scene scene;
  scene.gravity = {0, 0, -kG};
  const Vec3 size(kWidth, 0.3, kHeight);
  Body box = test::body("box", 2,
                        Vec3(size.y() * size.y() + size.z() * size.z(), size.x() * size.x() + size.z() * size.z(),
                             size.x() * size.x() + size.y() * size.y()) /
                            6,
                        {0, 0, 0.5 * kHeight});
  box.shape = Box{size}, box.collides = true;
  box.angular_velocity = {0, rate, 0};
  box.velocity = box.angular_velocity.cross(Vec3(-0.5 * kWidth, 0, 0.5 * kHeight));
  Body plane;
  plane.name = "ground", plane.shape = Plane{Vec3::UnitZ(), 0}, plane.fixed = plane.collides = true;
  scene.bodies = {box, plane};
  scene.contact_default = {0, friction};
  return scene;
}

BodyState at(const Truth& truth, double t) { return test::truth_at(truth, t, 2).columns().body(0); }

}  // namespace

BOOST_AUTO_TEST_CASE(it_keeps_its_energy_and_its_edge) {
  const auto truth = make_truth("toppling", toppling(1.6, 1), 0.8);
  const double inertia = 2.0 / 12 * (kWidth * kWidth + kHeight * kHeight);
  const auto energy = [&](const BodyState& s) {
    return s.velocity.squaredNorm() + 0.5 * inertia * s.angular_velocity.squaredNorm() + 2 * kG * s.position.z();
  };
  for (double t = 0; t <= 0.8; t += 0.013) {
    const BodyState now = at(*truth, t);
    BOOST_TEST(std::abs(energy(now) - energy(at(*truth, 0))) < 1e-13);
    const Vec3 edge = now.position + now.orientation * Vec3(0.5 * kWidth, 0, -0.5 * kHeight);
    BOOST_TEST((edge - Vec3(0.5 * kWidth, 0, 0)).norm() < 1e-15);
    BOOST_TEST(truth->error(t) < 1e-15);
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_inverted_pendulum) {
  const auto truth = make_truth("toppling", toppling(1.6, 1), 0.8);
  const double r = 0.5 * std::hypot(kWidth, kHeight), stiffness = kG * r / (4 * r * r / 3);
  double phi = -std::atan2(kWidth, kHeight), w = 1.6;
  const double start = phi, h = 1e-5;
  for (int n = 0; n < 80000; ++n) {
    const auto f = [&](double x) { return stiffness * std::sin(x); };
    const double k1 = w, l1 = f(phi), k2 = w + 0.5 * h * l1, l2 = f(phi + 0.5 * h * k1), k3 = w + 0.5 * h * l2,
                 l3 = f(phi + 0.5 * h * k2), k4 = w + h * l3, l4 = f(phi + h * k3);
    phi += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), w += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
  }
  // 80000 roundings of 1e-16, which the pendulum magnifies by up to twenty.
  BOOST_TEST(std::abs(angle_between(at(*truth, 0.8).orientation, Quat::Identity()) - (phi - start)) < 1e-12);
  BOOST_TEST(std::abs(at(*truth, 0.8).angular_velocity.y() - w) < 1e-12);
}

BOOST_AUTO_TEST_CASE(it_says_how_long_it_is_a_pendulum) {
  const auto falls_back = make_truth("toppling", toppling(1.0, 1), 5);
  double t = 0;
  for (; t < 5 && std::isfinite(falls_back->error(t)); t += 1.0 / 1024) {
    if (t > 0) BOOST_TEST(at(*falls_back, t).angular_velocity.y() > -1.0);  // it lands as fast as it rose
  }
  BOOST_TEST(std::abs(at(*falls_back, t).angular_velocity.y() + 1) < 0.05);
  const auto slips = make_truth("toppling", toppling(1.6, 0.5), 5);
  BOOST_TEST(std::isfinite(slips->error(0.5)));
  BOOST_TEST(!std::isfinite(slips->error(1.5)));
}

BOOST_AUTO_TEST_CASE(what_is_no_pendulum_is_refused_with_the_reason) {
  const auto refuses = [](const Scene& scene, double duration, const char* why) {
    BOOST_CHECK_EXCEPTION(make_truth("toppling", scene, duration), InputError, test::says(why));
  };
  refuses(toppling(1.6, 0.1), 0.8, "would slip");
  refuses(toppling(0, 1), 0.8, "does not turn about one edge");
  refuses(toppling(6, 1), 0.8, "would leave the plane");
  Scene slope = toppling(1.6, 1);
  slope.gravity = {1, 0, -kG};
  refuses(slope, 0.8, "is on a slope");
  Scene high = toppling(1.6, 1);
  high.bodies[0].position.z() += 1e-6;
  refuses(high, 0.8, "does not touch the plane");
  Scene ghost = toppling(1.6, 1);
  ghost.bodies[0].collides = false;
  refuses(ghost, 0.8, "is no box and no cylinder that collides");
}

BOOST_AUTO_TEST_SUITE_END()
