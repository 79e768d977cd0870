#include "tests/relations/comparison.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "cases/truth/distance.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"
#include "tests/relations/scenes.h"

namespace rigor::test {
namespace {

constexpr double kOffset = 1e-10;  // m, and ten times that in m/s
// A motion that enlarges the offset by more than this is chaotic. Roundings of the start, 1e-15 m, then become 1e-13 m.
constexpr double kChaos = 100;

// m and rad: the most that a body that moves is apart. A plane has no pose of its own.
double apart(const Scene& scene, const BodyTable& a, const BodyTable& b) {
  BodyTable kept = a;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].fixed) kept.columns().set_body(i, b.columns().body(i));
  return distance_between(std::as_const(kept).columns(), b.columns());
}

Scene beside(Scene scene, double offset, Random& random) {
  for (Body& body : scene.bodies) {
    if (!body.fixed) body.position += offset * random.direction();
  }
  return scene;
}

// The same by a run with half the step, which tells the error of the method.
double error_of_steps(const MotionSource& run, const Scene& scene, const Motion& motion, double step) {
  const int steps = static_cast<int>(motion.states.size()) - 1;
  const Motion finer = run.motion(scene, 0.5 * step, 2 * steps);
  double most = 0;
  for (std::size_t k = 0; 2 * k < finer.states.size() && k < motion.states.size(); ++k)
    most = std::max(most, apart(scene, motion.states[k], finer.states[2 * k]));
  return most;
}

class Comparison {
 public:
  Comparison(const MotionSource& run, const std::string& scenes, unsigned seed)
      : run_(run), scene_(generated_scene(scenes, seed)), random_(seed + 0x9e3779b9ULL) {}

  bool is_declared() const { return run_.supports(scene_); }

  // The share of time in which it can be compared. Nothing where the run refuses the scene after all.
  std::optional<double> follow() {
    try {
      motion_ = run_.motion(scene_, run_.step, run_.steps);
    } catch (const std::runtime_error& failure) {
      BOOST_TEST_MESSAGE(run_.name << ": " << failure.what());
      return {};
    }
    end_ = motion_.end;
    if (!motion_.claims.empty()) {
      const auto is_known = [](double claim) { return claim < 1e-6; };
      return static_cast<double>(std::count_if(motion_.claims.begin(), motion_.claims.end(), is_known)) /
             static_cast<double>(motion_.claims.size());
    }
    const Motion other = run_.motion(beside(scene_, kOffset, random_), run_.step, run_.steps);
    end_ = std::min({end_, other.end});
    for (std::size_t k = 1; k <= end_; ++k)
      if (apart(scene_, motion_.states[k], other.states[k]) > kChaos * kOffset) end_ = k - 1;
    return static_cast<double>(end_) / run_.steps;
  }

  void add(const Relation& relation, Tally& tally, const std::string& name) {
    const std::optional<Related> related = made(relation);
    if (!related || !run_.supports(related->scene)) return;
    ++tally.scenes;
    const auto [most, share] = differences(relation, *related);
    tally.largest = std::max(tally.largest, most);
    if (!(share <= 1)) ++tally.broken;
    if (!(share <= tally.nearest)) tally.nearest = share, tally.worst = name;
  }

 private:
  std::optional<Related> made(const Relation& relation) {
    if (relation.name == "restarted" && !run_.is_one_step) return {};
    if (relation.keeps == Keeps::bits && !run_.takes_binary_units) return {};
    if (relation.name == "back in time" && (!run_.is_symmetric || end_ < motion_.states.size() - 1)) return {};
    return relation.of({scene_, motion_.states, run_.step}, random_);
  }

  // The most apart, and the largest share of the bound. Both are infinite where the run fails.
  std::pair<double, double> differences(const Relation& relation, const Related& related) {
    constexpr double kFailed = std::numeric_limits<double>::infinity();
    const int steps = static_cast<int>(related.steps({scene_, motion_.states, run_.step}));
    const double step = run_.step * related.how.time;
    try {
      const Motion other = run_.motion(related.scene, step, steps);
      const double start = start_error(related, other, step), by_steps = step_error(relation, related, other, step),
                   by_run = run_error(relation, related);
      double most = 0, share = 0;
      for (std::size_t k = 0; k <= end_; ++k) {
        if (!related.covers(k)) continue;
        const std::size_t n = related.sample(k);
        if (n > other.end) continue;
        const double found = apart(scene_, motion_.states[k],
                                   related.original(other.states[n].columns(), static_cast<double>(k) * run_.step));
        double bound = by_run + by_steps + start;
        if (!other.claims.empty()) bound += motion_.claims[k] + other.claims[n] / std::min(1.0, related.how.length);
        most = std::max(most, found), share = std::max(share, found == 0 ? 0 : found / bound);
      }
      return {most, share};
    } catch (const std::runtime_error& failure) {
      BOOST_TEST_MESSAGE(run_.name << ", " << relation.name << ": " << failure.what());
      return {kFailed, kFailed};
    }
  }

  // A truth's error in the state that the related scene begins with, as that motion enlarges it.
  double start_error(const Related& related, const Motion& other, double step) {
    if (related.first == 0 || motion_.claims.empty()) return 0;
    constexpr double kApart = 1e-6, kOfUnknownVelocity = 10;  // m; times
    const Motion neighbour =
        run_.motion(beside(related.scene, kApart, random_), step, static_cast<int>(other.states.size()) - 1);
    double growth = 1;
    for (std::size_t k = 0; k < other.states.size(); ++k)
      growth = std::max(growth, apart(related.scene, other.states[k], neighbour.states[k]) / kApart);
    return kOfUnknownVelocity * growth * motion_.claims[related.first];
  }

  double run_error(const Relation& relation, const Related& related) const {
    if (relation.keeps == Keeps::bits && run_.keeps_bits) return 0;
    const Equivalence& how = related.how;  // 1 m, 1 m/s and 1 rad/s of the related scene, in the original's units
    const double unit = std::max({1.0, 1 / how.length, how.time / how.length, how.time});
    const bool has_thresholds = relation.keeps == Keeps::stretches || relation.keeps == Keeps::motion;
    return run_.rounding + kChaos * run_.tolerance * run_.steps * unit + (has_thresholds ? run_.thresholds : 0);
  }

  // The two runs have the method's errors, each at most twice the effect of half the step.
  double step_error(const Relation& relation, const Related& related, const Motion& other, double step) {
    if (!(relation.keeps == Keeps::motion || run_.has_two_ways) || !motion_.claims.empty()) return 0;
    const double here = error_of_steps(run_, scene_, motion_, run_.step);
    const double there = error_of_steps(run_, related.scene, other, step) / related.how.length;
    return 2 * (here + there);
  }

  const MotionSource& run_;
  Scene scene_;
  Random random_;
  Motion motion_;
  std::size_t end_ = 0;
};

int number_of(const char* variable, int otherwise) {
  const char* wish = std::getenv(variable);
  return wish ? std::atoi(wish) : otherwise;
}

}  // namespace

Tallies compare(const MotionSource& run, const std::string& scenes, unsigned first, int count) {
  Tallies tallies;
  for (unsigned seed = first; seed < first + static_cast<unsigned>(count); ++seed) {
    Comparison comparison(run, scenes, seed);
    ++tallies.scenes;
    if (!comparison.is_declared()) continue;
    ++tallies.asked;
    const std::optional<double> followed = comparison.follow();
    if (!followed) continue;
    ++tallies.supported;
    tallies.followed += *followed;
    for (const Relation& relation : relations())
      comparison.add(relation, tallies.of[relation.name], scenes + " " + std::to_string(seed));
  }
  return tallies;
}

namespace {

bool is_usual() { return !std::getenv("RIGOR_RELATIONS") && !std::getenv("RIGOR_RELATIONS_FROM"); }

void check_relation(const Tally& tally, const std::string& of, const Fact* fact) {
  BOOST_TEST_MESSAGE(of << ": " << tally.broken << " of " << tally.scenes << " scenes broken, " << tally.largest
                        << " m or rad apart, " << tally.nearest << " of the bound in " << tally.worst);
  if (!fact) {
    BOOST_TEST(tally.broken == 0, of << " is broken in " << tally.broken << " of " << tally.scenes << " scenes, in '"
                                     << tally.worst << "' by " << tally.nearest << " times its bound");
  } else if (is_usual()) {
    BOOST_TEST((fact->least <= tally.broken && tally.broken <= fact->most),
               of << " is broken in " << tally.broken << " scenes; known: " << fact->least << " to " << fact->most
                  << " (" << fact->reason << ")");
  }
}

}  // namespace

void check(const MotionSource& run, const std::string& scenes, int count, const std::vector<Fact>& facts) {
  constexpr double kUsual = 1000;  // scenes of all rows together
  const int wished = static_cast<int>(std::ceil(count * number_of("RIGOR_RELATIONS", 1000) / kUsual));
  const Tallies tallies = compare(run, scenes, static_cast<unsigned>(number_of("RIGOR_RELATIONS_FROM", 100)), wished);
  BOOST_TEST_MESSAGE(run.name << ", " << scenes << ": " << tallies.supported << " of " << tallies.scenes
                              << " scenes supported, followed through " << tallies.followed);
  // What is refused, or a comparison that ends early, is no proof. DART refuses limits that bounce, in a third.
  BOOST_TEST(tallies.supported >= 0.5 * tallies.asked, run.name << ", " << scenes << ": asked " << tallies.asked);
  BOOST_TEST(tallies.followed >= 0.7 * tallies.supported, run.name << ", " << scenes << ": " << tallies.followed);
  for (const auto& [relation, tally] : tallies.of) {
    const std::string name = relation;
    const auto fact = std::find_if(facts.begin(), facts.end(), [&](const Fact& one) {
      return one.run == run.name && one.scenes == scenes && one.relation == name;
    });
    check_relation(tally, run.name + ", " + scenes + ", " + name, fact == facts.end() ? nullptr : &*fact);
  }
}

}  // namespace rigor::test
