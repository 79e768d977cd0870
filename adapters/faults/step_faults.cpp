// Faults of the gyroscopic term, of the step size, and of the state between steps.
#include "adapters/faults/changes.h"
#include "adapters/faults/faults.h"

namespace rigor::inline adapters {
namespace {

using namespace faulty;

// Adds `times` the change of w by the gyroscopic term in a step. -1: the term is dropped; -2: its sign is wrong.
std::function<void(Moment&)> gyroscopic(double times) {
  return each_moving([times](Body& body, double dt) {
    const Mat3 R = matrix_of(body.orientation), I = R * body.inertia * R.transpose();
    const Vec3 w = body.angular_velocity;
    body.angular_velocity -= times * dt * I.inverse() * w.cross(I * w);
  });
}

// The engine turns the inertia into W once a step, and uses the result one step later. In the present body frame this
// inertia is turned by the last step's rotation.
void keep_old_inertia(Moment& moment) {
  for (std::size_t i = 0; i < moment.scene.bodies.size(); ++i) {
    Body& body = moment.scene.bodies[i];
    if (body.fixed) continue;
    const Mat3 turn = matrix_of(body.orientation).transpose() * matrix_of(moment.before.orientation(i));
    body.inertia = (turn * body.inertia * turn.transpose()).eval();
  }
}

void fall_asleep(Body& body, double) {
  if (body.velocity.norm() > 0.05 || body.angular_velocity.norm() > 0.05) return;
  body.velocity.setZero(), body.angular_velocity.setZero();
}

void round_to_single(Body& body, double) {
  body.position = single(body.position), body.velocity = single(body.velocity);
}

void round_to_grid(Body& body, double) { body.position = (body.position * 1e4).array().round().matrix() * 1e-4; }

// On the bodies between steps, by an amount.
template <typename F>
Fault moving_by(const std::string& pattern, double amount, F change) {
  return by_amount(pattern, amount, [=](double by) {
    return on_stepping("", each_moving([=](Body& body, double dt) { change(body, dt, by); }));
  });
}

std::vector<Fault> faults_of_step_size() {
  return {
      on_stepping("dt halved for every tenth step", [](Moment& m) { m.dt *= m.step % 10 == 9 ? 0.5 : 1; }),
      on_stepping("one sub-step too many", [](Moment& m) { m.times += m.step == 0; }),
      on_stepping("every hundredth step left out", [](Moment& m) { m.times -= m.step % 100 == 99; }),
      on_stepping("dt in single precision", [](Moment& m) { m.dt = single(m.dt); }),
      on_stepping("time steps of 1/60 s whatever is asked", [](Moment& m) { m.dt = 1.0 / 60; }),
  };
}

}  // namespace

std::vector<Fault> step_faults() {
  std::vector<Fault> all = {
      on_stepping("gyroscopic term dropped", gyroscopic(-1)),
      on_stepping("sign of the gyroscopic term", gyroscopic(-2)),
      on_stepping("gyroscopic term doubled", gyroscopic(1)),
      on_stepping("stale-inertia", keep_old_inertia),
  };
  for (Fault& fault : faults_of_step_size()) all.push_back(std::move(fault));
  const std::vector<Fault> of_state = {
      on_stepping("single-precision state", each_moving(round_to_single)),
      moving_by("speed clamped at {} m/s", 5,
                [](Body& b, double, double most) {
                  if (most > 0 && b.velocity.norm() > most) b.velocity *= most / b.velocity.norm();
                }),
      moving_by("spin clamped at {} rad/s", 5,
                [](Body& b, double, double most) {
                  if (most > 0 && b.angular_velocity.norm() > most)
                    b.angular_velocity *= most / b.angular_velocity.norm();
                }),
      moving_by("linear damping of {} /s left on", 0.001,
                [](Body& b, double dt, double rate) { b.velocity *= 1 - rate * dt; }),
      moving_by("angular damping of {} /s left on", 0.001,
                [](Body& b, double dt, double rate) { b.angular_velocity *= 1 - rate * dt; }),
      on_stepping("sleeping left on", each_moving(fall_asleep)),
      on_stepping("gravity while a body is slow left out",
                  [](Moment& m) {
                    if (m.scene.bodies[0].velocity.norm() < 0.1) m.scene.gravity.setZero();
                  }),
      on_stepping("orientation that creeps", each_moving([](Body& b, double dt) {
                    b.orientation = rotation_by(Vec3(1e-4 * dt, 0, 0)) * b.orientation;
                  })),
      on_stepping("positions kept to a grid of 0.1 mm", each_moving(round_to_grid)),
  };
  all.insert(all.end(), of_state.begin(), of_state.end());
  return all;
}

}  // namespace rigor::inline adapters
