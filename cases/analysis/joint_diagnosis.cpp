#include "cases/analysis/joint_diagnosis.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cases/analysis/metric_over_steps.h"
#include "cases/metrics/measures/energy_series.h"
#include "cases/metrics/measures/joints/joint_geometry.h"

namespace rigor::inline analysis {
namespace {

constexpr double kSmall = 1e-4;  // of a joint's reach: smaller gaps get no sentence

// The number of joints between the nodes of `from` and each node. The last node is all that stands still.
std::vector<int> distances(const Scene& scene, std::size_t from) {
  const std::size_t count = scene.bodies.size() + 1;
  const auto node = [&](int body) {
    return body == kWorld || scene.bodies[body].fixed ? count - 1 : static_cast<std::size_t>(body);
  };
  std::vector<int> far(count, -1);
  far[from] = 0;
  std::vector<std::size_t> reached = {from};
  for (std::size_t next = 0; next < reached.size(); ++next) {
    for (const Joint& joint : scene.joints) {
      const std::size_t a = node(joint.a), b = node(joint.b);
      if (a != reached[next] && b != reached[next]) continue;
      const std::size_t other = a == reached[next] ? b : a;
      if (far[other] < 0) far[other] = far[reached[next]] + 1, reached.push_back(other);
    }
  }
  return far;
}

const Cell* cell_at(const CaseResult& result, std::size_t run, const StepSize& dt) {
  const auto cell = std::find_if(result.cells.begin(), result.cells.end(),
                                 [&](const Cell& one) { return one.run == run && one.dt == dt; });
  return cell == result.cells.end() ? nullptr : &*cell;
}

// Another run of the same engine with at most a tenth of the gap at that step.
std::optional<std::size_t> run_that_holds(const Results& results, const CaseResult& result, const Cell& cell,
                                          double gap) {
  const RunName& mine = results.runs[cell.run];
  for (const std::size_t run : runs_of(result)) {
    const RunName& other = results.runs[run];
    const Cell* its = cell_at(result, run, cell.dt);
    if (run == cell.run || other.engine != mine.engine || other.settings.track != mine.settings.track || !its) continue;
    const auto found = its->metrics.find("joint_gap");
    const bool ran = found != its->metrics.end() && found->second.not_applicable.empty() &&
                     its->stability.verdict != Verdict::blown_up;
    if (ran && found->second.value <= 0.1 * gap) return run;
  }
  return std::nullopt;
}

std::optional<Diagnosis> chain_stretches(const Results& results, const CaseResult& result,
                                         const MetricOverSteps& gaps) {
  const Scene& scene = result.definition.scene;
  constexpr int kChain = 4;       // joints in a row
  constexpr double kUneven = 10;  // ratio of masses
  if (gaps.empty() || (joints_in_a_row(scene) < kChain && mass_ratio(scene) < kUneven)) return std::nullopt;
  const std::string sweeps = in_its_words(*gaps.cells.front(), "iterations");
  const double gap = gaps.values.front()->value;
  if (sweeps.empty() || gap < kSmall * joint_size(scene)) return std::nullopt;
  const auto other = run_that_holds(results, result, *gaps.cells.front(), gap);
  if (!other) return std::nullopt;
  Diagnosis found = diagnosis_of(kChainStretches, result, gaps, 0, gap, sweeps);
  found.runs.push_back(*other);
  found.beside = cell_at(result, *other, gaps.cells.front()->dt)->metrics.at("joint_gap").value;
  return found;
}

std::optional<Diagnosis> joints_part(const CaseResult& result, const MetricOverSteps& gaps) {
  if (gaps.empty()) return std::nullopt;
  const double gap = gaps.values.front()->value;
  const std::string share = setting_of(*gaps.cells.front(), "erp");
  if (gap < kSmall * joint_size(result.definition.scene) || share.empty()) return std::nullopt;
  Diagnosis found = diagnosis_of(kJointsPart, result, gaps, 0, gap, in_its_words(*gaps.cells.front(), "erp"));
  found.beside = gaps.values.front()->first_second;
  return found;
}

// The loss must be of first order in dt from step to step, because an error of position changes the energy to second
// order. Only engines that report how they correct joints count. The core's method explains its energy.
std::optional<Diagnosis> joints_take_energy(const CaseResult& result, const MetricOverSteps& drifts) {
  constexpr double kNotable = 0.01, kAll = 1;  // of the energy in play
  if (drifts.cells.size() < 2 || may_change_energy(result.definition.scene)) return std::nullopt;
  if (setting_of(*drifts.cells.front(), "erp").empty()) return std::nullopt;
  const bool only_losses = std::all_of(drifts.values.begin(), drifts.values.end(), [](const MetricValue* drift) {
    return drift->worst.found < drift->worst.expected;
  });
  const double coarse = drifts.values.front()->value;
  if (!only_losses || coarse < kNotable || coarse > kAll) return std::nullopt;
  constexpr double kLeast = 0.6, kMost = 1.5;  // that is neither none nor second order
  double order = 0;
  for (std::size_t n = 1; n < drifts.cells.size(); ++n) {
    order = std::log(drifts.values[n - 1]->value / drifts.values[n]->value) /
            std::log(drifts.cells[n - 1]->dt.seconds / drifts.cells[n]->dt.seconds);
    if (!(order > kLeast && order < kMost)) return std::nullopt;
  }
  Diagnosis found = diagnosis_of(kJointsTakeEnergy, result, drifts, 0, coarse, "");
  found.beside = order;
  return found;
}

}  // namespace

double joint_size(const Scene& scene) {
  double reach = 0;
  for (const Joint& joint : scene.joints) {
    const JointGeometry geometry(scene, joint);
    for (const JointEnd& end : {geometry.a(), geometry.b()}) {
      if (end.body == kWorld || scene.bodies[end.body].fixed) continue;
      const Body& body = scene.bodies[end.body];
      const double gyration = std::sqrt(body.inertia.trace() / (2 * body.mass));
      reach = std::max({reach, end.point.norm(), gyration});
    }
    if (const auto* distance = std::get_if<DistanceJoint>(&joint.type)) {
      const BodyPose a = scene.pose(joint.a), b = scene.pose(joint.b);
      const Vec3 apart =
          b.position + b.orientation * distance->point_b - a.position - a.orientation * distance->point_a;
      reach = std::max(reach, apart.norm());
    }
  }
  return reach;
}

int joints_in_a_row(const Scene& scene) {
  const auto farthest = [](const std::vector<int>& far) {
    return static_cast<std::size_t>(std::max_element(far.begin(), far.end()) - far.begin());
  };
  const std::vector<int> from_standing = distances(scene, scene.bodies.size());
  const int longest = *std::max_element(from_standing.begin(), from_standing.end());
  if (longest > 0 || scene.joints.empty()) return longest;
  const int first = std::max(scene.joints[0].a, 0);
  const std::vector<int> from_end = distances(scene, farthest(distances(scene, static_cast<std::size_t>(first))));
  return *std::max_element(from_end.begin(), from_end.end());
}

double mass_ratio(const Scene& scene) {
  double largest = 1;
  for (const Joint& joint : scene.joints) {
    if (joint.a == kWorld || joint.b == kWorld) continue;
    const Body &a = scene.bodies[joint.a], &b = scene.bodies[joint.b];
    if (!a.fixed && !b.fixed) largest = std::max({largest, a.mass / b.mass, b.mass / a.mass});
  }
  return largest;
}

std::vector<Diagnosis> joint_diagnoses(const Results& results, const CaseResult& result) {
  std::vector<Diagnosis> all;
  if (result.definition.scene.joints.empty()) return all;
  for (const std::size_t run : runs_of(result)) {
    const MetricOverSteps gaps = metric_over_steps(result, run, "joint_gap");
    auto gap = chain_stretches(results, result, gaps);
    if (!gap) gap = joints_part(result, gaps);
    if (gap) all.push_back(std::move(*gap));
    auto loss = joints_take_energy(result, metric_over_steps(result, run, "energy_drift_synchronised"));
    if (loss) all.push_back(std::move(*loss));
  }
  return all;
}

}  // namespace rigor::inline analysis
