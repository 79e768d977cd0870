// Verdicts and impacts of engines' runs on cases of the suite, beside rules that share no code with the judge
// (pose_oracle.h). RIGOR_VERDICTS=out judges every trajectory of a results folder at 1/30 and 1/240 s instead of a
// sample; RIGOR_VERDICTS_OF=contact/ only those of one family. Either prints each disagreement.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "cases/case/suite.h"
#include "cases/metrics/verdict.h"
#include "core/base/json.h"
#include "tests/cases/judged.h"
#include "tests/cases/metrics/pose_oracle.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_independent_verdicts)

namespace {

constexpr double kDrifts = 0.01, kGains = 0.005;         // shares of the energy, as verdict.h states them
constexpr double kMargin = 0.002, kGainMargin = 0.0025;  // of the oracle: the modified energies of the scheme differ

// A case and its truth, which several runs share.
struct Known {
  Case definition;
  std::unique_ptr<Truth> truth;
  EnergyExtremes extremes;

  explicit Known(const std::string& id) : definition(select_cases({id}, default_suite_dir(), test::words()).at(0)) {
    truth = make_truth(definition.truth, definition.scene, definition.duration);
    extremes = energy_extremes(definition.scene, truth.get(), definition.duration);
  }
};

struct Judged {
  const Known& known;
  Trajectory trajectory;
  std::optional<TruthSamples> truth;
  Stability verdict;
  double scale = 1;
  std::optional<Measurement> restitution, impact_time;

  Judged(const Known& of, Trajectory run, const std::string& name) : known(of), trajectory(std::move(run)) {
    const Scene& scene = known.definition.scene;
    if (known.truth) truth = test::sampled(*known.truth, trajectory, scene, known.extremes.kinetic);
    const RunName run_name = parse_run_name(name, infos_of(engines()));
    const EngineInfo info = find_engine(engines(), run_name.engine).info();
    JudgedRun judged{scene, trajectory, truth ? &*truth : nullptr, method_of(info, run_name.settings).leapfrog_stagger};
    judged.duration = known.definition.duration;
    verdict = judge_stability(judged, {}, known.extremes.kinetic, known.extremes.change);
    scale = known.truth && known.extremes.kinetic > 0 ? known.extremes.kinetic : 0;
    restitution = test::measured("restitution_error", judged).measurement;
    impact_time = test::measured("impact_time_error", judged).measurement;
  }
};

// The number that follows `words` in the verdict's sentence, in per cent, as a share.
std::optional<double> stated(const std::string& why, const std::string& words) {
  std::smatch found;
  const std::regex pattern(words + " (?:at least )?([-+0-9.e]+) %");
  if (!std::regex_search(why, found, pattern)) return {};
  return std::stod(found[1]) / 100;
}

// J, in play: as the verdict's sentence prints it where the truth has no motion.
std::optional<double> scale_stated(const std::string& why) {
  std::smatch found;
  if (!std::regex_search(why, found, std::regex("% of the ([-+0-9.e]+) J"))) return {};
  return std::stod(found[1]);
}

struct Tally {
  int asked = 0, drifting = 0, steady = 0, gaining = 0, passed = 0, fallen = 0, abstained = 0, impacts = 0;
};

class Comparison {
 public:
  Comparison(const Judged& run, Tally& tally)
      : run_(run),
        scene_(run.known.definition.scene),
        upkeep_(test::upkeep_of(scene_)),
        scale_(run.scale > 0 ? run.scale : scale_stated(run.verdict.why).value_or(1)),
        oracle_(scene_, run.trajectory, scale_),
        tally_(tally) {}

  std::vector<std::string> disagreements() {
    ++tally_.asked;
    if (run_.verdict.verdict == Verdict::blown_up) return {};
    compare_drift();
    compare_internal_drift();
    compare_gain();
    compare_places();
    compare_impacts();
    return found_;
  }

 private:
  // s: up to where the truth is good to a micrometre; the whole run without one.
  double horizon() const {
    double end = 0;
    if (!run_.truth) return run_.trajectory.samples.back().time;
    for (std::size_t n = 0; n < run_.truth->error.size() && run_.truth->error[n] <= 1e-6; ++n)
      end = run_.trajectory.samples[n].time;
    return end;
  }

  // J, of the exact motion at each sample.
  std::vector<double> exact_energies() const {
    std::vector<double> energies;
    for (std::size_t n = 0; run_.truth && n < run_.truth->bodies.size() && run_.truth->error[n] <= 1e-6; ++n)
      energies.push_back(test::exact_energy(scene_, run_.truth->bodies[n].columns()));
    return energies;
  }

  void decide(const std::string& what, const test::Share& share, const std::optional<double>& claimed) {
    const double size = std::abs(share.value), margin = 2 * share.error + kMargin;
    const bool surely = size - margin > kDrifts, surely_not = size + margin < kDrifts;
    if (!surely && !surely_not) {
      ++tally_.abstained;
      return;
    }
    ++(surely ? tally_.drifting : tally_.steady);
    const bool claims = claimed && std::abs(*claimed) > kDrifts;
    if (claims != surely)
      note(fmt::format("{} drifts by {:+.3g} % +- {:.2g} %, the verdict: {}", what, 100 * share.value,
                       100 * share.error, claimed ? fmt::format("{:+.3g} %", 100 * *claimed) : "nothing"));
  }

  void compare_drift() {
    const std::vector<double> exact = exact_energies();
    if (upkeep_.is_driven && exact.empty()) return;
    bool stays = !exact.empty();
    for (const double e : exact) stays = stays && std::abs(e - exact.front()) <= 1e-9 * scale_;
    const bool must_stay = !upkeep_.is_driven && (!upkeep_.may_lose || (upkeep_.can_jump && stays));
    const bool by_truth = !must_stay && !upkeep_.can_jump && !exact.empty();
    if (!must_stay && !by_truth) return;
    const double end = by_truth ? horizon() : run_.trajectory.samples.back().time;
    const auto share = oracle_.drift(end, by_truth ? exact : std::vector<double>());
    if (!share) return void(++tally_.abstained);
    decide("the energy", *share, stated(run_.verdict.why, "the energy moved by"));
  }

  // Where nothing outside holds the bodies and something moves them as a whole.
  void compare_internal_drift() {
    bool is_held = upkeep_.is_driven || upkeep_.may_lose;
    for (const Spring& spring : scene_.springs) is_held = is_held || spring.a == kWorld || spring.b == kWorld;
    for (const Joint& joint : scene_.joints) is_held = is_held || joint.a == kWorld || joint.b == kWorld;
    for (const Body& body : scene_.bodies) is_held = is_held || body.fixed;
    const auto claimed = stated(run_.verdict.why, "centre of mass moved by");
    if (is_held && claimed) note("an energy about the centre of mass although something holds the bodies");
    if (is_held || !claimed) return;
    if (const auto share = oracle_.internal_drift()) decide("the energy about the centre of mass", *share, claimed);
  }

  void compare_gain() {
    if (upkeep_.is_driven || !scene_.springs.empty() || !oracle_.can_tell()) return;
    const auto claimed = stated(run_.verdict.why, "risen by");
    if (!claimed && !upkeep_.can_touch) return;
    const bool claims = claimed && *claimed > kGains;
    const test::Share least = oracle_.rise_at_least(), most = oracle_.rise_at_most();
    const bool surely = least.value - least.error > kGains + kGainMargin;
    const bool surely_not = most.value < kGains - kGainMargin;
    if (surely) ++tally_.gaining;
    if ((surely && !claims) || (surely_not && claims))
      note(fmt::format("the energy rises by {:.3g} to {:.3g} %, the verdict: {}", 100 * (least.value - least.error),
                       100 * most.value, claimed ? fmt::format("{:.3g} %", 100 * *claimed) : "nothing"));
  }

  void compare_places() {
    const Verdict verdict = run_.verdict.verdict;
    constexpr double kThrough = 0.25, kPerhaps = 0.5;  // of the sum of two radii
    const auto through = oracle_.passage(kThrough), perhaps = oracle_.passage(kPerhaps);
    if (through) ++tally_.passed;
    if (through && verdict < Verdict::tunnelled)
      note(fmt::format("a body has passed through another by {:.3g} s", *through));
    if (!perhaps && verdict == Verdict::tunnelled && !has_moving_boxes())
      note("no centre has come through a box or a sphere");
    if (oracle_.overlap() > 1.05 && verdict < Verdict::overlapping)
      note(fmt::format("an overlap of {:.3g} of what is allowed", oracle_.overlap()));
    const bool must_stand = rests();
    const auto fall = oracle_.fall();
    if (must_stand && fall) ++tally_.fallen;
    if (must_stand && fall && *fall <= horizon() && verdict < Verdict::collapsed)
      note(fmt::format("what should stand has fallen by {:.3g} s", *fall));
    if (verdict == Verdict::collapsed && !(must_stand && fall)) note("nothing that should stand has fallen");
  }

  // Their edges may pass through each other, while no centre does.
  bool has_moving_boxes() const {
    return std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const Body& body) {
      return !body.fixed && body.shape && std::holds_alternative<Box>(*body.shape);
    });
  }

  // Whether the truth's bodies never move and only gravity acts.
  bool rests() const {
    if (!run_.truth || !scene_.springs.empty() || !scene_.joints.empty() || !scene_.forces.empty()) return false;
    for (const Body& body : scene_.bodies)
      if (!body.fixed && (!body.velocity.isZero(0) || !body.angular_velocity.isZero(0))) return false;
    constexpr double kMoves = 1e-9;  // m
    const BodyColumns start = run_.truth->bodies.front().columns();
    for (const KeptBodies& now : run_.truth->bodies) {
      for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
        if (!scene_.bodies[i].fixed && (now.columns().position(i) - start.position(i)).norm() > kMoves) return false;
    }
    return true;
  }

  // Each impact that a metric names changes a mean velocity, while the bodies come, touch and part.
  void compare_impacts() {
    const auto check = [&](const char* what, double from, double to) {
      if (run_.trajectory.samples.size() < 3) return;
      ++tally_.impacts;
      const double jump = oracle_.jump_between(std::min(from, to), std::max(from, to), 4);
      if (!(jump > 1e-3)) note(fmt::format("{}: an impact at {:.4g} s changes no velocity", what, to));
    };
    const double end = run_.trajectory.samples.back().time;
    const auto &speeds = run_.restitution, &times = run_.impact_time;
    if (times && times->worst.found < end) check("impact_time_error", times->worst.expected, times->worst.found);
    if (speeds && times && times->worst.found < end)
      check("restitution_error", std::min(speeds->worst.time, times->worst.expected), speeds->worst.time);
  }

  void note(const std::string& what) { found_.push_back(what); }

  const Judged& run_;
  const Scene& scene_;
  test::Upkeep upkeep_;
  double scale_;
  test::PoseOracle oracle_;
  Tally& tally_;
  std::vector<std::string> found_;
};

// A trajectory file of a results folder. Its columns are those of kColumnNames.
Trajectory read_trajectory(const std::string& path, double dt, const Scene& scene) {
  Trajectory run{dt, {}};
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::size_t bodies = scene.bodies.size();
  BodyTable table(bodies);
  double time = 0;
  for (std::size_t row = 0; std::getline(file, line); ++row) {
    const std::size_t i = row % bodies;
    const char* place = line.c_str();
    char* next = nullptr;
    time = std::strtod(place, &next);
    place = std::strchr(next + 1, ',') + 1;
    if (line[static_cast<std::size_t>(next - line.c_str()) + 1] == '"') place = std::strstr(next, "\",") + 2;
    for (int c = 0; c < 13; ++c) table.columns().column(c)[i] = std::strtod(place, &next), place = next + 1;
    if (i + 1 == bodies) run.samples.push_back({time, KeptBodies(std::as_const(table).columns())});
  }
  return run;
}

void report(const std::string& id, const std::string& run, const std::string& dt, const Judged& of, Tally& tally) {
  for (const std::string& what : Comparison(of, tally).disagreements())
    BOOST_ERROR(id << ", " << run << " at " << dt << " s is " << phrase_of(of.verdict) << ": " << what << " ("
                   << of.verdict.why << ")");
}

void print(const Tally& tally) {
  BOOST_TEST_MESSAGE(fmt::format(
      "{} runs: drifting {}, steady {}, gaining {}, passed {}, fallen {}, impacts {}; the oracle abstained from {}",
      tally.asked, tally.drifting, tally.steady, tally.gaining, tally.passed, tally.fallen, tally.impacts,
      tally.abstained));
}

// Every trajectory of a results folder.
void judge_folder(const std::string& folder, const std::string& family, Tally& tally) {
  std::stringstream text;
  text << std::ifstream(folder + "/results.json").rdbuf();
  const Json results = parse_json(text.str());
  std::map<std::string, std::vector<Json>> by_case;
  for (const Json& cell : results.at("cells")) {
    const std::string dt = cell.at("dt"), status = cell.at("status"), id = cell.at("case");
    if ((dt == "1/30" || dt == "1/240") && id.starts_with(family) && cell.contains("trajectory") &&
        cell.at("trajectory").is_string() && !cell.at("verdict").is_null() &&
        cell.at("verdict").at("word") != "blown up")
      by_case[id].push_back(cell);
  }
  for (const auto& [id, cells] : by_case) {
    const Known known(id);
    for (const Json& cell : cells) {
      const std::string path = folder + "/trajectories/" + cell.at("trajectory").get<std::string>();
      Trajectory run = read_trajectory(path, cell.at("dt_seconds"), known.definition.scene);
      if (run.samples.size() < 3) continue;
      const std::string name = cell.at("engine");
      const Judged of(known, std::move(run), name);
      const std::string before = cell.at("verdict").at("phrase"), now = phrase_of(of.verdict);
      if (before != now)
        BOOST_TEST_MESSAGE(id << ", " << name << " at " << cell.at("dt") << " s: recorded as " << before << ", now "
                              << now << " (" << of.verdict.why << ")");
      report(id, name, cell.at("dt"), of, tally);
    }
  }
}

}  // namespace

// One case of each kind of each family, and every kind of engine.
BOOST_AUTO_TEST_CASE(each_verdict_follows_from_the_poses_alone) {
  Tally tally;
  const char *folder = std::getenv("RIGOR_VERDICTS"), *family = std::getenv("RIGOR_VERDICTS_OF");
  if (folder) {
    unsetenv("RIGOR_CACHE_DIR");  // solving every truth anew takes longer than all else
    judge_folder(folder, family ? family : "", tally);
    return print(tally);
  }
  for (const char* id :
       {"ballistic/projectile", "contact/bounce-lively", "contact/collision", "contact/thin-wall",
        "contact/toppling-box", "contact/card-house", "forces/torqued-top", "joints/pendulum-90", "joints/heavy-top",
        "mechanisms/cradle", "mechanisms/four-bar", "springs/oscillator", "springs/two-bodies",
        "springs/oscillator-underdamped", "tops/axisymmetric-body", "tops/tumbling-brick"}) {
    const Known known(id);
    for (const char* name : {"core:semi-implicit-euler", "core:linearly-implicit-euler", "core:rk4", "bullet",
                             "bullet@stock", "dart", "mujoco", "ode", "simbody"}) {
      const RunName run_name = parse_run_name(name, infos_of(engines()));
      const Engine& engine = find_engine(engines(), run_name.engine);
      for (const double dt : {1.0 / 30, 1.0 / 240}) {
        const Case& definition = known.definition;
        if (!why_unsupported(engine.info(), run_name.settings, definition.scene, dt).empty()) continue;
        const Simulation run = simulate(engine, run_name.settings, definition.scene, dt, definition.duration);
        if (run.not_finite) continue;
        report(id, name, fmt::format("{:.4g}", dt), Judged(known, run.trajectory, name), tally);
      }
    }
  }
  print(tally);
  BOOST_TEST(tally.steady > 100);  // of each kind there are some, or nothing was asked
  BOOST_TEST(tally.drifting > 10);
  BOOST_TEST(tally.gaining > 3);
  BOOST_TEST(tally.passed > 3);
  BOOST_TEST(tally.fallen > 3);
  BOOST_TEST(tally.impacts > 10);
}

BOOST_AUTO_TEST_CASE(tunnelled_is_what_ends_behind_the_wall) {
  const Known known("contact/thin-wall");
  int behind = 0;
  for (const char* name : {"bullet", "bullet@stock", "dart", "mujoco", "ode", "core:velocity-verlet,contact=event",
                           "core:velocity-verlet,contact=impulse"}) {
    for (const double dt : {1.0 / 30, 1.0 / 240, 1.0 / 1000}) {
      const RunName run_name = parse_run_name(name, infos_of(engines()));
      const Simulation run = simulate(find_engine(engines(), run_name.engine), run_name.settings,
                                      known.definition.scene, dt, known.definition.duration);
      const Judged of(known, run.trajectory, name);
      const double end = of.trajectory.samples.back().bodies.columns().position(0).x();
      behind += end > 1;
      BOOST_TEST_CONTEXT(name << " at " << dt << " s ends at " << end << " m: " << of.verdict.why)
      BOOST_TEST((of.verdict.verdict == Verdict::tunnelled) == (end > 1));
    }
  }
  BOOST_TEST(behind > 3);
}

BOOST_AUTO_TEST_SUITE_END()
