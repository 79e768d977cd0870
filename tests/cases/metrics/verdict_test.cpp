// Verdicts on motions made by hand, whose every fault is known, and on the engines' own where they are known to fail.
#include "cases/metrics/verdict.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/case/suite.h"
#include "core/base/error.h"
#include "tests/cases/scripted_engine.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_verdict)

namespace {

constexpr double kDt = 1.0 / 30;

using Motion = std::function<void(double t, MutableBodyColumns bodies)>;

// Bodies stand where the scene puts them, unless the motion says otherwise.
Trajectory run_of(const Scene& scene, int steps, const Motion& motion) {
  test::Script script;
  script.play = [&](int step, MutableBodyColumns bodies) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      bodies.set_body(i, {body.position, body.orientation, body.velocity, body.angular_velocity});
    }
    motion(step * kDt, bodies);
  };
  return simulate(test::ScriptedEngine(script), {}, scene, kDt, steps * kDt).trajectory;
}

// A box of 0.2 x 0.2 x 1 m and 2 kg that stands on the ground; gravity is 10 m/s².
Scene standing_box() {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("box", Box{{0.2, 0.2, 1}}, 2, {0, 0, 0.5}), test::plane()};
  scene.contact_default = {0, 0.5};
  return scene;
}

Stability verdict_of_height(const Scene& scene, const std::function<double(double t)>& height) {
  const Trajectory run = run_of(scene, 300, [&](double t, MutableBodyColumns bodies) {
    bodies.set_position(0, {0, 0, height(t)});
  });
  return verdict_on({scene, run, nullptr, 0});
}

// One body that coasts at a speed of its own choice, 1 J at 1 m/s.
Stability verdict_of_speed(const std::function<double(double t)>& speed) {
  Scene scene;
  scene.bodies = {test::body("bead", 2, {1, 1, 1})};
  scene.bodies[0].velocity = {1, 0, 0};
  const Trajectory run = run_of(scene, 300, [&](double t, MutableBodyColumns bodies) {
    bodies.set_velocity(0, {speed(t), 0, 0});
  });
  return verdict_on({scene, run, nullptr, 0});
}

// A box thrown on the ground, at rest or not.
Scene thrown_box(const Vec3& size, const Vec3& velocity, const Vec3& angular_velocity, double height, ContactLaw law) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {test::on_its_own("box", Box{size}, 1, {0, 0, height}), test::plane()};
  scene.bodies[0].velocity = velocity, scene.bodies[0].angular_velocity = angular_velocity;
  scene.contact_default = law;
  return scene;
}

// At 1/30 s. `stands`: its truth is that nothing moves.
Stability verdict_of_engine(const std::string& name, const Scene& scene, double duration, bool stands) {
  const RunName name_of_run = parse_run_name(name, infos_of(engines()));
  const Engine& engine = find_engine(engines(), name_of_run.engine);
  const Simulation run = simulate(engine, name_of_run.settings, scene, kDt, duration);
  TruthSamples rest;
  rest.bodies.assign(run.trajectory.samples.size(), run.trajectory.samples.front().bodies);
  rest.error.assign(rest.bodies.size(), 0);
  rest.largest_kinetic_energy = 0;
  return verdict_on({scene, run.trajectory, stands ? &rest : nullptr,
                     method_of(engine.info(), name_of_run.settings).leapfrog_stagger});
}

}  // namespace

// Each of these was called stable while its own motion was what a gain was measured by.
BOOST_AUTO_TEST_CASE(what_engines_do_to_contact_at_a_thirtieth_is_told) {
  const auto suite_scene = [](const char* id) {
    return select_cases({id}, default_suite_dir(), test::words()).at(0).scene;
  };
  const Scene dominoes = suite_scene("contact/dominoes"), logs = suite_scene("contact/log-pile"),
              stack = suite_scene("contact/stack-of-ten"),
              tall = thrown_box({0.2, 0.2, 2}, {0.6, 0, 0.06}, {0, 0.6, 0}, 1, {0, 0.5}),
              bouncing = thrown_box({0.3, 0.4, 0.5}, {1, 0, 0}, {1, 2, 0.5}, 1.5, {0.6, 0.4});
  struct Row {
    const char* what;
    const Scene& scene;
    bool stands;
    const char *engine, *word;
  };
  const char* impulse = "core:velocity-verlet,contact=impulse";
  for (const Row& row : {Row{"dominoes", dominoes, false, "bullet@stock", "gaining"},
                         {"dominoes", dominoes, false, "bullet", "gaining"},
                         {"dominoes", dominoes, false, "ode", "gaining"},
                         {"dominoes", dominoes, false, impulse, "stable"},
                         {"tall box", tall, false, "ode", "gaining"},
                         {"tall box", tall, false, impulse, "stable"},
                         {"bouncing box", bouncing, false, "bullet", "gaining"},
                         {"bouncing box", bouncing, false, impulse, "stable"},
                         {"log pile", logs, true, "bullet", "collapsed"},
                         {"log pile", logs, true, impulse, "stable"},
                         {"stack of ten", stack, true, "bullet", "collapsed"},
                         {"stack of ten", stack, true, impulse, "stable"}}) {
    const Stability verdict = verdict_of_engine(row.engine, row.scene, 5, row.stands);
    BOOST_TEST_CONTEXT(row.what << ", " << row.engine << ": " << verdict.why)
    BOOST_TEST(word_of(verdict.verdict) == row.word);
  }
}

BOOST_AUTO_TEST_CASE(a_drift_beyond_one_per_cent_is_told_and_half_of_that_is_not) {
  // The energy is the square of the speed, and moves by 0.9 of the whole between the means of the outer tenths.
  const auto growing_by = [](double share) {
    return verdict_of_speed([=](double t) { return std::sqrt(1 + share / 0.9 * t / 10); });
  };
  BOOST_TEST(word_of(growing_by(0.005).verdict) == "stable");
  BOOST_TEST(word_of(growing_by(0.0099).verdict) == "stable");
  for (const double share : {0.0101, 0.015, -0.015}) {
    const Stability verdict = growing_by(share);
    BOOST_TEST(word_of(verdict.verdict) == "drifting");
    // 301 samples: the means of the outer 30 are 271 of the 300 steps apart.
    BOOST_TEST(verdict.amount == share / 0.9 * 271 / 300, boost::test_tools::tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(what_is_driven_without_a_truth_is_not_known_to_drift) {
  Scene scene;
  scene.bodies = {test::body("bead", 2, {1, 1, 1})};
  scene.forces = {{.body = 0, .force = {1, 0, 0}}};
  const Trajectory run = run_of(scene, 10, [](double t, MutableBodyColumns bodies) {
    bodies.set_velocity(0, {t, 0, 0});
  });
  const Stability verdict = verdict_on({scene, run, nullptr, 0});
  BOOST_TEST(word_of(verdict.verdict) == "stable");
  BOOST_TEST(verdict.why.find("whether it drifts is not known: forces or motors") != std::string::npos, verdict.why);
}

BOOST_AUTO_TEST_CASE(a_bounded_oscillation_of_a_kept_energy_is_neither_drift_nor_gain) {
  // The change is 40 % of it, three times in each tenth of the run.
  const double omega = 2 * 3 * std::acos(-1);  // rad/s
  const auto speed = [=](double t) { return 1 + 0.2 * std::sin(omega * t); };
  BOOST_TEST(word_of(verdict_of_speed(speed).verdict) == "stable");
}

BOOST_AUTO_TEST_CASE(velocities_half_a_step_behind_are_brought_forward_before_the_energy_is_judged) {
  // Thrown up at 5 m/s and back at its start after 1 s, without loss. Half a step early, the speed is g dt/2 too high
  // on the way up and too low on the way down: m v g dt/2, 3 J between the outer tenths, of 225 J in play in a fall of
  // 1 s.
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::body("ball", 2, {1, 1, 1})};
  scene.bodies[0].velocity = {0, 0, 5};
  const Trajectory run = run_of(scene, 30, [](double t, MutableBodyColumns bodies) {
    bodies.set_position(0, {0, 0, 5 * t - 5 * t * t});
    bodies.set_velocity(0, {0, 0, 5 - 10 * (t - kDt / 2)});
  });
  BOOST_TEST(word_of(verdict_on({scene, run, nullptr, 0.5}).verdict) == "stable");
  BOOST_TEST(word_of(verdict_on({scene, run, nullptr, 0}).verdict) == "drifting");
}

BOOST_AUTO_TEST_CASE(what_loses_energy_and_regains_half_of_it_is_gaining) {
  // The energy in play is from 0.5 m to lying flat at 0.1 m: 2 kg · 10 m/s² · 0.4 m = 8 J. It falls by 0.3 m, is lifted
  // by 0.16 m = 3.2 J, and falls again. Neither the first and last tenth nor the start show it.
  const auto lifted = [](double t) { return t < 2 ? 0.5 : t < 4 ? 0.2 : t < 6 ? 0.36 : 0.2; };
  const Stability verdict = verdict_of_height(standing_box(), lifted);
  BOOST_TEST(word_of(verdict.verdict) == "gaining");
  BOOST_TEST(verdict.amount == 0.4, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(verdict.time == 4, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(phrase_of(verdict) == "gaining 40 %");
  // A body that falls and stays down has gained nothing.
  BOOST_TEST(word_of(verdict_of_height(standing_box(), [](double t) { return t < 2 ? 0.5 : 0.45; }).verdict) ==
             "stable");
}

BOOST_AUTO_TEST_CASE(a_run_that_flies_apart_does_not_excuse_itself_by_what_it_gained) {
  // Ten times the height there is to fall: measured by its own motion that would be all of it and no more.
  const Stability verdict = verdict_of_height(standing_box(), [](double t) { return 0.5 + 0.4 * t; });
  BOOST_TEST(word_of(verdict.verdict) == "gaining");
  BOOST_TEST(verdict.amount == 10, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(phrase_of(verdict) == "gaining 1000 %");
}

// A ball of 2 kg dropped from 5 m that leaves the ground at `speed`: 100 J in play. Its velocity is read `behind` steps
// behind its position, and the engine says that it is half a step.
Stability verdict_of_bounce(double speed, double behind) {
  Scene scene;
  scene.gravity = {0, 0, -10};
  scene.bodies = {test::on_its_own("ball", Sphere{0.5}, 2, {0, 0, 5.5}), test::plane()};
  scene.contact_default = {0.9, 0.5};
  const Trajectory run = run_of(scene, 54, [&](double t, MutableBodyColumns bodies) {
    const double since = t - 1;
    const bool falls = since < 1e-9;
    bodies.set_position(0, {0, 0, falls ? 5.5 - 5 * t * t : 0.5 + speed * since - 5 * since * since});
    bodies.set_velocity(0, {0, 0, (falls ? -10 * t : speed - 10 * since) + 10 * behind * kDt});
  });
  return verdict_on({scene, run, nullptr, 0.5});
}

BOOST_AUTO_TEST_CASE(a_bounce_that_keeps_its_energy_is_no_gain_at_whichever_instant_its_velocity_belongs) {
  // Read half a step early, m v g dt = 6.7 J seem gained at the bounce; brought forward where it need not be, half of
  // that from there to the top.
  BOOST_TEST(word_of(verdict_of_bounce(10, 0.5).verdict) == "stable");
  BOOST_TEST(word_of(verdict_of_bounce(10, 0).verdict) == "stable");
  for (const double behind : {0.5, 0.0}) {
    const Stability verdict = verdict_of_bounce(11, behind);  // 21 J more
    BOOST_TEST(word_of(verdict.verdict) == "gaining");
    // Either reading is off by up to 2 · 11 m/s · 10 m/s² · dt/2 = 3.7 J while it flies, and neither says too much.
    BOOST_TEST((verdict.amount > 0.17 && verdict.amount < 0.21 + 1e-9), verdict.amount);
  }
}

BOOST_AUTO_TEST_CASE(an_overlap_of_more_than_a_bodys_thickness_names_both_bodies_its_depth_and_its_time) {
  const auto sunk = [](double depth) {
    return verdict_of_height(standing_box(), [=](double t) { return t < 1 || t > 1.5 ? 0.5 : 0.5 - depth; });
  };
  BOOST_TEST(sunk(0.199).why.find("overlap") == std::string::npos);
  const Stability verdict = sunk(0.201);
  BOOST_TEST_CONTEXT(verdict.why) {
    BOOST_TEST(word_of(verdict.verdict) == "gaining");  // for it comes up again, which is worse
    BOOST_TEST(verdict.why.find("at 1 s 'box' and 'ground' overlap by 0.201 m") != std::string::npos);
  }
  const Stability stays = verdict_of_height(standing_box(), [](double t) { return t < 1 ? 0.5 : 0.2; });
  BOOST_TEST(word_of(stays.verdict) == "overlapping");
  BOOST_TEST(stays.body == 0);
  BOOST_TEST(stays.time == 1, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(phrase_of(stays) == "overlapping 0.3 m");
}

BOOST_AUTO_TEST_CASE(what_the_truth_says_stands_and_fell_has_collapsed) {
  const Scene scene = standing_box();
  const test::StatedTruth rest([](double) {
    return BodyState{{0, 0, 0.5}, Quat::Identity(), Vec3::Zero(), Vec3::Zero()};
  });
  const auto verdict = [&](const Truth* truth, double away) {
    const Trajectory run = run_of(scene, 60, [&](double t, MutableBodyColumns bodies) {
      if (t > 1) bodies.set_position(0, {away, 0, 0.5});
    });
    if (!truth) return verdict_on({scene, run, nullptr, 0});
    const TruthSamples samples = test::sampled(*truth, run, scene, 1);
    return verdict_on({scene, run, &samples, 0});
  };
  const double radius = 0.5 * std::sqrt(0.2 * 0.2 + 0.2 * 0.2 + 1);  // of the sphere round it
  BOOST_TEST(word_of(verdict(&rest, 0.49 * radius).verdict) == "stable");
  const Stability fell = verdict(&rest, 0.51 * radius);
  BOOST_TEST(word_of(fell.verdict) == "collapsed");
  BOOST_TEST(fell.body == 0);
  BOOST_TEST(phrase_of(fell) == "collapsed 1.03 s");
  // Nobody says that it had to stand; or not for so long.
  BOOST_TEST(word_of(verdict(nullptr, 1).verdict) == "stable");
  const test::StatedTruth for_a_while([&](double t) { return truth_at(rest, t, 1).columns().body(0); }, 0.9);
  BOOST_TEST(word_of(verdict(&for_a_while, 1).verdict) == "stable");
}

BOOST_AUTO_TEST_CASE(the_worst_verdict_is_the_word_and_all_are_in_the_sentence) {
  const Scene scene = standing_box();
  const Trajectory run = run_of(scene, 60, [&](double t, MutableBodyColumns bodies) {
    if (t > 1) bodies.set_position(0, {0, 0, t < 1.5 ? 0.2 : 0.9});
  });
  const Stability verdict = verdict_on({scene, run, nullptr, 0});
  BOOST_TEST(word_of(verdict.verdict) == "gaining");
  BOOST_TEST(verdict.why.find("overlap by 0.3 m") != std::string::npos, verdict.why);
}

BOOST_AUTO_TEST_CASE(a_word_is_read_back_as_the_verdict_it_is) {
  for (const Verdict verdict : {Verdict::stable, Verdict::drifting, Verdict::overlapping, Verdict::gaining,
                                Verdict::collapsed, Verdict::tunnelled, Verdict::blown_up})
    BOOST_TEST(word_of(verdict_of(word_of(verdict))) == word_of(verdict));
  BOOST_CHECK_THROW(verdict_of("fine"), InputError);
}

BOOST_AUTO_TEST_SUITE_END()
