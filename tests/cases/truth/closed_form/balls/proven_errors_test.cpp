// The error that a closed form claims holds, proven in ball arithmetic over random parameters and times. The formulas
// here come from the books, and share nothing with the truths but the scene's numbers, which are exact.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "tests/cases/judged.h"
#include "tests/cases/truth/closed_form/balls/ball.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_balls_proven_errors)

namespace {

struct BallPose {
  BallVector position;
  BallTurn turn;
};

BallVector exact(const Vec3& v) { return {Ball(v.x()), Ball(v.y()), Ball(v.z())}; }
BallTurn exact(const Quat& q) { return {Ball(q.w()), exact(Vec3(q.vec()))}; }
const BallTurn kNoTurn = {Ball(1.0), {Ball(0.0), Ball(0.0), Ball(0.0)}};

// rad, at most, between a rotation as the truth gives it and a proven one. The arcsine of x <= 0.5 is below 1.05 x.
double angle_at_most(const Quat& q, const BallTurn& turn) {
  const BallTurn apart = turn.conjugate() * exact(q);
  const Ball sine = norm(apart.v) / sqrt(apart.w * apart.w + dot(apart.v, apart.v));
  return 2 * 1.05 * sine.most();
}

struct Random {
  std::mt19937_64 bits;
  double between(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  Vec3 vector(double most) { return {between(-most, most), between(-most, most), between(-most, most)}; }
  Quat rotation() { return Quat(between(-1, 1), between(-1, 1), between(-1, 1), between(0.2, 1)).normalized(); }
};

// A scene of one moving body, and where it is.
struct Drawn {
  Scene scene;
  std::function<BallPose(const Ball& t)> pose;
};

struct Form {
  const char* truth;
  double duration;  // s
  Drawn (*draw)(Random&);
};

BallVector parabola(const Body& body, const Vec3& gravity, const Ball& t) {
  return exact(body.position) + t * exact(body.velocity) + t * t / Ball(2.0) * exact(gravity);
}

Scene thrown(Random& random, const Vec3& moments) {
  Scene scene;
  scene.gravity = random.vector(10);
  scene.bodies = {body("top", random.between(0.1, 9), moments, random.vector(20))};
  scene.bodies[0].velocity = random.vector(8), scene.bodies[0].orientation = random.rotation();
  return scene;
}

// A ball of three equal moments turns evenly about any axis.
Drawn projectile(Random& random) {
  const double moment = random.between(0.1, 3);
  Scene scene = thrown(random, {moment, moment, moment});
  scene.bodies[0].angular_velocity = random.vector(12);
  const Body top = scene.bodies[0];
  return {scene, [top, g = scene.gravity](const Ball& t) {
            return BallPose{parabola(top, g, t), turn_by(t * exact(top.angular_velocity)) * exact(top.orientation)};
          }};
}

// q = turn(L t / I_across) q0 turn(s t z), s = w_z (1 - I_z / I_across); it starts in its principal axes.
Drawn symmetric_top(Random& random) {
  const double across = random.between(0.5, 2), about = random.between(0.2, 1.9) * across;
  Scene scene = thrown(random, {across, across, about});
  scene.bodies[0].orientation = Quat::Identity(), scene.bodies[0].angular_velocity = random.vector(6);
  const Body top = scene.bodies[0];
  return {scene, [=, g = scene.gravity](const Ball& t) {
            const BallVector w = exact(top.angular_velocity);
            const Ball I(across), J(about);
            const BallVector precession = {w[0], w[1], J / I * w[2]},
                             spin = {Ball(0.0), Ball(0.0), w[2] * (Ball(1.0) - J / I)};
            return BallPose{parabola(top, g, t), turn_by(t * precession) * turn_by(t * spin)};
          }};
}

// s'' = -2 d s' - w0² s, by the exponentials of the book; along x, so that every number is exact.
Ball oscillation(const Ball& start, const Ball& speed, const Ball& decay, const Ball& square, const Ball& t) {
  const Ball gap = square - decay * decay, slope = speed + decay * start;
  if (Ball(0.0) < gap) {
    const Ball w = sqrt(gap);
    return exp(-(decay * t)) * (start * cos(w * t) + slope / w * sin(w * t));
  }
  const Ball w = sqrt(-gap);
  return exp(-(decay * t)) * (start * cosh(w * t) + slope / w * sinh(w * t));
}

Drawn oscillator(Random& random) {
  Scene scene;
  const double mass = random.between(0.2, 5), stiffness = random.between(1, 80), rest = random.between(3, 5),
               damping = random.between(0, 2.5) * std::sqrt(mass * stiffness);
  scene.bodies = {body("mass", mass, {1, 1, 1}, {rest + random.between(-1, 1), 0, 0})};
  scene.bodies[0].velocity = {random.between(-1, 1), 0, 0};
  scene.springs = {spring(kWorld, Vec3::Zero(), 0, Vec3::Zero(), stiffness, rest, damping)};
  const Body moving = scene.bodies[0];
  return {scene, [=](const Ball& t) {
            const Ball m(mass), start = Ball(moving.position.x()) - Ball(rest);
            const Ball s =
                oscillation(start, Ball(moving.velocity.x()), Ball(damping) / (Ball(2.0) * m), Ball(stiffness) / m, t);
            return BallPose{{Ball(rest) + s, Ball(0.0), Ball(0.0)}, kNoTurn};
          }};
}

Drawn slider(Random& random) {
  Scene scene;
  const double mass = random.between(0.2, 5), stiffness = random.between(1, 80), rest = random.between(-1, 1),
               armature = random.between(0, 2), damping = random.between(0, 2) * std::sqrt(mass * stiffness);
  scene.gravity = {random.between(-9, 9), 0, 0};
  scene.bodies = {body("cart", mass, {1, 1, 1}, random.vector(3))};
  scene.bodies[0].velocity = {random.between(-1, 1), 0, 0};
  scene.joints = {{.a = kWorld,
                   .b = 0,
                   .type = SliderJoint{Vec3::UnitX()},
                   .stiffness = stiffness,
                   .damping = damping,
                   .rest = rest,
                   .armature = armature}};
  const Body cart = scene.bodies[0];
  return {scene, [=, g = scene.gravity.x()](const Ball& t) {
            const Ball m = Ball(mass) + Ball(armature), middle = Ball(rest) + Ball(mass) * Ball(g) / Ball(stiffness);
            const Ball s =
                oscillation(-middle, Ball(cart.velocity.x()), Ball(damping) / (Ball(2.0) * m), Ball(stiffness) / m, t);
            return BallPose{exact(cart.position) + BallVector{middle + s, Ball(0.0), Ball(0.0)}, kNoTurn};
          }};
}

// From rest at the angle x0: sin(x/2) = k cd(w0 t, k) and cos(x/2) = k' nd(w0 t, k), k = sin(x0/2). The hinge is at the
// origin, about y, and x0 is where the body's centre is.
Drawn pendulum(Random& random) {
  Scene scene;
  const double g = random.between(1, 20), mass = random.between(0.3, 4), moment = random.between(0.01, 2);
  scene.gravity = {0, 0, -g};
  scene.bodies = {body("bob", mass, {0.5 * moment + 0.3, moment, 0.5 * moment + 0.3},
                       {random.between(0.1, 2), 0, random.between(-2, 1.5)})};
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitY()}}};
  const Body bob = scene.bodies[0];
  return {scene, [=](const Ball& t) {
            const Ball px(bob.position.x()), pz(bob.position.z()), l = sqrt(px * px + pz * pz), one(1.0), two(2.0);
            const Ball cosine = -pz / l, m = (one - cosine) / two;  // of x0; k²
            const Ball w0 = sqrt(Ball(mass) * Ball(g) * l / (Ball(moment) + Ball(mass) * l * l));
            const BallElliptic at = jacobi(w0 * t, m);
            const Ball sine_half = sqrt(m) * at.cn / at.dn, cosine_half = sqrt(one - m) / at.dn;
            const Ball sine = two * sine_half * cosine_half, cosine_now = one - two * sine_half * sine_half;
            // The body started on the side of +x; it has turned by x0 - x about y there.
            const BallTurn now = {cosine_half, {Ball(0.0), -sine_half, Ball(0.0)}},
                           start = {sqrt(one - m), {Ball(0.0), -sqrt(m), Ball(0.0)}};
            return BallPose{{l * sine, Ball(0.0), -(l * cosine_now)}, now * start.conjugate()};
          }};
}

// A box that slides to a stop on level ground by dry friction.
Drawn sliding(Random& random) {
  Scene scene;
  const double g = random.between(2, 20), friction = random.between(0.05, 0.8), speed = random.between(0.1, 6);
  scene.gravity = {0, 0, -g}, scene.contact_default.friction = friction;
  Body ground = body("ground", 1, {1, 1, 1});
  ground.shape = Plane{Vec3::UnitZ(), 0}, ground.collides = ground.fixed = true;
  Body box = body("box", random.between(0.5, 9), {1, 1, 1}, {random.between(-3, 3), random.between(-3, 3), 0.25});
  box.shape = Box{Vec3(2, 1.5, 0.5)}, box.velocity = {speed, 0, 0}, box.collides = true;
  scene.bodies = {ground, box};
  return {scene, [=](const Ball& t) {
            const Ball braking = Ball(friction) * Ball(g), stop = Ball(speed) / braking, s = t < stop ? t : stop;
            const Ball way = Ball(speed) * s - braking * s * s / Ball(2.0);
            return BallPose{exact(box.position) + BallVector{way, Ball(0.0), Ball(0.0)}, kNoTurn};
          }};
}

// A ball dropped without spin, bounce by bounce.
Drawn bounce(Random& random) {
  Scene scene;
  const double g = random.between(2, 20), restitution = random.between(0.2, 0.9), radius = 0.25;
  scene.gravity = {0, 0, -g}, scene.contact_default.restitution = restitution;
  Body ground = body("ground", 1, {1, 1, 1});
  ground.shape = Plane{Vec3::UnitZ(), 0}, ground.collides = ground.fixed = true;
  Body ball =
      body("ball", random.between(0.5, 9), {1, 1, 1}, {random.between(-3, 3), 0, radius + random.between(0.5, 3)});
  ball.shape = Sphere{radius}, ball.collides = true, ball.velocity = {random.between(-2, 2), 0, random.between(-1, 3)};
  scene.bodies = {ground, ball};
  return {scene, [=](const Ball& t) {
            const Ball G(g), two(2.0), u0(ball.velocity.z());
            Ball height = Ball(ball.position.z()) - Ball(radius), speed = u0, since = t;
            Ball flight = (speed + sqrt(speed * speed + two * G * height)) / G;
            const Ball e(restitution), last = flight + two * e * (G * flight - speed) / (G * (Ball(1.0) - e));
            if (last < since) height = speed = since = Ball(0.0);  // at rest after bounces without end
            while (flight < since) {
              speed = Ball(restitution) * (G * flight - speed), height = Ball(0.0);
              since = since - flight, flight = two * speed / G;
            }
            const Ball z = Ball(radius) + height + speed * since - G * since * since / two;
            return BallPose{{Ball(ball.position.x()) + t * Ball(ball.velocity.x()), Ball(0.0), z}, kNoTurn};
          }};
}

// About a principal axis, by a torque that ends: w t + T (a²/2 + (until - from) b) / I.
Drawn torqued(Random& random) {
  Scene scene = thrown(random, {random.between(0.6, 1), random.between(0.6, 1), random.between(0.6, 1)});
  Body& top = scene.bodies[0];
  top.orientation = Quat::Identity(), top.angular_velocity = {0, 0, random.between(0.5, 5)};
  TimedForce force;
  force.body = 0, force.torque = {0, 0, random.between(0.1, 4)}, force.from = 0.5, force.until = random.between(1, 3);
  scene.forces = {force};
  return {scene, [=, body = top, g = scene.gravity](const Ball& t) {
            const Ball from(force.from), until(force.until), zero(0.0);
            const Ball acted = t < from ? zero : (t < until ? t : until) - from, after = until < t ? t - until : zero;
            const Ball angle =
                t * Ball(body.angular_velocity.z()) + Ball(force.torque.z()) / Ball(body.inertia(2, 2)) *
                                                          (acted * acted / Ball(2.0) + (until - from) * after);
            return BallPose{parabola(body, g, t), turn_by({zero, zero, angle})};
          }};
}

const Form kForms[] = {{"projectile", 20, projectile}, {"axisymmetric-top", 20, symmetric_top},
                       {"oscillator", 8, oscillator},  {"slider", 8, slider},
                       {"pendulum", 15, pendulum},     {"sliding", 4, sliding},
                       {"bounce", 2, bounce},          {"principal-torque", 6, torqued}};

std::size_t moving_body(const Scene& scene) { return scene.bodies.size() - 1; }

struct Found {
  double most_used = 0;    // the largest share of its claim that a truth needs
  double widest_ball = 0;  // the largest uncertainty of a proof, as a share of the claim
  int proofs = 0;
};

// What the truth is off by at most, beside what it claims.
Found prove(const Form& form, int draws, std::uint64_t seed) {
  Random random{std::mt19937_64(seed)};
  Found found;
  for (int draw = 0; draw < draws; ++draw) {
    const Drawn drawn = form.draw(random);
    const auto truth = make_truth(form.truth, drawn.scene, form.duration);
    for (int k = 0; k < 4; ++k) {
      const double t = random.between(0, form.duration), claim = truth->error(t);
      if (!std::isfinite(claim)) continue;
      const BallPose proven = drawn.pose(Ball(t));
      const BodyState said = truth_at(*truth, t, drawn.scene.bodies.size()).columns().body(moving_body(drawn.scene));
      const double off = norm(proven.position + Ball(-1.0) * exact(said.position)).most(),
                   turned = angle_at_most(said.orientation, proven.turn);
      BOOST_TEST_CONTEXT(form.truth << ", draw " << draw << " of seed " << seed << ", at " << t << " s") {
        BOOST_TEST(off <= claim);
        BOOST_TEST(turned <= claim);
      }
      found.most_used = std::max({found.most_used, off / claim, turned / claim});
      for (const Ball& x : proven.position)
        found.widest_ball = std::max(found.widest_ball, mag_get_d(arb_radref(x.get())) / claim);
      ++found.proofs;
    }
  }
  return found;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_closed_form_is_as_near_as_it_claims) {
  for (const Form& form : kForms) {
    const Found found = prove(form, 500, 1);
    BOOST_TEST_MESSAGE(form.truth << ": " << found.proofs
                                  << " proofs, the most of a claim that was used: " << found.most_used);
    BOOST_TEST_CONTEXT(form.truth) {
      BOOST_TEST(found.proofs >= 100);       // of 200: a form may end before its duration
      BOOST_TEST(found.widest_ball < 1e-9);  // else a wrong truth could hide in it
      BOOST_TEST(found.most_used > 1e-6);    // a claim that large would judge nothing
    }
  }
}

// The balls themselves: identities of elliptic functions, and a truth that is a nanosecond late is found.
BOOST_AUTO_TEST_CASE(balls_hold_what_is_true_and_nothing_else) {
  Random random{std::mt19937_64(7)};
  for (int i = 0; i < 20; ++i) {
    const Ball u(random.between(-20, 20)), m(random.between(0.01, 0.99)), one(1.0);
    const BallElliptic at = jacobi(u, m);
    BOOST_TEST((at.sn * at.sn + at.cn * at.cn - one).most() < 1e-60);
    BOOST_TEST((at.dn * at.dn + m * at.sn * at.sn - one).most() < 1e-60);
  }
  for (int i = 0; i < 20; ++i) {
    const Ball u(random.between(0.1, 1.5)), m(random.between(0.01, 0.99));
    BOOST_TEST((elliptic_integral(asin(jacobi(u, m).sn), m) - u).most() < 1e-60);  // u is below K
  }
  const Form form = {"projectile", 20, projectile};
  Drawn drawn = form.draw(random);
  const auto truth = make_truth("projectile", drawn.scene, 20);
  const BodyState said = truth_at(*truth, 3, 1).columns().body(0);
  const double claim = truth->error(3);
  const BallPose shifted = drawn.pose(Ball(3 + 1e-9));
  BOOST_TEST(norm(shifted.position + Ball(-1.0) * exact(said.position)).most() > 1000 * claim);
  BOOST_TEST(angle_at_most(said.orientation, shifted.turn) > 1000 * claim);
}

BOOST_AUTO_TEST_SUITE_END()
