#include "cases/runner/simulate.h"

#include <fmt/format.h>

#include <ctime>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/dynamics/model/system.h"
#include "core/engine/engine.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline runner {
namespace {

constexpr std::size_t kMostContacts = 1'000'000;  // of a step: 100 MB

// Includes all threads, because an engine may let others do its work.
double cpu_seconds_so_far() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The same, with what an engine in another process has spent for this world.
double cpu_seconds_so_far(World& world) { return cpu_seconds_so_far() + remote_cpu_seconds(world); }

// What a pair of clock readings measures of itself: it would otherwise be a good part of a small scene's step.
double cost_of_reading_the_clock() {
  static const double cost = [] {
    constexpr int kPairs = 1000;
    std::vector<double> costs;
    for (int i = 0; i < kPairs; ++i) {
      const double begin = cpu_seconds_so_far();
      costs.push_back(cpu_seconds_so_far() - begin);
    }
    std::nth_element(costs.begin(), costs.begin() + kPairs / 2, costs.end());
    return costs[kPairs / 2];
  }();
  return cost;
}

// CPU seconds of one step, read on the clock before and after it.
template <typename Step>
double seconds_of_step(World& world, const Step& step) {
  const double begin = cpu_seconds_so_far(world);
  step();
  return std::max(0.0, cpu_seconds_so_far(world) - begin - cost_of_reading_the_clock());
}

// Whether it can an engine says when it is given the scene, or the step. Said of a later step it would leave out of
// the judgement a run that is already known.
void step_as_agreed(World& world, double dt, long steps_before) {
  try {
    world.step(dt);
  } catch (const EngineFailure& failure) {
    if (failure.kind() != FailureKind::unsupported || steps_before == 0) throw;
    throw EngineFailure(FailureKind::invalid, fmt::format("after {} steps {}", steps_before, failure.what()));
  }
}

// A quaternion of no length is no rotation, and has no angle from any.
void check_orientations(BodyColumns bodies, const Scene& scene, double t) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies.orientation(i).squaredNorm() > 0) continue;
    throw EngineFailure(FailureKind::invalid, fmt::format("at {:.4g} s the orientation of '{}' is the zero quaternion, "
                                                          "which is no rotation",
                                                          t, scene.bodies[i].name));
  }
}

// Throws EngineFailure (invalid) for a contact that cannot be one.
std::vector<ReportedContact> checked_contacts(World& world, const Scene& scene) {
  constexpr double kUnit = 1e-5;  // of a normal in single precision
  std::vector<ReportedContact> contacts = reported_contacts(world);
  const auto refuse = [](const std::string& why) {
    throw EngineFailure(FailureKind::invalid, "the engine reports a contact " + why);
  };
  if (contacts.size() > kMostContacts)
    throw EngineFailure(FailureKind::invalid, fmt::format("the engine reports {} contacts of one step; {} are allowed",
                                                          contacts.size(), kMostContacts));
  const int bodies = static_cast<int>(scene.bodies.size());
  for (const ReportedContact& contact : contacts) {
    if (std::min(contact.a, contact.b) < 0 || std::max(contact.a, contact.b) >= bodies || contact.a == contact.b)
      refuse(fmt::format("of bodies {} and {}; the scene has {}", contact.a, contact.b, bodies));
    const std::string of =
        fmt::format("of '{}' and '{}' whose ", scene.bodies[static_cast<std::size_t>(contact.a)].name,
                    scene.bodies[static_cast<std::size_t>(contact.b)].name);
    if (!contact.point.allFinite()) refuse(of + "point is not finite");
    if (!contact.force.allFinite()) refuse(of + "force is not finite");
    if (!std::isfinite(contact.gap)) refuse(of + "gap is not finite");
    if (!(std::abs(contact.normal.norm() - 1) < kUnit)) refuse(of + "normal is no unit vector");
  }
  return contacts;
}

// Steps from one recorded sample to the next.
long steps_per_sample(long steps, BodyColumns bodies, std::size_t joints) {
  const double bytes =
      sizeof(Sample) + static_cast<double>(joints * sizeof(ReportedReaction)) +
      sizeof(double) * static_cast<double>(bodies.size() + 7) * (bodies.has_rotation() ? kRotation + 9 : kRotation);
  return std::max(1L, static_cast<long>(std::ceil(bytes * static_cast<double>(steps) / kLargestTrajectory)));
}

// CPU seconds of a world's first steps, from its start.
struct StepClock {
  const Engine& engine;
  const Settings& settings;
  const Scene& scene;
  double dt;
  long steps;

  double without_pause() const {
    const std::unique_ptr<World> world = engine.load(scene, settings);
    expect_steps(*world, dt, steps, steps);
    const double begin = cpu_seconds_so_far(*world);
    for (long n = 0; n < steps; ++n) world->step(dt);
    return cpu_seconds_so_far(*world) - begin;
  }

  // As in simulate().
  double step_by_step() const {
    const std::unique_ptr<World> world = engine.load(scene, settings);
    expect_steps(*world, dt, steps, 1);
    Snapshot now;
    double sum = 0;
    for (long n = 0; n < steps; ++n) {
      sum += seconds_of_step(*world, [&] { world->step(dt); });
      world->read(now);
    }
    return sum;
  }
};

}  // namespace

std::optional<int> body_not_finite(BodyColumns bodies) {
  const int count = bodies.has_rotation() ? kRotation + 9 : kRotation;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (int c = 0; c < count; ++c) {
      if (!std::isfinite(bodies.column(c)[i])) return static_cast<int>(i);
    }
  }
  return {};
}

Simulation simulate(const Engine& engine, const Settings& settings, const Scene& scene, double dt, double duration,
                    const RecordingOptions& options) {
  const std::unique_ptr<World> world = engine.load(scene, settings);
  Simulation run;
  run.trajectory.dt = dt;
  run.settings = world->settings_in_force();

  Snapshot now;
  world->read(now);
  const long steps = steps_in(duration, dt),
             every = options.steps_per_sample.value_or(steps_per_sample(steps, now.bodies(), scene.joints.size()));
  run.steps_per_sample = every;
  expect_steps(*world, dt, steps, 1);  // each is looked at
  const long reactions_every = options.reactions_every;
  const auto is_reported = [&](long step) {
    return reactions_every > 0 && step >= 2 && (step - 2) % reactions_every == 0;
  };
  if (options.has_contacts)
    run.trajectory.contacts = ask_for_contacts(*world) ? ContactRecords::kept : ContactRecords::not_reported;
  const bool has_contacts = run.trajectory.contacts == ContactRecords::kept;
  ask_for_reactions(*world);  // always: to be asked may change an engine's roundings
  if (!options.is_timed) run.cpu_seconds = std::numeric_limits<double>::quiet_NaN();
  for (long n = 0;; ++n) {
    if (const auto body = body_not_finite(now.bodies())) {
      run.not_finite = NotFinite{now.time, *body};
      run.reduced_order = reduced_order_of(*world);
      run.sub_step = sub_step_of(*world);
      return run;
    }
    check_orientations(now.bodies(), scene, now.time);
    if (n % every == 0 || n == steps)
      run.trajectory.samples.push_back(
          {now.time, KeptBodies(now.bodies()),
           is_reported(n) ? reported_reactions(*world) : std::vector<ReportedReaction>(),
           has_contacts ? checked_contacts(*world, scene) : std::vector<ReportedContact>()});
    if (n == steps) {
      run.settings = world->settings_in_force();  // some worlds report settings that depend on the run
      run.reduced_order = reduced_order_of(*world);
      run.sub_step = sub_step_of(*world);
      return run;
    }
    report_reactions(*world, is_reported(n + 1));
    const auto step = [&] { step_as_agreed(*world, dt, n); };
    if (options.is_timed) {
      run.cpu_seconds += seconds_of_step(*world, step);
    } else {
      step();
    }
    world->read(now);
    if (run.solver_warning.empty()) {
      run.solver_warning = world->solver_warning();
      if (!run.solver_warning.empty()) run.solver_warning_time = now.time;
    }
  }
}

void check_start(const Simulation& run, const Scene& scene) {
  constexpr double kOfSinglePrecision = 1e-5;  // rad, or of the largest: some hundred of its roundings
  constexpr double kOfNothing = 1e-9;          // m, m/s, rad/s: where all values are 0
  if (run.trajectory.samples.empty()) return;
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  const BodyColumns due = std::as_const(start).columns(), found = run.trajectory.samples.front().bodies.columns();
  const auto check = [&](const char* what, const char* unit, std::size_t body, double off, double allowed) {
    if (off <= allowed) return;
    throw EngineFailure(FailureKind::invalid, fmt::format("at t = 0 the {} of '{}' is {:.4g} {} from the scene's", what,
                                                          scene.bodies[body].name, off, unit));
  };
  double far = 0, fast = 0, quick = 0;
  for (std::size_t i = 0; i < due.size(); ++i) {
    far = std::max(far, due.position(i).norm()), fast = std::max(fast, due.velocity(i).norm());
    quick = std::max(quick, due.angular_velocity(i).norm());
  }
  const auto allowed = [&](double largest) { return kOfSinglePrecision * largest + kOfNothing; };
  for (std::size_t i = 0; i < due.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.shape && std::holds_alternative<Plane>(*body.shape)) continue;  // where its origin is means nothing
    check("position", "m", i, (found.position(i) - due.position(i)).norm(), allowed(far));
    check("orientation", "rad", i, angle_between(found.orientation(i), due.orientation(i)), kOfSinglePrecision);
    check("velocity", "m/s", i, (found.velocity(i) - due.velocity(i)).norm(), allowed(fast));
    check("angular velocity", "rad/s", i, (found.angular_velocity(i) - due.angular_velocity(i)).norm(), allowed(quick));
  }
}

double timed_again(const Engine& engine, const Settings& settings, const Scene& scene, const Simulation& run) {
  constexpr double kLongStep = 20e-6, kEnough = 4e-3;  // s; a hundred times the cost of reading the clock; total timing
  constexpr int kMost = 100;                           // repeats
  const auto& samples = run.trajectory.samples;
  const long steps = samples.empty() ? 0 : std::lround(samples.back().time / run.trajectory.dt);
  if (steps == 0 || run.cpu_seconds > kLongStep * static_cast<double>(steps)) return run.cpu_seconds;
  const double step = run.cpu_seconds / static_cast<double>(steps) + cost_of_reading_the_clock();
  const long first = std::min(steps, static_cast<long>(std::ceil(kEnough / step)));
  StepClock clock{engine, settings, scene, run.trajectory.dt, first};
  double quickest = clock.without_pause(), spent = quickest;
  if (first == steps) {
    for (int repeat = 1; repeat < kMost && spent < kEnough; ++repeat) {
      const double seconds = clock.without_pause();
      quickest = std::min(quickest, seconds), spent += seconds;
    }
    return quickest;
  }
  quickest = std::min(quickest, clock.without_pause());
  const double each = std::min(clock.step_by_step(), clock.step_by_step());
  const double of_clock = std::max(0.0, each - quickest) / static_cast<double>(first);
  return std::max(quickest, run.cpu_seconds - of_clock * static_cast<double>(steps));
}

}  // namespace rigor::inline runner
