#include <fmt/format.h>

#include <algorithm>

#include "cases/truth/flat_ground.h"
#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline truth {

// One declaration and one row a truth, alphabetical; each is defined in the file of its name.
TruthRow asymmetric_top_truth();
TruthRow axisymmetric_top_truth();
TruthRow bounce_truth();
TruthRow cardan_shaft_truth();
TruthRow events_truth();
TruthRow heavy_top_truth();
TruthRow line_impacts_truth();
TruthRow linkage_truth();
TruthRow oscillator_truth();
TruthRow pendulum_truth();
TruthRow pendulum_impacts_truth();
TruthRow planar_truth();
TruthRow principal_torque_truth();
TruthRow projectile_truth();
TruthRow pushed_truth();
TruthRow recording_truth();
TruthRow reference_truth();
TruthRow rolling_truth();
TruthRow round_on_plane_truth();
TruthRow slider_truth();
TruthRow sliding_truth();
TruthRow soft_bounce_truth();
TruthRow sprung_ball_truth();
TruthRow steady_precession_truth();
TruthRow toppling_truth();
TruthRow transmission_truth();
TruthRow welded_truth();

const std::vector<TruthRow>& truths() {
  static const std::vector<TruthRow> table = {
      asymmetric_top_truth(),
      axisymmetric_top_truth(),
      bounce_truth(),
      cardan_shaft_truth(),
      events_truth(),
      heavy_top_truth(),
      line_impacts_truth(),
      linkage_truth(),
      oscillator_truth(),
      pendulum_truth(),
      pendulum_impacts_truth(),
      planar_truth(),
      principal_torque_truth(),
      projectile_truth(),
      pushed_truth(),
      recording_truth(),
      reference_truth(),
      rolling_truth(),
      round_on_plane_truth(),
      slider_truth(),
      sliding_truth(),
      soft_bounce_truth(),
      sprung_ball_truth(),
      steady_precession_truth(),
      toppling_truth(),
      transmission_truth(),
      welded_truth(),
  };
  return table;
}

namespace {

// Solved truths look at which pairs pass through each other. Of closed forms only `rolling` does.
void refuse_pairs_apart(const std::string& kind, const Scene& scene) {
  if (kind == "events" || kind == "reference" || kind == "rolling") return;
  const auto& pairs = scene.contact_pairs;
  const auto apart = std::find_if(pairs.begin(), pairs.end(), [&](const ContactPair& pair) {
    return !pair.law.collides && can_meet(scene.bodies[pair.a], scene.bodies[pair.b]);
  });
  if (apart == pairs.end()) return;
  throw InputError(
      fmt::format("the truth '{}' takes no pair with collides = false, and '{}' and '{}' are one; allowed: 'events', "
                  "or 'reference' where nothing touches",
                  kind, scene.body_name(apart->a), scene.body_name(apart->b)));
}

// Only the truth `rolling` knows rolling and torsional friction, and only `soft-bounce` soft contacts.
void refuse_other_laws(const std::string& kind, const Scene& scene) {
  if (kind == "reference" || !anything_can_touch(scene)) return;
  if (kind != "rolling" && any_law(scene, [](const ContactLaw& law) { return law.resists_turning(); }))
    throw InputError(
        fmt::format("the truth '{}' has no rolling or torsional friction; allowed: 'rolling', or 'none'", kind));
  if (kind != "soft-bounce" && any_law(scene, [](const ContactLaw& law) { return law.is_soft(); }))
    throw InputError(fmt::format("the truth '{}' has no soft contacts; allowed: 'soft-bounce', or 'none'", kind));
}

}  // namespace

std::unique_ptr<Truth> make_truth(const std::string& kind, const Scene& scene, double duration) {
  if (kind == "none") return nullptr;
  std::vector<std::string> names = {"none"};
  for (const TruthRow& row : truths()) {
    if (row.name == kind) {
      refuse_pairs_apart(kind, scene), refuse_other_laws(kind, scene);
      return truth_over_ground(scene, row.make(on_planes(scene), duration), duration);
    }
    names.push_back(row.name);
  }
  throw InputError(
      fmt::format("there is no truth '{}'{}; there is: {}", kind, did_you_mean(kind, names), listed(names)));
}

double horizon(const Truth& truth, double tolerance, double duration) {
  if (truth.error(duration) <= tolerance) return duration;
  if (truth.error(0) > tolerance) return 0;
  double within = 0, beyond = duration;
  constexpr int kHalvings = 60;  // down to the spacing of doubles
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (within + beyond);
    (truth.error(middle) <= tolerance ? within : beyond) = middle;
  }
  return within;
}

}  // namespace rigor::inline truth
