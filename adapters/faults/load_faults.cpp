// Springs, dampers and timed forces.
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "adapters/faults/changes.h"
#include "adapters/faults/faults.h"

namespace rigor::inline adapters {
namespace {

using namespace faulty;

Vec3 speed_of_point(const Body& body, const Vec3& point_B) {
  return body.velocity + body.angular_velocity.cross(body.orientation * point_B);
}

// A damper that brakes every motion of its end, and not only that along its line.
void damp_all_ways(Moment& moment) {
  for (Spring& spring : moment.scene.springs) {
    if (spring.b == kWorld) continue;
    Body& body = moment.scene.bodies[spring.b];
    push(body, -spring.damping * moment.dt * speed_of_point(body, spring.point_b), spring.point_b);
    spring.damping = 0;
  }
}

Vec3 end_of(const Scene& scene, int body, const Vec3& point) {
  return body == kWorld ? point : scene.bodies[body].position + scene.bodies[body].orientation * point;
}

// A spring between two bodies acts on b alone: its force on a is removed.
void drop_reactions(Moment& moment) {
  for (const Spring& spring : moment.scene.springs) {
    if (spring.a == kWorld || spring.b == kWorld) continue;
    const Vec3 line = end_of(moment.scene, spring.b, spring.point_b) - end_of(moment.scene, spring.a, spring.point_a);
    const Vec3 on_a = elastic_effort(spring, line.norm() - spring.rest_length) * line.normalized();
    push(moment.scene.bodies[spring.a], -moment.dt * on_a, spring.point_a);
  }
}

void slacken_when_short(Moment& moment) {
  for (Spring& spring : moment.scene.springs) {
    const Vec3 line = end_of(moment.scene, spring.b, spring.point_b) - end_of(moment.scene, spring.a, spring.point_a);
    if (line.norm() < spring.rest_length) spring.stiffness = spring.quadratic_stiffness = 0;
  }
}

void leave_arms_behind(Moment& moment) {
  for (Spring& s : moment.scene.springs) {
    if (s.b != kWorld) s.point_b = moment.scene.bodies[s.b].orientation.conjugate() * s.point_b;
  }
}

void forces_in_body_frame(Moment& moment) {
  for (TimedForce& force : moment.scene.forces) force.force = moment.scene.bodies[force.body].orientation * force.force;
}

void torques_in_body_frame(Moment& moment) {
  for (TimedForce& force : moment.scene.forces)
    force.torque = moment.scene.bodies[force.body].orientation * force.torque;
}

void forces_a_step_late(Moment& moment) {
  for (TimedForce& force : moment.scene.forces) force.from += moment.dt, force.until += moment.dt;
}

// The load of a step remains in the next, which adds its own.
void forces_add_up(Moment& moment) {
  for (std::size_t i = 0; i < moment.scene.forces.size(); ++i) {
    TimedForce& force = moment.scene.forces[i];
    const double since = moment.time - moment.original.forces[i].from;
    if (since < 0 || force.until <= 0) continue;
    const double applied = 1 + std::floor(since / moment.dt + 0.5);
    force.force *= applied, force.torque *= applied;
  }
}

template <typename F>
Fault spring_by(const std::string& pattern, double amount, F change) {
  return by_amount(pattern, amount,
                   [=](double by) { return on_loading("", each_spring([=](Spring& s) { change(s, by); })); });
}

std::vector<Fault> spring_faults() {
  return {
      spring_by("spring stiffness off by {} %", 0.1,
                [](Spring& s, double percent) {
                  s.stiffness *= 1 + percent / 100, s.quadratic_stiffness *= 1 + percent / 100;
                }),
      on_loading("spring counted twice",
                 [](Scene& s) {
                   if (!s.springs.empty()) s.springs.push_back(Spring(s.springs.back()));
                 }),
      on_loading("a spring left out",
                 [](Scene& s) {
                   if (!s.springs.empty()) s.springs.pop_back();
                 }),
      spring_by("spring rest length off by {} mm", 1, [](Spring& s, double mm) { s.rest_length += 1e-3 * mm; }),
      on_loading("spring rest length left out", each_spring([](Spring& s) { s.rest_length = 0; })),
      on_stepping("spring slack when short", slacken_when_short),
      on_loading("torque arm dropped", each_spring([](Spring& s) { s.point_b.setZero(); })),
      on_loading("torque arm reversed", each_spring([](Spring& s) { s.point_b *= -1; })),
      on_stepping("torque arm not turned with the body", leave_arms_behind),
      on_loading("a spring's ends swapped", each_spring([](Spring& s) { std::swap(s.point_a, s.point_b); })),
      on_stepping("a spring without reaction", drop_reactions),
      on_loading("damping left out", each_spring([](Spring& s) { s.damping = 0; })),
      spring_by("damping off by {} %", 1, [](Spring& s, double percent) { s.damping *= 1 + percent / 100; }),
      on_loading("damping that drives", each_spring([](Spring& s) { s.damping *= -1; })),
      on_stepping("damping along the wrong direction", damp_all_ways),
  };
}

// State of the library that no world owns: a run differs from the same run before it.
void count_worlds(Scene& scene) {
  static std::atomic<int> worlds = 0;
  scene.gravity *= 1 + 1e-12 * ++worlds;
}

}  // namespace

std::vector<Fault> load_faults() {
  std::vector<Fault> all = spring_faults();
  const std::vector<Fault> of_forces = {
      by_amount("force off by {} %", 0.1,
                [](double percent) {
                  return on_loading("", each_force([=](TimedForce& f) { f.force *= 1 + percent / 100; }));
                }),
      on_loading("force that does not end",
                 each_force([](TimedForce& f) { f.until = std::numeric_limits<double>::infinity(); })),
      on_stepping("force not cleared after a step", forces_add_up),
      on_stepping("force applied one step late", forces_a_step_late),
      on_stepping("force taken in the body frame", forces_in_body_frame),
      on_loading("force's arm dropped", each_force([](TimedForce& f) { f.point.setZero(); })),
      on_loading("torque left out", each_force([](TimedForce& f) { f.torque.setZero(); })),
      on_stepping("torque taken in the body frame", torques_in_body_frame),
      on_loading("torque reversed", each_force([](TimedForce& f) { f.torque *= -1; })),
  };
  all.insert(all.end(), of_forces.begin(), of_forces.end());
  all.push_back(on_loading("gravity that counts the loaded worlds", count_worlds));
  return all;
}

}  // namespace rigor::inline adapters
