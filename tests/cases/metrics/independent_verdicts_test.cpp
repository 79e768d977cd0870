// Verdicts and impacts of engines' runs on cases of the suite, beside rules that share no code with the judge.
// Positions and orientations alone enter: velocities are their central differences, energies are summed here, and a
// wall is passed where a body ends behind it.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numeric>

#include "cases/case/suite.h"
#include "cases/metrics/verdict.h"
#include "tests/cases/judged.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

namespace {

struct Judged {
  Scene scene;
  Simulation run;
  TruthSamples truth;
  Stability verdict;
  MetricResult restitution;
};

Judged judged(const std::string& id, const std::string& name, double dt) {
  const Case definition = select_cases({id}, default_suite_dir(), test::words()).at(0);
  const RunName run_name = parse_run_name(name, infos_of(engines()));
  const Engine& engine = find_engine(engines(), run_name.engine);
  Judged made{
      definition.scene, simulate(engine, run_name.settings, definition.scene, dt, definition.duration), {}, {}, {}};
  const auto truth = make_truth(definition.truth, definition.scene, definition.duration);
  if (truth) {
    made.truth = test::sampled(*truth, made.run.trajectory, made.scene,
                               energy_extremes(made.scene, truth.get(), definition.duration).kinetic);
  }
  JudgedRun run{made.scene, made.run.trajectory, truth ? &made.truth : nullptr,
                method_of(engine.info(), run_name.settings).leapfrog_stagger};
  run.duration = definition.duration;
  made.verdict = verdict_on(run);
  made.restitution = test::measured("restitution_error", run);
  return made;
}

Vec3 end_of(BodyColumns bodies, int body, const Vec3& point) {
  if (body == kWorld) return point;
  return bodies.position(body) + matrix_of(bodies.orientation(body).normalized()) * point;
}

// J, of gravity and springs.
double potential(const Scene& scene, BodyColumns bodies) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    sum -= scene.bodies[i].fixed ? 0 : scene.bodies[i].mass * scene.gravity.dot(bodies.position(i));
  for (const Spring& spring : scene.springs) {
    const double length = (end_of(bodies, spring.a, spring.point_a) - end_of(bodies, spring.b, spring.point_b)).norm();
    sum += 0.5 * spring.stiffness * (length - spring.rest_length) * (length - spring.rest_length);
  }
  return sum;
}

// J, from the poses a sample before and a sample after.
double kinetic(const Scene& scene, const Sample& before, const Sample& now, const Sample& after) {
  double sum = 0;
  const BodyColumns from = before.bodies.columns(), at = now.bodies.columns(), to = after.bodies.columns();
  const double time = after.time - before.time;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    const Vec3 v = (to.position(i) - from.position(i)) / time;
    const Eigen::AngleAxisd turn(to.orientation(i).normalized() * from.orientation(i).normalized().conjugate());
    const Vec3 w_B = matrix_of(at.orientation(i).normalized()).transpose() * (turn.angle() / time * turn.axis());
    sum += 0.5 * body.mass * v.squaredNorm() + 0.5 * w_B.dot(body.inertia * w_B);
  }
  return sum;
}

// The share of the largest kinetic energy by which the energy moves between the first and the last tenth.
double drift_of(const Judged& of) {
  const auto& samples = of.run.trajectory.samples;
  std::vector<double> energies;
  double largest = 0;
  for (std::size_t n = 1; n + 1 < samples.size(); ++n) {
    const double moving = kinetic(of.scene, samples[n - 1], samples[n], samples[n + 1]);
    largest = std::max(largest, moving);
    energies.push_back(moving + potential(of.scene, samples[n].bodies.columns()));
  }
  const auto tenth = static_cast<long>(energies.size() / 10);
  const auto mean = [&](auto from) { return std::accumulate(from, from + tenth, 0.0) / static_cast<double>(tenth); };
  return (mean(energies.end() - tenth) - mean(energies.begin())) / largest;
}

// The largest change of a velocity between two samples beside `time`, less what gravity does.
double jump_at(const Judged& of, double time) {
  double most = 0;
  const auto& samples = of.run.trajectory.samples;
  const double dt = samples[1].time;
  for (std::size_t n = 1; n < samples.size(); ++n) {
    if (std::abs(samples[n].time - time) > 3 * dt) continue;
    for (std::size_t i = 0; i < of.scene.bodies.size(); ++i) {
      if (of.scene.bodies[i].fixed) continue;
      const Vec3 change = samples[n].bodies.columns().velocity(i) - samples[n - 1].bodies.columns().velocity(i);
      most = std::max(most, (change - dt * of.scene.gravity).norm());
    }
  }
  return most;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_metrics_independent_verdicts)

// Scenes that keep their energy. The bound of the verdict is 1 %. Central differences err by (w h)²/6 of the kinetic
// energy, some tenths of a per cent at these steps, so that runs between a half and twice the bound are not asked.
// Only methods whose positions follow from the velocities that they declare are asked: explicit and linearly implicit
// Euler store velocities half a step from their positions and declare none.
BOOST_AUTO_TEST_CASE(drifting_is_what_the_positions_alone_show_to_drift) {
  int drifting = 0, steady = 0;
  for (const char* id : {"ballistic/projectile", "contact/toppling-box", "joints/pendulum-90", "mechanisms/cradle",
                         "springs/oscillator", "springs/two-bodies", "tops/axisymmetric-body"}) {
    for (const char* name : {"core:semi-implicit-euler", "core:rk4", "bullet", "dart", "mujoco", "ode"}) {
      const RunName run_name = parse_run_name(name, infos_of(engines()));
      const Case definition = select_cases({id}, default_suite_dir(), test::words()).at(0);
      for (const double dt : {1.0 / 60, 1.0 / 240}) {
        const std::string why =
            why_unsupported(find_engine(engines(), run_name.engine).info(), run_name.settings, definition.scene, dt);
        if (!why.empty()) continue;
        const Judged of = judged(id, name, dt);
        const double drift = drift_of(of);
        BOOST_TEST_CONTEXT(id << ", " << name << " at " << dt << " s drifts by " << 100 * drift << " %, and is "
                              << phrase_of(of.verdict) << ": " << of.verdict.why) {
          const bool says_so =
              of.verdict.why.find("the energy moved by") != std::string::npos && of.verdict.verdict != Verdict::stable;
          if (std::abs(drift) < 0.005) {
            BOOST_TEST((of.verdict.verdict != Verdict::drifting));
            ++steady;
          }
          if (std::abs(drift) > 0.02) {
            BOOST_TEST(says_so);
            ++drifting;
          }
        }
      }
    }
  }
  BOOST_TEST(steady > 20);  // of both kinds there are some, or nothing was asked
  BOOST_TEST(drifting > 5);
}

BOOST_AUTO_TEST_CASE(tunnelled_is_what_ends_behind_the_wall) {
  int behind = 0;
  for (const char* name : {"bullet", "bullet@stock", "dart", "mujoco", "ode", "core:velocity-verlet,contact=event",
                           "core:velocity-verlet,contact=impulse"}) {
    for (const double dt : {1.0 / 30, 1.0 / 240, 1.0 / 1000}) {
      const Judged of = judged("contact/thin-wall", name, dt);
      const double end = of.run.trajectory.samples.back().bodies.columns().position(0).x();
      behind += end > 1;
      BOOST_TEST_CONTEXT(name << " at " << dt << " s ends at " << end << " m: " << of.verdict.why)
      BOOST_TEST((of.verdict.verdict == Verdict::tunnelled) == (end > 1));
    }
  }
  BOOST_TEST(behind > 3);
}

BOOST_AUTO_TEST_CASE(an_impact_changes_a_velocity) {
  int found = 0;
  for (const char* id : {"contact/galton", "contact/collision", "contact/bounce-half", "contact/pair-impact-0.5"}) {
    for (const char* name : {"core:velocity-verlet", "core:dormand-prince", "ode", "bullet", "mujoco"}) {
      const RunName run_name = parse_run_name(name, infos_of(engines()));
      const Case definition = select_cases({id}, default_suite_dir(), test::words()).at(0);
      for (const double dt : {1.0 / 60, 1.0 / 240}) {
        const EngineInfo& info = find_engine(engines(), run_name.engine).info();
        if (!why_unsupported(info, run_name.settings, definition.scene, dt).empty()) continue;
        const Judged of = judged(id, name, dt);
        if (!of.restitution.measurement) continue;
        ++found;
        const Instant& worst = of.restitution.measurement->worst;
        BOOST_TEST_CONTEXT(id << ", " << name << " at " << dt << " s: restitution " << worst.found << " at "
                              << worst.time)
        BOOST_TEST(jump_at(of, worst.time) > 0.05);  // m/s; each of these impacts is ten times as fast
      }
    }
  }
  BOOST_TEST(found > 10);
}

BOOST_AUTO_TEST_SUITE_END()
