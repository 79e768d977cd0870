// rigor diagnose: each mistake of the table, put into an engine, is named first; what is not in the table is not named;
// two at once are both named. The short form takes a few of each; RIGOR_DIAGNOSE=all takes all, and prints the score;
// RIGOR_DIAGNOSE=PART those whose names have this part in them; RIGOR_DIAGNOSE_FROM=N goes on with the table's N-th,
// from 0. RIGOR_DIAGNOSE_SEED draws other pairs: those of 1 were looked at while the thresholds were chosen, those of
// any other number had no part in it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <random>

#include "adapters/faults/broken_engine.h"
#include "adapters/faults/changes.h"
#include "adapters/faults/faults.h"
#include "adapters/plugin/plugins.h"
#include "cases/analysis/mistakes/finder.h"
#include "cases/analysis/mistakes/motions.h"
#include "cases/analysis/mistakes/probes.h"
#include "generated/tests/places.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_mistakes)
using Verdict = MistakeReport::Verdict;

namespace {

constexpr double kConfident = 0.99;

std::string wanted() {
  const char* said = std::getenv("RIGOR_DIAGNOSE");
  return said ? said : "";
}

bool is_in(const std::string& name, const MistakeReport& report, std::size_t first) {
  for (std::size_t n = 0; n < std::min(first, report.suspects.size()); ++n) {
    const auto& names = report.suspects[n].names;
    if (std::find(names.begin(), names.end(), name) != names.end()) return true;
  }
  return false;
}

// Among those that the verdict means.
bool is_named(const std::string& name, const MistakeReport& report) {
  return (report.verdict == Verdict::named || report.verdict == Verdict::alike) && is_in(name, report, report.leaders);
}

std::string first_line(const MistakeReport& report) {
  static const char* const words[] = {"right", "named", "alike", "none", "untried"};
  std::string text = words[static_cast<int>(report.verdict)];
  for (const auto& suspect : report.suspects) {
    text += "; ";
    for (const std::string& name : suspect.names) text += "[" + name + "] ";
    text += std::to_string(suspect.explains);
  }
  return text;
}

// The residual of the first suspect, case by case.
std::string what_is_left(const MistakeReport& report) {
  std::string text;
  if (report.suspects.empty()) return text;
  for (const CaseShare& share : report.suspects.front().cases) {
    if (share.rest > 0.01) text += fmt::format("; {}: {:.2g} of {:.2g}", share.id, share.rest, share.error);
  }
  return text;
}

// Finders, which keep what does not hang on the engine, for each engine.
class Finders {
 public:
  Finders() : engines_(built_in_engines()) {
    add_plugin(engines_, "python3 " RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py", 20);
  }
  MistakeReport of(const std::string& run, const Fault& fault, const std::vector<std::string>& ids = {}) {
    const RunName name = parse_run_name(run, engines_.infos());
    auto [place, is_new] = finders_.try_emplace(fmt::format("{} on {}", run, fmt::join(ids, " ")));
    if (is_new) {
      std::vector<ProbeScene> probes = ids.empty() ? probes_of_suite(test::words())
                                                   : probes_of(select_cases(ids, default_suite_dir(), test::words()));
      place->second = std::make_unique<MistakeFinder>(engines_, name, std::move(probes), MistakeFinder::Options{2, 10});
    }
    return place->second->report(BrokenEngine(engines_.find(name.engine), fault));
  }
  // Whether a fault changes any of the engine's motions, even by one bit. Only scenes that the engine supports count.
  bool is_moved_by(const std::string& run, const Fault& fault) const {
    const RunName name = parse_run_name(run, engines_.infos());
    std::vector<MotionTask> tasks;
    for (const ProbeScene& probe : probes_of_suite(test::words())) {
      if (fault.step && !probe.scene->joints.empty()) continue;  // BrokenEngine refuses these
      if (!why_unsupported(engines_.info_of(name.engine), name.settings, *probe.scene, probe.dt).empty()) continue;
      for (const auto& put : {std::shared_ptr<const Fault>(), std::make_shared<const Fault>(fault)})
        tasks.push_back({&engines_.find(name.engine), name.settings, probe.scene, put, probe.dt,
                         std::lround(probe.duration / probe.dt), 1});
    }
    const std::vector<StateSeries> motions = simulate_motions(tasks, engines_, 2, 10);
    for (std::size_t n = 0; n < motions.size(); n += 2) {
      if (motions[n].states != motions[n + 1].states || motions[n].why != motions[n + 1].why) return true;
    }
    return false;
  }

 private:
  EngineTable engines_;
  std::map<std::string, std::unique_ptr<MistakeFinder>> finders_;
};

Finders& finders() {
  static Finders all;
  return all;
}

struct Score {
  int right = 0, asked = 0, unseen = 0, wrong_and_sure = 0, halves = 0;  // of a pair the one, and not the other
  double share() const { return asked ? double(right) / asked : 1; }
  void say(const std::string& what) const {
    BOOST_TEST_MESSAGE(what << ": " << right << " of " << asked << "; without effect " << unseen << "; wrong and sure "
                            << wrong_and_sure << "; one of two " << halves);
  }
};

// Nothing is named, or one of these.
bool names_none_but(const std::vector<std::string>& names, const MistakeReport& report) {
  const bool is_one = report.verdict == Verdict::named || report.verdict == Verdict::alike;
  return !is_one || std::any_of(names.begin(), names.end(), [&](const auto& name) { return is_named(name, report); });
}

// A mistake without effect on any scene that the engine takes is not asked for.
void take(const std::string& engine, const Fault& fault, const std::vector<std::string>& names, Score& score) {
  const MistakeReport report = finders().of(engine, fault);
  // An engine whose contacts are its own is off with and without it.
  const bool is_off_by_itself = report.verdict == Verdict::unnamed && !finders().is_moved_by(engine, fault);
  if (report.verdict == Verdict::right || is_off_by_itself) {
    ++score.unseen;
    BOOST_TEST_MESSAGE(engine << ", " << fault.name << ": without effect");
    return;
  }
  ++score.asked;
  const bool all_named = std::all_of(names.begin(), names.end(), [&](const auto& n) { return is_named(n, report); });
  const bool is_any = std::any_of(names.begin(), names.end(), [&](const auto& n) { return is_named(n, report); });
  score.right += all_named, score.halves += is_any && !all_named;
  const bool is_sure = report.verdict == Verdict::named && report.suspects.front().explains > kConfident;
  score.wrong_and_sure += is_sure && !names_none_but(names, report);
  if (!all_named || !wanted().empty())
    BOOST_TEST_MESSAGE(engine << ", " << fault.name << ": " << first_line(report)
                              << (all_named ? "" : what_is_left(report)));
}

// Not in the table, nor one of its rows by another amount.
std::vector<Fault> unknown_faults() {
  using namespace faulty;
  const auto moving = [](const char* name, auto change) { return on_stepping(name, each_moving(change)); };
  return {
      moving("drag by the square of the speed",
             [](Body& b, double dt) { b.velocity *= 1 - 0.01 * dt * b.velocity.norm(); }),
      moving("wind along x", [](Body& b, double dt) { b.velocity.x() += 0.02 * dt; }),
      moving("spin decays about the body's z alone",
             [](Body& b, double dt) {
               Vec3 w = b.orientation.conjugate() * b.angular_velocity;
               w.z() *= 1 - 0.05 * dt;
               b.angular_velocity = b.orientation * w;
             }),
      moving("Coriolis force", [](Body& b, double dt) { b.velocity += dt * Vec3(0, 0, 0.05).cross(b.velocity); }),
      moving("torque-free drift of the spin",
             [](Body& b, double dt) { b.angular_velocity += dt * Vec3(0.03, 0.01, 0); }),
      on_loading("mass added to light bodies", each_body([](Body& b) { b.mass += 0.05; })),
      on_loading("inertia of a point added", each_body([](Body& b) { b.inertia += 0.02 * Mat3::Identity(); })),
      on_loading("springs softer when long", each_spring([](Spring& s) { s.stiffness /= 1 + s.rest_length; })),
      on_loading("gravity tilted", [](Scene& s) { s.gravity = rotation_by(Vec3(0.02, 0.03, 0)) * s.gravity; }),
      on_loading("velocity reversed", each_body([](Body& b) { b.velocity *= -1; })),
      on_loading("positions shifted", each_body([](Body& b) { b.position += Vec3(0.01, 0.02, 0); })),
      on_loading("velocity along x lost", each_body([](Body& b) { b.velocity.x() = 0; })),
      on_loading("restitution and friction swapped",
                 [](Scene& s) {
                   for (ContactPair& pair : s.contact_pairs) {
                     const double friction = std::min(1.0, pair.law.friction);
                     pair.law.friction = pair.law.restitution, pair.law.restitution = friction;
                   }
                 }),
      on_loading("shapes 3 % larger", each_body([](Body& b) {
                   if (!b.shape) return;
                   if (auto* sphere = std::get_if<Sphere>(&*b.shape)) sphere->radius *= 1.03;
                   if (auto* box = std::get_if<Box>(&*b.shape)) box->size *= 1.03;
                 })),
      on_stepping("every second step half as long", [](Moment& m) { m.dt *= m.step % 2 ? 1 : 0.5; }),
      on_stepping("gravity that fades", [](Moment& m) { m.scene.gravity *= std::exp(-0.1 * m.time); }),
      on_stepping("gravity switched on late",
                  [](Moment& m) {
                    if (m.time < 0.1) m.scene.gravity.setZero();
                  }),
      on_reading("angular velocity and velocity swapped",
                 [](BodyState& s) { std::swap(s.velocity, s.angular_velocity); }),
      on_reading("velocity read in the body frame",
                 [](BodyState& s) { s.velocity = s.orientation.conjugate() * s.velocity; }),
      on_reading("y and z swapped on reading", [](BodyState& s) { std::swap(s.position.y(), s.position.z()); }),
      on_reading("angular velocity read in degrees", [](BodyState& s) { s.angular_velocity *= 57.29577951308232; }),
      on_reading("positions read in centimetres", [](BodyState& s) { s.position *= 100; }),
  };
}

std::size_t first_asked() {
  const char* from = std::getenv("RIGOR_DIAGNOSE_FROM");
  return from ? std::strtoul(from, nullptr, 10) : 0;
}

bool is_taken(const std::string& name, std::size_t index, std::size_t each) {
  if (wanted().empty()) return index % each == 0;
  return wanted() == "all" || name.find(wanted()) != std::string::npos;
}

// For the machine's own engines, and a toy from outside, whose scheme no twin repeats.
std::vector<std::string> engines_asked() {
  std::vector<std::string> names = {"ode"};
  if (const char* only = std::getenv("RIGOR_DIAGNOSE_ENGINE")) return {only};
  if (wanted().empty()) return names;
  names.insert(names.end(), {"bullet", "toy-py"});
  for (const EngineInfo& info : engines().infos()) {
    if (info.name == "mujoco") names.push_back(info.name);
  }
  return names;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_engine_without_a_mistake_has_none_named) {
  for (const std::string& engine : engines_asked()) {
    const MistakeReport report = finders().of(engine, Fault{"nothing"});
    BOOST_TEST_MESSAGE(engine << ": " << first_line(report));
    // MuJoCo's contacts are soft: it is off there, as no mistake of the table is.
    const bool is_none = report.verdict == Verdict::right || (engine == "mujoco" && report.verdict == Verdict::unnamed);
    BOOST_TEST(is_none, engine << ": " << first_line(report));
  }
}

BOOST_AUTO_TEST_CASE(a_mistake_of_the_table_is_named_first) {
  constexpr std::size_t kEach = 12;
  for (const std::string& engine : engines_asked()) {
    Score score;
    for (std::size_t n = 0; n < faults().size(); ++n) {
      const Fault& fault = faults()[n];
      if (n < first_asked()) continue;
      if (is_taken(fault.name, n, kEach)) take(engine, fault, {fault.name}, score);
    }
    score.say(engine + ", named first");
    BOOST_TEST(score.share() >= 0.95, engine);
    BOOST_TEST(score.wrong_and_sure == 0);
  }
}

BOOST_AUTO_TEST_CASE(one_that_is_not_in_the_table_is_not_named) {
  constexpr std::size_t kEach = 8;
  for (const std::string& engine : engines_asked()) {
    Score score;
    const std::vector<Fault> all = unknown_faults();
    for (std::size_t n = 0; n < all.size(); ++n) {
      if (!is_taken(all[n].name, n, kEach)) continue;
      const MistakeReport report = finders().of(engine, all[n]);
      if (report.verdict == Verdict::right) {
        ++score.unseen;
        BOOST_TEST_MESSAGE(engine << ", " << all[n].name << ": without effect");
        continue;
      }
      ++score.asked, score.right += report.verdict == Verdict::unnamed;
      if (report.verdict != Verdict::unnamed)
        BOOST_TEST_MESSAGE(engine << ", " << all[n].name << ": " << first_line(report));
    }
    score.say(engine + ", not in the table and not named");
    BOOST_TEST(score.share() >= 0.95, engine);
  }
}

BOOST_AUTO_TEST_CASE(the_amount_of_a_mistake_is_found) {
  for (const Fault& fault : faults()) {
    if (fault.name != "gravity off by 0.1 %") continue;
    for (const char* engine : {"ode", "toy-py"}) {
      for (const double percent : {0.5, -1.0}) {
        const MistakeReport report = finders().of(engine, fault.by(percent));
        BOOST_TEST(is_named(fmt::format("gravity off by {} %", percent), report), engine << ": " << first_line(report));
      }
    }
  }
}

// A mistake a hundred times as large as the table's moves bodies along another path than the table's does.
BOOST_AUTO_TEST_CASE(damping_applied_twice_is_named_whatever_the_cases) {
  for (const Fault& fault : faults()) {
    if (fault.name != "damping off by 1 %") continue;
    const Fault twice = fault.by(100);
    for (const char* engine : {"ode", "toy-py"}) {
      for (const std::vector<std::string>& ids : std::vector<std::vector<std::string>>{
               {"springs/hung-part"}, {"springs/hung-part", "springs/strong-damping"}, {}}) {
        const MistakeReport report = finders().of(engine, twice, ids);
        BOOST_TEST(is_named("damping off by 100 %", report), engine << " on " << fmt::format("{}", fmt::join(ids, " "))
                                                                    << ": " << first_line(report)
                                                                    << what_is_left(report));
      }
    }
  }
}

// Where a body hardly slides, a little less friction is as much more speed as seven times the gravity.
BOOST_AUTO_TEST_CASE(no_amount_beyond_a_thousand_times_that_of_the_table_is_named) {
  const Fault less_friction = faulty::on_loading("friction off by -10 %", [](Scene& scene) {
    scene.contact_default.friction *= 0.9;
    for (ContactPair& pair : scene.contact_pairs) pair.law.friction *= 0.9;
  });
  const MistakeReport report = finders().of("ode", less_friction, {"contact/slope-slides"});
  BOOST_TEST((report.verdict == Verdict::unnamed), first_line(report));
}

// Of an engine that gets its loads from Rigor, what it tells wrongly counts as loaded alone: beside another mistake
// such a one explains the few observations that the two are seen in as well as the other does by itself.
BOOST_AUTO_TEST_CASE(a_mistake_alone_is_not_led_by_itself_with_another) {
  for (const Fault& fault : faults()) {
    if (fault.name != "quaternion order swapped on loading") continue;
    const MistakeReport report = finders().of("toy-py", fault);
    BOOST_TEST_REQUIRE(is_named(fault.name, report), first_line(report));
    BOOST_TEST(report.suspects.front().names.size() == 1, first_line(report));
  }
}

// If one of a pair is named, the answer is neither right nor wrong. Four pairs are too few to measure a share of 0.7.
// The short form fails at a number that a share of 0.7 would give less than once in twenty times. The full form
// requires the share itself.
BOOST_AUTO_TEST_CASE(two_mistakes_at_once_are_both_named) {
  const char* seed = std::getenv("RIGOR_DIAGNOSE_SEED");
  std::mt19937 random(seed ? static_cast<unsigned>(std::atoi(seed)) : 1);
  const int tried = wanted() == "all" ? 40 : wanted().empty() ? 4 : 0;
  for (const std::string& engine : engines_asked()) {
    Score score;
    while (score.asked < tried) {
      const Fault &first = faults()[random() % faults().size()], &second = faults()[random() % faults().size()];
      if (first.name == second.name) continue;
      // Both have an effect by themselves.
      if (!finders().is_moved_by(engine, first) || !finders().is_moved_by(engine, second)) continue;
      take(engine, combined(first, second), {first.name, second.name}, score);
    }
    score.say(engine + ", both named");
    constexpr double kShare = 0.7;
    const boost::math::binomial_distribution<double> expected(score.asked, kShare);
    if (wanted() == "all") BOOST_TEST(score.share() >= kShare, engine);
    if (wanted().empty()) BOOST_TEST(boost::math::cdf(expected, score.right) >= 0.05, engine);
    BOOST_TEST(score.wrong_and_sure == 0, engine);
  }
}

BOOST_AUTO_TEST_SUITE_END()
