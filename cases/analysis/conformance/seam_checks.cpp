// Rules that hold before anything moves, and rules of the calls: time, order, bits, refusals.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "cases/analysis/conformance/trial.h"
#include "core/base/near_match.h"
#include "core/engine/engine.h"

namespace rigor::inline analysis::conformance {
namespace {

// A word of a later version is ignored. A mistyped word is rejected, because the engine would lack that feature.
CheckResult says_what_it_is(const Trial& trial) {
  std::vector<std::string> known;
  for (const FeatureWord& row : feature_words()) known.push_back(row.word);
  for (const std::string& word : trial.info.unknown_features) {
    const std::string meant = did_you_mean(word, known);
    if (!meant.empty())
      return broken("info", fmt::format("the feature '{}'{}", word, meant), "one of: " + listed(known));
  }
  return holds();
}

CheckResult time_advances_by_dt(const Trial& trial) {
  TriedWorld world(trial, scene_of(round_body()));
  Comparison is("");
  if (const double t = world.time(); t != 0)
    return broken(world.sent() + "; read", fmt::format("time {:.12g}", t), "0");
  world.step(1.0 / 30, 30);
  const double after = world.time();
  world.step(0.25);
  Comparison time(world.sent() + "; read");
  // Thirty roundings of a sum.
  time.number("time", after, 1, 30 * rounding_of(trial));
  time.number("time", world.time(), 1.25, 30 * rounding_of(trial));
  return time.result();
}

// Bodies as unlike each other as they can be, told apart by every number.
Scene three_bodies() {
  Scene scene = scene_of(odd_body());
  for (int k = 1; k < 3; ++k) {
    Body body = round_body();
    body.name = fmt::format("body {}", k + 1), body.mass = 1 + k;
    body.position += Vec3(10.0 * k, 1.0 / 3, -k), body.velocity *= -k, body.angular_velocity *= 1 + k;
    body.orientation = Quat(0.3, -0.4 * k, 0.2, 0.1).normalized();
    scene.bodies.push_back(body);
  }
  return scene;
}

CheckResult load_then_read_is_the_scene(const Trial& trial) {
  const Scene scene = three_bodies();
  TriedWorld world(trial, scene);
  const BodyTable state = world.state();
  Comparison same(world.sent() + "; read");
  const double eps = rounding_of(trial);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& due = scene.bodies[i];
    const BodyState came = state.columns().body(i);
    const std::string of = fmt::format(" of '{}'", due.name);
    // Two roundings of each number; an engine may keep another quaternion or matrix than it was given.
    same.vector("position" + of, came.position, due.position, 2 * eps * due.position.norm());
    same.orientation(came.orientation, due.orientation, 20 * eps);
    same.number("the length of the quaternion" + of, came.orientation.norm(), 1, 20 * eps);
    same.vector("velocity" + of, came.velocity, due.velocity, 4 * eps * due.velocity.norm());
    same.vector("angular velocity" + of, came.angular_velocity, due.angular_velocity,
                20 * eps * due.angular_velocity.norm());
  }
  return same.result();
}

// Single precision gets wider tolerances, so the claim is checked. A number rounded to single lies within a thousandth
// of single's last digit of the double by chance once in a thousand times, and eighteen in a row never do.
CheckResult it_is_no_better_than_it_says(const Trial& trial) {
  if (trial.info.precision != "single") return not_asked("it says double precision, which the others ask for");
  const Scene scene = three_bodies();
  constexpr double dt = 1e-2, kFar = 1e-3;
  TriedWorld world(trial, scene);
  const BodyTable state = world.step(dt).state();
  double most = 0;  // of what a rounding to single may move each number by
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const Vec3 place = body.position + dt * body.velocity, moved = state.columns().position(i) - place,
               sped = state.columns().velocity(i) - body.velocity;
    most = std::max({most, moved.cwiseQuotient(place).cwiseAbs().maxCoeff(),
                     sped.cwiseQuotient(body.velocity).cwiseAbs().maxCoeff()});
  }
  if (most > kFar * rounding_of(trial)) return holds();
  return broken(world.sent() + "; read", fmt::format("places and velocities right to {:.2g} of them", most),
                "roundings of single precision, for which limits are widened, or to say 'double'");
}

CheckResult a_fixed_body_stays(const Trial& trial) {
  Body fixed = round_body();
  fixed.fixed = true, fixed.velocity = fixed.angular_velocity = Vec3::Zero();
  const Scene scene = scene_of(fixed, {0, 0, -9.81});
  if (const std::string why = why_not(trial, scene, 1e-2); !why.empty()) return not_asked(why);
  TriedWorld world(trial, scene);
  const BodyState came = world.step(1e-2, 50).state().columns().body(0);
  Comparison same(world.sent() + "; read");
  same.vector("position", came.position, fixed.position, 2 * rounding_of(trial) * fixed.position.norm());
  same.vector("velocity", came.velocity, Vec3::Zero(), 0);
  same.vector("angular velocity", came.angular_velocity, Vec3::Zero(), 0);
  return same.result();
}

CheckResult difference_in_bits(const std::string& sent, const BodyTable& came, const BodyTable& due) {
  for (int c = 0; c < 13; ++c) {
    for (std::size_t i = 0; i < due.size(); ++i) {
      const double a = came.columns().column(c)[i], b = due.columns().column(c)[i];
      if (std::memcmp(&a, &b, sizeof a) != 0)
        return broken(sent, fmt::format("{} of body {} is {:.17g}", kColumnNames[c], i, a),
                      fmt::format("{:.17g}, the same bits as at first", b));
    }
  }
  return holds();
}

CheckResult two_runs_give_the_same_bits(const Trial& trial) {
  const Scene scene = scene_of(odd_body(), {1, 2, -9.81});
  const BodyTable first = TriedWorld(trial, scene).step(1.0 / 120, 60).state();
  TriedWorld second(trial, scene);
  second.step(1.0 / 120, 60);
  return difference_in_bits(second.sent() + "; read, twice", second.state(), first);
}

CheckResult worlds_are_apart(const Trial& trial) {
  const Scene scene = scene_of(odd_body(), {1, 2, -9.81});
  const BodyTable alone = TriedWorld(trial, scene).step(1.0 / 120, 20).state();
  TriedWorld other(trial, three_bodies()), world(trial, scene);
  for (int n = 0; n < 20; ++n) other.step(1.0 / 60), world.step(1.0 / 120);
  return difference_in_bits(world.sent() + ", in turn with steps of another world; read", world.state(), alone);
}

CheckResult run_is_as_many_steps(const Trial& trial) {
  const Scene scene = scene_of(odd_body(), {1, 2, -9.81});
  constexpr int kSteps = 50, kEvery = 7;
  const BodyTable stepped = TriedWorld(trial, scene).step(1e-2, kSteps).state();
  const auto world = trial.engine.load(scene, trial.settings);
  RemoteRuns* remote = world->capabilities().remote;
  if (!remote) return not_asked("it is in this process");
  remote->expect(1e-2, kSteps, kEvery);
  for (int n = 0; n < kSteps; ++n) world->step(1e-2);
  Snapshot now;
  world->read(now);
  return difference_in_bits(fmt::format("50 steps by run (where the engine has it), every {}-th sampled", kEvery),
                            BodyTable(now.bodies()), stepped);
}

// Loaded scenes of the same kind begin with other states than the saved one, so that a restore that does nothing shows.
CheckResult a_saved_state_is_restored(const Trial& trial) {
  const Scene scene = scene_of(odd_body(), {1, 2, -9.81});
  constexpr double dt = 1.0 / 120;
  constexpr int kBefore = 25, kAfter = 35;
  const auto world = trial.engine.load(scene, trial.settings), fresh = trial.engine.load(scene, trial.settings);
  if (!world->capabilities().state) return not_asked("it saves no state");
  const auto end_of = [&](World& restored) {
    for (int n = 0; n < kAfter; ++n) restored.step(dt);
    Snapshot now;
    restored.read(now);
    return BodyTable(now.bodies());
  };
  for (int n = 0; n < kBefore; ++n) world->step(dt);
  const auto saved = world->capabilities().state->save();
  const BodyTable due = end_of(*world);
  for (World* restored : {world.get(), fresh.get()}) {
    restored->capabilities().state->restore(*saved);
    Snapshot now;
    restored->read(now);
    const char* which = restored == world.get() ? "the same world" : "a fresh world";
    if (const double due_time = kBefore * dt; std::abs(now.time - due_time) > 30 * rounding_of(trial))
      return broken(fmt::format("restore into {}; read", which), fmt::format("time {:.12g}", now.time),
                    fmt::format("{:.12g}", due_time));
    const CheckResult same = difference_in_bits(
        fmt::format("{} steps, save, restore into {}, {} steps; read", kBefore, which, kAfter), end_of(*restored), due);
    if (same.answer != CheckResult::Answer::holds) return same;
  }
  return holds();
}

CheckResult what_is_not_declared_is_refused(const Trial& trial) {
  Scene scene = scene_of(round_body());
  const std::vector<decltype(Joint::type)> types = {BallJoint{{0, 0, 0}}, HingeJoint{{0, 0, 0}, {0, 0, 1}},
                                                    SliderJoint{{0, 0, 1}}, FixedJoint{}};
  for (const auto& type : types) {
    scene.joints = {{kWorld, 0, type}};
    const Feature feature = joint_feature(type);
    const std::string word = word_of(feature), why = why_not(trial, scene, 1e-2);
    if (trial.info.features.contains(feature) || why.find(word) != std::string::npos) continue;
    return broken("a scene with " + word, why.empty() ? "that it can" : why, "a refusal that names " + word);
  }
  return holds();
}

}  // namespace

std::vector<ConformanceCheck> seam_checks() {
  return {{"info", "it says what it is, in words that are known", says_what_it_is},
          {"time", "time begins at 0 and advances by dt, whatever dt is", time_advances_by_dt},
          {"load-then-read", "what is read after loading is the scene, body by body, to its precision",
           load_then_read_is_the_scene},
          {"precision", "one that says single precision is not of double", it_is_no_better_than_it_says},
          {"fixed-body", "a fixed body stays where it is", a_fixed_body_stays},
          {"same-bits", "two runs give the same bits", two_runs_give_the_same_bits},
          {"saved-state", "a saved state, restored into the same world or a fresh one, goes on with the same bits",
           a_saved_state_is_restored},
          {"worlds-apart", "two worlds do not disturb each other", worlds_are_apart},
          {"run", "a request for many steps is as many steps", run_is_as_many_steps},
          {"refusals", "a scene that needs what is not declared is refused, with the reason",
           what_is_not_declared_is_refused}};
}

}  // namespace rigor::inline analysis::conformance
