#include "tests/cases/report/wording/claim_oracle.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "adapters/engines.h"
#include "cases/analysis/joint_diagnosis.h"
#include "cases/case/recording/recording.h"
#include "cases/report/wording/comparison.h"
#include "cases/report/wording/explanations/explanation.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/results/trial_results.h"
#include "core/engine/run_name.h"
#include "tests/cases/report/wording/claim_text.h"

namespace rigor::test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// ---- cells and metrics ---------------------------------------------------------------------------------------------

const CaseResult* case_of(const Results& results, const std::string& id) {
  for (const CaseResult& one : results.cases)
    if (one.definition.id == id) return &one;
  return nullptr;
}

const Cell* cell_of(const Results& results, const Claim& claim) {
  const CaseResult* one = case_of(results, claim.of_case);
  if (!one) return nullptr;
  for (const Cell& cell : one->cells)
    if (results.runs[cell.run].text == claim.of_run && cell.dt.text == claim.dt) return &cell;
  return nullptr;
}

const MetricValue* metric(const std::map<std::string, MetricValue>& metrics, const std::string& name) {
  const auto at = metrics.find(name);
  return at != metrics.end() && at->second.not_applicable.empty() ? &at->second : nullptr;
}

double sign_of(const MetricValue& value) { return value.worst.found < value.worst.expected ? -1 : 1; }

double value_in(const std::map<std::string, MetricValue>& metrics, const std::string& name, bool is_signed) {
  const MetricValue* value = metric(metrics, name);
  return value ? value->value * (is_signed ? sign_of(*value) : 1) : kNone;
}

bool blown(const Cell& cell) { return cell.stability.verdict == Verdict::blown_up; }

// All cells at a step that got so far as to have metrics, with their cases.
using Visit = std::function<void(const CaseResult&, const Cell&)>;
void each_cell(const Results& results, const std::string& dt, const Visit& visit) {
  for (const CaseResult& one : results.cases) {
    for (const Cell& cell : one.cells)
      if (cell.dt.text == dt && !cell.metrics.empty()) visit(one, cell);
  }
}

bool is_core(const Results& results, std::size_t run) {
  for (const EngineInfo& engine : results.engines)
    if (engine.name == results.runs[run].engine) return engine.is_in_house;
  return false;
}

// ---- small motions, by multipliers and differences -----------------------------------------------------------------

struct Element {
  std::string name;
  double k, c;
  Eigen::VectorXd row;  // rate of the coordinate from all velocities, in W
  bool is_hinge = false;
};

struct Motions {
  std::vector<Element> elements;
  Eigen::MatrixXd response;  // accelerations by unit efforts
};

// The six velocities of each body move it by this much for the differences.
constexpr double kNudge = 1e-6;

Scene nudged(const Scene& scene, Eigen::Index column, double by) {
  Scene moved = scene;
  Body& body = moved.bodies[static_cast<std::size_t>(column / 6)];
  const int k = static_cast<int>(column % 6);
  if (k < 3) {
    body.position[k] += by;
  } else {
    body.orientation = Quat(Eigen::AngleAxisd(by, Vec3::Unit(k - 3))) * body.orientation;
  }
  return moved;
}

Vec3 placed(const Scene& scene, int body, const Vec3& local) {
  const BodyPose pose = scene.pose(body);
  return pose.position + pose.orientation * local;
}

Vec3 local_of(const Scene& at_start, int body, const Vec3& in_world) {
  const BodyPose pose = at_start.pose(body);
  return pose.orientation.conjugate() * (in_world - pose.position);
}

// The turn of b against a since the start, as a rotation vector in W at the start.
Vec3 turn_of(const Scene& at_start, const Scene& now, const Joint& joint) {
  const Quat a0 = at_start.pose(joint.a).orientation, b0 = at_start.pose(joint.b).orientation,
             a = now.pose(joint.a).orientation, b = now.pose(joint.b).orientation;
  const Eigen::AngleAxisd turn(a0 * (a.conjugate() * b) * (a0.conjugate() * b0).conjugate() * a0.conjugate());
  return turn.angle() * turn.axis();
}

// What a joint holds, as numbers that stay zero.
std::vector<double> held(const Scene& start, const Scene& now, const Joint& joint) {
  std::vector<double> rows;
  const auto add = [&](const Vec3& v) { rows.insert(rows.end(), v.data(), v.data() + 3); };
  if (const auto* distance = std::get_if<DistanceJoint>(&joint.type)) {
    const auto length = [&](const Scene& s) {
      return (placed(s, joint.b, distance->point_b) - placed(s, joint.a, distance->point_a)).norm();
    };
    return {length(now) - length(start)};
  }
  const auto apart = [&](const Vec3& anchor) -> Vec3 {
    return placed(now, joint.b, local_of(start, joint.b, anchor)) -
           placed(now, joint.a, local_of(start, joint.a, anchor));
  };
  const auto axis_of = [&](int body, const Vec3& axis) -> Vec3 {
    return now.pose(body).orientation * (start.pose(body).orientation.conjugate() * axis);
  };
  if (const auto* ball = std::get_if<BallJoint>(&joint.type)) {
    add(apart(ball->anchor));
  } else if (const auto* hinge = std::get_if<HingeJoint>(&joint.type)) {
    add(apart(hinge->anchor));
    add(axis_of(joint.a, hinge->axis).cross(axis_of(joint.b, hinge->axis)));
  } else if (const auto* universal = std::get_if<UniversalJoint>(&joint.type)) {
    add(apart(universal->anchor));
    rows.push_back(axis_of(joint.a, universal->axis).dot(axis_of(joint.b, universal->axis2)));
  } else {
    const Vec3 centre = start.pose(joint.b).position;
    const auto* slider = std::get_if<SliderJoint>(&joint.type);
    add(slider ? Vec3(axis_of(joint.a, slider->axis).cross(apart(centre))) : apart(centre));
    add(turn_of(start, now, joint));
  }
  return rows;
}

template <typename F>
Eigen::MatrixXd differences(const Scene& scene, Eigen::Index rows, const F& values) {
  const auto columns = 6 * static_cast<Eigen::Index>(scene.bodies.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows, columns);
  for (Eigen::Index column = 0; column < columns; ++column) {
    if (scene.bodies[static_cast<std::size_t>(column / 6)].fixed) continue;
    const std::vector<double> up = values(nudged(scene, column, kNudge)), down = values(nudged(scene, column, -kNudge));
    for (Eigen::Index row = 0; row < rows; ++row)
      J(row, column) = (up[static_cast<std::size_t>(row)] - down[static_cast<std::size_t>(row)]) / (2 * kNudge);
  }
  return J;
}

std::vector<double> all_held(const Scene& start, const Scene& now) {
  std::vector<double> rows;
  for (const Joint& joint : start.joints) {
    for (const double row : held(start, now, joint)) rows.push_back(row);
  }
  return rows;
}

std::vector<Element> elements_of(const Scene& scene) {
  std::vector<Element> found;
  const auto add = [&](const std::string& name, double k, double c, bool is_hinge, const auto& coordinate) {
    const Eigen::MatrixXd row =
        differences(scene, 1, [&](const Scene& now) { return std::vector<double>{coordinate(now)}; });
    found.push_back({name, k, c, row.row(0).transpose(), is_hinge});
  };
  for (const Spring& spring : scene.springs) {
    if (spring.stiffness == 0 && spring.damping == 0) continue;
    add(fmt::format("the spring of '{}' and '{}'", scene.body_name(spring.a), scene.body_name(spring.b)),
        spring.stiffness, spring.damping, false, [&](const Scene& now) {
          return (placed(now, spring.b, spring.point_b) - placed(now, spring.a, spring.point_a)).norm();
        });
  }
  const auto add_on_joint = [&](const Joint& joint, const std::string& name, double k, double c) {
    if (k == 0 && c == 0) return;
    if (const auto* hinge = std::get_if<HingeJoint>(&joint.type)) {
      add(name, k, c, true, [&](const Scene& now) { return turn_of(scene, now, joint).dot(hinge->axis); });
    } else if (const auto* slider = std::get_if<SliderJoint>(&joint.type)) {
      add(name, k, c, false, [&](const Scene& now) {
        const Vec3 axis = now.pose(joint.a).orientation * (scene.pose(joint.a).orientation.conjugate() * slider->axis);
        const Vec3 place = placed(now, joint.a, local_of(scene, joint.a, scene.pose(joint.b).position));
        return axis.dot(now.pose(joint.b).position - place);
      });
    }
  };
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    add_on_joint(scene.joints[i], scene.joint_name(i), scene.joints[i].stiffness, scene.joints[i].damping);
  for (const Motor& motor : scene.motors) {
    const auto i = static_cast<std::size_t>(motor.joint);
    if (motor.servo && motor.servo->period == 0)
      add_on_joint(scene.joints[i], fmt::format("the servo of {}", scene.joint_name(i)), motor.servo->kp,
                   motor.servo->kd);
  }
  return found;
}

// Efforts push the bodies, multipliers hold the joints: M a = Gᵀ f + Jᵀ l, J a = 0.
Motions motions_of(const Scene& scene) {
  Motions motions{elements_of(scene), {}};
  const auto n = 6 * static_cast<Eigen::Index>(scene.bodies.size());
  const auto rows = static_cast<Eigen::Index>(all_held(scene, scene).size());
  const Eigen::MatrixXd J = differences(scene, rows, [&](const Scene& now) { return all_held(scene, now); });
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + rows, n + rows);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const Mat3 R = body.orientation.toRotationMatrix();
    const auto at = 6 * static_cast<Eigen::Index>(i);
    system.block<3, 3>(at, at) = body.mass * Mat3::Identity();
    system.block<3, 3>(at + 3, at + 3) = R * body.inertia * R.transpose();
  }
  system.topRightCorner(n, rows) = -J.transpose(), system.bottomLeftCorner(rows, n) = J;
  Eigen::FullPivLU<Eigen::MatrixXd> lu(system);
  lu.setThreshold(1e-9);  // rows of loops repeat each other but for the differences' error
  const auto count = static_cast<Eigen::Index>(motions.elements.size());
  motions.response.resize(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + rows);
    right.head(n) = motions.elements[static_cast<std::size_t>(i)].row;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (scene.bodies[b].fixed) right.segment<6>(6 * static_cast<Eigen::Index>(b)).setZero();
    const Eigen::VectorXd solved = lu.solve(right);
    for (Eigen::Index k = 0; k < count; ++k)
      motions.response(k, i) = motions.elements[static_cast<std::size_t>(k)].row.dot(solved.head(n));
  }
  return motions;
}

// The stiffest mode: rad/s, and 1/s of its damping.
std::pair<double, double> stiffest(const Motions& motions) {
  const auto count = static_cast<Eigen::Index>(motions.elements.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(count, count), C = K;
  for (Eigen::Index i = 0; i < count; ++i)
    K(i, i) = motions.elements[static_cast<std::size_t>(i)].k,
         C(i, i) = motions.elements[static_cast<std::size_t>(i)].c;
  // High powers of a matrix keep its largest mode alone. Eigen's solver would take a compiler half a minute.
  const Eigen::MatrixXd once = motions.response * K;
  Eigen::MatrixXd power = once / once.norm();
  for (int doubled = 0; doubled < 40; ++doubled) {
    power = (power * power).eval();
    power /= power.norm();
  }
  Eigen::Index most = 0;
  power.colwise().norm().maxCoeff(&most);
  const Eigen::VectorXd x = power.col(most);  // the coordinates' amplitudes
  const double squared = x.dot(once * x) / x.squaredNorm();
  // The power that dampers take of a unit speed, over twice the kinetic energy, which is xᵀKx / squared.
  return {std::sqrt(squared), x.dot(C * x) * squared / x.dot(K * x)};
}

std::optional<std::size_t> element_named(const Motions& motions, const std::string& name) {
  for (std::size_t i = 0; i < motions.elements.size(); ++i)
    if (motions.elements[i].name == name) return i;
  return {};
}

double inertia_of(const Motions& motions, std::size_t i) {
  return 1 / motions.response(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
}

// Of the suspect: frequency [rad/s] and rate [1/s].
std::optional<std::pair<double, double>> oscillator(const Motions& motions, const std::string& part) {
  if (part == "mode") return stiffest(motions);
  const auto i = element_named(motions, part);
  if (!i) return {};
  const double inertia = inertia_of(motions, *i);
  return std::pair{std::sqrt(motions.elements[*i].k / inertia), motions.elements[*i].c / inertia};
}

// The largest size of an eigenvalue, by the roots of their equation.
double spectral_radius(const Eigen::Matrix2d& A) {
  const double middle = 0.5 * A.trace(), product = A.determinant(), square = middle * middle - product;
  return square < 0 ? std::sqrt(product) : std::abs(middle) + std::sqrt(square);
}

// The largest dt at which the semi-implicit step's matrix has no eigenvalue beyond the unit circle, by bisection.
double semi_implicit_step(double w, double c) {
  const auto radius = [&](double h) {
    Eigen::Matrix2d step;
    step << 1 - h * h * w * w, h * (1 - h * c), -h * w * w, 1 - h * c;
    return spectral_radius(step);
  };
  double low = 0, high = 1e6;
  for (int round = 0; round < 200; ++round) (radius(0.5 * (low + high)) > 1 + 1e-12 ? high : low) = 0.5 * (low + high);
  return low;
}

// The energy's factor a step where a run's own update of x and v is known; nothing for other methods.
std::optional<double> energy_growth_of(const std::string& method, double w, double c, double h) {
  Eigen::Matrix2d step;
  if (method == "explicit-euler") {
    step << 1, h, -h * w * w, 1 - h * c;
  } else if (method == "semi-implicit-euler") {
    step << 1 - h * h * w * w, h * (1 - h * c), -h * w * w, 1 - h * c;
  } else if (method == "rk4" || method == "rkmk4") {
    Eigen::Matrix2d A;
    A << 0, 1, -w * w, -c;
    const Eigen::Matrix2d z = h * A;
    step = Eigen::Matrix2d::Identity() + z + z * z / 2 + z * z * z / 6 + z * z * z * z / 24;
  } else {
    return {};
  }
  const double radius = spectral_radius(step);
  return radius * radius;
}

// ---- the graph of joints -------------------------------------------------------------------------------------------

// By shortest paths between all nodes (R. W. Floyd): from what stands, else the longest of all.
double joints_in_a_row_of(const Scene& scene) {
  const std::size_t n = scene.bodies.size() + 1;
  const double far = 1e9;
  std::vector<std::vector<double>> d(n, std::vector<double>(n, far));
  const auto node = [&](int b) {
    return b == kWorld || scene.bodies[static_cast<std::size_t>(b)].fixed ? n - 1 : static_cast<std::size_t>(b);
  };
  for (std::size_t i = 0; i < n; ++i) d[i][i] = 0;
  for (const Joint& joint : scene.joints) {
    if (node(joint.a) != node(joint.b)) d[node(joint.a)][node(joint.b)] = d[node(joint.b)][node(joint.a)] = 1;
  }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
  const auto longest = [&](const std::vector<double>& row) {
    double most = 0;
    for (const double one : row) most = one < far ? std::max(most, one) : most;
    return most;
  };
  if (longest(d[n - 1]) > 0) return longest(d[n - 1]);
  double most = 0;
  for (const auto& row : d) most = std::max(most, longest(row));
  return most;
}

double mass_ratio_of(const Scene& scene) {
  double most = 1;
  for (const Joint& joint : scene.joints) {
    if (joint.a == kWorld || joint.b == kWorld) continue;
    const Body &a = scene.bodies[static_cast<std::size_t>(joint.a)],
               &b = scene.bodies[static_cast<std::size_t>(joint.b)];
    if (a.fixed || b.fixed) continue;
    most = std::max(most, std::max(a.mass, b.mass) / std::min(a.mass, b.mass));
  }
  return most;
}

// ---- findings ------------------------------------------------------------------------------------------------------

bool was_found_to_drift(const Cell& cell) {
  return cell.stability.verdict == Verdict::drifting || cell.stability.verdict == Verdict::gaining;
}

// Whether anything but an engine's error takes or gives energy.
bool changes_energy(const Scene& scene) {
  const auto damps = [](const auto& part) { return part.damping > 0; };
  const auto loses = [](const ContactLaw& law) { return law.restitution < 1 || law.friction > 0; };
  const auto has_loss = std::any_of(scene.contact_pairs.begin(), scene.contact_pairs.end(),
                                    [&](const ContactPair& pair) { return loses(pair.law); });
  const auto collides = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                      [](const Body& body) { return body.collides && body.shape; });
  return !scene.forces.empty() || !scene.motors.empty() ||
         (collides > 1 && (loses(scene.contact_default) || has_loss)) ||
         std::any_of(scene.springs.begin(), scene.springs.end(), damps) ||
         std::any_of(scene.joints.begin(), scene.joints.end(),
                     [&](const Joint& joint) { return damps(joint) || (joint.has_limits() && joint.restitution < 1); });
}

// The largest loss or gain of a run that was found to drift, over all cases.
double worst_energy(const Results& results, const Claim& claim, bool is_loss) {
  double worst = 0;
  std::string where;
  each_cell(results, claim.dt, [&](const CaseResult& one, const Cell& cell) {
    if (results.runs[cell.run].text != claim.of_run || !was_found_to_drift(cell)) return;
    if (changes_energy(one.definition.scene)) return;
    const double drift = value_in(cell.metrics, "energy_drift", true);
    if (std::abs(drift) > 0.01 && (drift < 0) == is_loss && std::abs(drift) > std::abs(worst))
      worst = drift, where = one.definition.id;
  });
  return where == claim.of_case ? worst : kNone;
}

double worst_sampling(const Results& results, const Claim& claim) {
  double worst = 0;
  std::string where;
  each_cell(results, claim.dt, [&](const CaseResult& one, const Cell& cell) {
    if (results.runs[cell.run].text != claim.of_run || blown(cell)) return;
    const double raw = value_in(cell.metrics, "energy_drift", false),
                 both = value_in(cell.metrics, "energy_drift_synchronised", false);
    if (raw > 0.01 && both < 0.01 && raw > worst) worst = raw, where = one.definition.id;
  });
  return where == claim.of_case ? worst : kNone;
}

double largest_unexplained(const Results& results, const Claim& claim) {
  double largest = -1;
  const Cell* at = nullptr;
  each_cell(results, claim.dt, [&](const CaseResult&, const Cell& cell) {
    const double rest = value_in(cell.metrics, "unexplained_error", false);
    if (!cell.scheme.twin.empty() && !blown(cell) && rest > largest) largest = rest, at = &cell;
  });
  const Cell* claimed = cell_of(results, claim);
  return at && claimed && value_in(claimed->metrics, "unexplained_error", false) == largest ? largest : kNone;
}

double spring_frequency_of(const Scene& scene) {
  Scene free = scene;
  free.joints.clear(), free.motors.clear();
  if (free.springs.empty()) return 0;
  return stiffest(motions_of(free)).first;
}

using Chosen = std::function<bool(const CaseResult&, const Cell&)>;
double count_cells(const Results& results, const Claim& claim, const Chosen& chosen) {
  double count = 0;
  each_cell(results, claim.dt, [&](const CaseResult& one, const Cell& cell) {
    count += results.runs[cell.run].text == claim.of_run && chosen(one, cell);
  });
  return count;
}

bool has_stiff_springs(const CaseResult& one, const Cell& cell) {
  return spring_frequency_of(one.definition.scene) * cell.dt.seconds >= 1;
}

// A run's verdicts over its cells: over all, or over those with stiff springs.
struct Ends {
  double ran = 0, blown = 0, stable = 0;
};
Ends ends_of(const Results& results, std::size_t run, const std::string& dt, bool only_stiff) {
  Ends ends;
  each_cell(results, dt, [&](const CaseResult& one, const Cell& cell) {
    if (cell.run != run || (only_stiff && !has_stiff_springs(one, cell))) return;
    ++ends.ran, ends.blown += blown(cell), ends.stable += cell.stability.verdict == Verdict::stable;
  });
  return ends;
}

double stiff_cases(const Results& results, double dt) {
  return static_cast<double>(std::count_if(results.cases.begin(), results.cases.end(), [&](const CaseResult& one) {
    return spring_frequency_of(one.definition.scene) * dt >= 1;
  }));
}

// How many of our methods a finding counts, by its words.
std::optional<double> core_methods(const Results& results, const std::string& what) {
  const StepSize headline = headline_dt(results);
  const bool is_stiff = what.starts_with("stiff");
  const auto cases = is_stiff ? stiff_cases(results, headline.seconds) : static_cast<double>(results.cases.size());
  double in_all = 0, never = 0, some = 0, all_stable = 0, bounded = 0, cones = 0;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    if (!is_core(results, run)) continue;
    const Ends ends = ends_of(results, run, headline.text, is_stiff);
    const bool is_common = is_stiff ? ends.ran > 0 && 2 * ends.ran >= cases : 2 * ends.ran > cases;
    if (ends.blown > 0 && (!is_stiff || is_common)) ++some, ++in_all;
    if (ends.blown == 0 && is_common) {
      ++never, ++in_all;
      (ends.stable == ends.ran ? all_stable : bounded) += 1;
    }
    double spread = -1;
    each_cell(results, headline.text, [&](const CaseResult&, const Cell& cell) {
      if (cell.run == run && !blown(cell))
        spread = std::max(spread, value_in(cell.metrics, "friction_anisotropy", false));
    });
    cones += spread >= 0 && spread < 0.05;
  }
  if (what == "cells that blew up" || what == "stiff cells that blew up") return some;
  if (what == "cells that never blew up") return never;
  if (what == "stiff cells that are all stable") return all_stable;
  if (what == "stiff cells that are bounded") return bounded;
  if (what == "cone friction") return cones;
  return {};
}

std::optional<double> core_methods_in_all(const Results& results, const std::string& what) {
  if (what == "cone friction") return core_methods(results, what);
  const bool is_stiff = what.starts_with("stiff");
  const std::string lost = is_stiff ? "stiff cells that blew up" : "cells that blew up";
  if (!is_stiff) return *core_methods(results, lost) + *core_methods(results, "cells that never blew up");
  return *core_methods(results, lost) + *core_methods(results, "stiff cells that are all stable") +
         *core_methods(results, "stiff cells that are bounded");
}

// ---- steps for a tolerance -----------------------------------------------------------------------------------------

std::string case_metric(const CaseResult& one) {
  const auto largest = [&](const std::string& name) {
    double most = 0;
    for (const Cell& cell : one.cells) {
      const double value = value_in(cell.metrics, name, false);
      if (value > most) most = value;
    }
    return most;
  };
  if (largest("position_error") > 1e-9) return "position_error";
  if (largest("orientation_error") > 1e-9) return "orientation_error";
  for (const Cell& cell : one.cells)
    if (metric(cell.metrics, "position_error") && largest("energy_drift") < 1e-9) return "position_error";
  return "";
}

// dt and error, infinite where the run failed.
std::vector<std::pair<double, double>> errors_of(const CaseResult& one, std::size_t run) {
  std::vector<std::pair<double, double>> points;
  for (const Cell& cell : one.cells) {
    if (cell.run != run || cell.status == Status::unsupported) continue;
    const MetricValue* error = metric(cell.metrics, case_metric(one));
    if (error && error->is_held_to_itself) continue;
    const bool is_result = cell.status == Status::pass || cell.status == Status::fail ||
                           cell.status == Status::known_deviation || cell.status == Status::unexpected_pass;
    const bool is_wrong = cell.stability.verdict != Verdict::stable && cell.stability.verdict != Verdict::drifting;
    const bool failed = !is_result || (!cell.metrics.empty() && is_wrong) || (error && !std::isfinite(error->value));
    if (!failed && !error) continue;
    const double truth = one.truth ? one.truth->error_at_end : 0;
    points.emplace_back(cell.dt.seconds, failed ? HUGE_VAL : std::max({error->value, 1e-14, std::min(truth, 1e-6)}));
  }
  return points;
}

// The largest step at which geometric mean and median are within the tolerance and one case in twenty fails at most.
std::optional<double> largest_step(const Results& results, std::size_t run, double tolerance) {
  std::map<double, std::vector<double>> errors;  // of each dt, infinite for a failed case
  std::size_t with_run = 0;
  for (const CaseResult& one : results.cases) {
    with_run += std::any_of(one.cells.begin(), one.cells.end(), [run](const Cell& cell) { return cell.run == run; });
    if (case_metric(one).empty()) continue;
    for (const auto& [dt, error] : errors_of(one, run)) errors[dt].push_back(error);
  }
  if (errors.empty() || 2 * with_run < results.cases.size()) return {};
  std::size_t most = 0;
  for (const auto& [dt, all] : errors) most = std::max(most, all.size());
  double largest = 0;
  for (auto& [dt, all] : errors) {
    std::sort(all.begin(), all.end());
    double product = 0;
    std::size_t finite = 0;
    for (const double error : all)
      if (error < HUGE_VAL) product += std::log(error), ++finite;
    const bool is_within = finite > 0 && std::exp(product / static_cast<double>(finite)) <= tolerance &&
                           all[all.size() / 2] <= tolerance && 20 * (all.size() - finite) <= all.size();
    if (is_within && 2 * all.size() >= most) largest = std::max(largest, dt);
  }
  return largest;
}

bool is_adaptive(const Results& results, std::size_t run) {
  for (const EngineInfo& engine : results.engines)
    if (engine.name == results.runs[run].engine) return method_of(engine, results.runs[run].settings).adaptive;
  return false;
}

std::vector<double> core_steps(const Results& results, double tolerance) {
  std::vector<double> steps;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    if (!is_core(results, run) || is_adaptive(results, run)) continue;
    if (const auto step = largest_step(results, run, tolerance)) steps.push_back(*step);
  }
  return steps;
}

// ---- equal cost ----------------------------------------------------------------------------------------------------

struct Point {
  double dt, error, cost;
};
std::vector<Point> points_of(const Results& results, const CaseResult& one, const std::string& run,
                             const std::string& name) {
  std::vector<Point> points;
  for (const Cell& cell : one.cells) {
    const MetricValue *error = metric(cell.metrics, name), *cost = metric(cell.metrics, "cost");
    const bool is_result = cell.status == Status::pass || cell.status == Status::fail ||
                           cell.status == Status::known_deviation || cell.status == Status::unexpected_pass;
    if (results.runs[cell.run].text != run || !error || !cost || !is_result || !(cost->value > 0)) continue;
    if (!std::isfinite(error->value)) continue;
    const double truth = one.truth ? one.truth->error_at_end : 0;
    points.push_back({cell.dt.seconds, std::max({error->value, 1e-14, std::min(truth, 1e-6)}), cost->value});
  }
  return points;
}

// The error of a run where its curve has that cost, in logarithms.
double error_at(std::vector<Point> points, double cost) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.cost < b.cost; });
  if (cost >= points.back().cost) return points.back().error;
  if (points.size() == 1) return points[0].error;
  std::size_t i = 1;
  while (points[i].cost < cost) ++i;
  const Point &a = points[i - 1], &b = points[i];
  if (a.cost == b.cost) return std::min(a.error, b.error);
  const double share = (std::log(cost) - std::log(a.cost)) / (std::log(b.cost) - std::log(a.cost));
  return std::exp((1 - share) * std::log(a.error) + share * std::log(b.error));
}

// `part`: "METRIC BASELINE".
std::optional<std::pair<double, double>> at_equal_cost_of(const Results& results, const Claim& claim) {
  const std::size_t space = claim.part.find(' ');
  const std::string name = claim.part.substr(0, space), baseline = claim.part.substr(space + 1);
  const CaseResult* one = case_of(results, claim.of_case);
  const Cell* beside = cell_of(results, {"", claim.of_case, baseline, claim.dt});
  const auto points = points_of(results, *one, claim.of_run, name);
  if (!beside || points.empty()) return {};
  for (const Point& of_baseline : points_of(results, *one, baseline, name)) {
    if (of_baseline.dt != beside->dt.seconds) continue;
    const double error = error_at(points, of_baseline.cost);
    return std::pair{error, of_baseline.error / error};
  }
  return {};
}

// ---- one claim -----------------------------------------------------------------------------------------------------

std::optional<double> of_motions(const Results& results, const Claim& claim) {
  static const std::set<std::string> kOwn = {"spring frequency", "spring frequency times dt",     "damping",
                                             "inertia",          "damping times dt over inertia", "servo's kp",
                                             "servo's step",     "other overdamped elements",     "semi-implicit step",
                                             "energy growth"};
  if (!kOwn.contains(claim.quantity)) return {};
  const CaseResult* one = case_of(results, claim.of_case);
  if (!one) return kNone;
  const Motions motions = motions_of(one->definition.scene);
  const auto found = oscillator(motions, claim.part);
  if (!found) return kNone;
  double dt = 0;
  for (const StepSize& step : one->definition.dt)
    if (step.text == claim.dt) dt = step.seconds;
  const auto [w, c] = *found;
  if (claim.quantity == "spring frequency") return w;
  if (claim.quantity == "spring frequency times dt") return w * dt;
  if (claim.quantity == "semi-implicit step") return semi_implicit_step(w, c);
  if (claim.quantity == "energy growth") {
    const Cell* cell = cell_of(results, claim);
    if (!cell) return kNone;
    const RunName& run = results.runs[cell->run];
    const auto growth = energy_growth_of(run.engine == "core" ? run.settings.method : "", w, c, dt);
    return growth ? growth : claim.value;  // of other schemes no formula is at hand: the relation is checked alone
  }
  const std::size_t i = *element_named(motions, claim.part);
  if (claim.quantity == "damping") return motions.elements[i].c;
  if (claim.quantity == "servo's kp") return motions.elements[i].k;
  if (claim.quantity == "servo's step") return w * w * dt * dt + 2 * c * dt;
  if (claim.quantity == "inertia") return inertia_of(motions, i);
  if (claim.quantity == "damping times dt over inertia") return c * dt;
  double others = -1;
  for (std::size_t k = 0; k < motions.elements.size(); ++k)
    others +=
        !motions.elements[k].name.starts_with("the servo") && motions.elements[k].c / inertia_of(motions, k) * dt > 2;
  return others;
}

// Metrics of one cell, behind their prefixes.
// By the t of the trials' number, which this table has for the numbers in tests.
double end_of_difference(const Results& results, const Claim& claim, const Cell& cell, const std::string& name) {
  static const std::map<std::size_t, double> kT = {{2, 12.7062}, {3, 4.30265}, {4, 3.18245}, {10, 2.26216}};
  const CaseResult* one = case_of(results, claim.of_case);
  for (const Cell& than : one->cells) {
    if (claim.part != fmt::format("{} at {}", results.runs[than.run].text, than.dt.text)) continue;
    const std::vector<TrialResult> a = trials_of(cell), b = trials_of(than);
    const double n = static_cast<double>(a.size());
    double sum = 0, squares = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double d = a[k].metrics.at(name) - b[k].metrics.at(name);
      sum += d, squares += d * d;
    }
    const double mean = sum / n, half = kT.at(a.size()) * std::sqrt((squares / n - mean * mean) / (n - 1));
    const bool is_less = mean + half < 0, is_low = claim.quantity.starts_with("low");
    return is_less ? -(mean + (is_low ? half : -half)) : mean + (is_low ? -half : half);
  }
  return kNone;
}

std::optional<double> of_cell(const Results& results, const Claim& claim) {
  const Cell* cell = cell_of(results, claim);
  if (!cell) return {};
  std::string name = claim.quantity;
  const auto is = [&](const std::string& prefix) {
    if (!name.starts_with(prefix)) return false;
    name.erase(0, prefix.size());
    return true;
  };
  if (is("low end of the difference of ") || is("high end of the difference of "))
    return end_of_difference(results, claim, *cell, name);
  if (is("signed ")) return value_in(cell->metrics, name, true);
  if (is("first second of ")) return metric(cell->metrics, name) ? metric(cell->metrics, name)->first_second : kNone;
  if (is("worst found of ")) return metric(cell->metrics, name) ? metric(cell->metrics, name)->worst.found : kNone;
  if (is("worst expected of "))
    return metric(cell->metrics, name) ? metric(cell->metrics, name)->worst.expected : kNone;
  if (is("error of ")) {
    const CaseResult* one = case_of(results, claim.of_case);
    for (const Point& point : points_of(results, *one, claim.of_run, name))
      if (point.dt == cell->dt.seconds) return point.error;
    return kNone;
  }
  if (is("scheme's share of ")) return value_in(cell->scheme.metrics, name, true) / value_in(cell->metrics, name, true);
  if (is("scheme's ")) {
    const std::string suffix = " without gyroscopic term";
    if (!name.ends_with(suffix)) return value_in(cell->scheme.metrics, name, true);
    return value_in(cell->scheme.without_gyroscopic_term, name.substr(0, name.size() - suffix.size()), false);
  }
  if (is("count of ")) {
    if (cell->metrics.empty()) return 0.0;
    return static_cast<double>(word_of(cell->stability.verdict) == name);
  }
  if (is("order of ")) {
    std::vector<std::pair<double, double>> points;
    const CaseResult* one = case_of(results, claim.of_case);
    for (const Cell& other : one->cells) {
      const double value = value_in(other.metrics, name, false);
      if (other.run == cell->run && !blown(other) && !std::isnan(value)) points.emplace_back(other.dt.seconds, value);
    }
    std::sort(points.begin(), points.end());
    return std::log(points[1].second / points[0].second) / std::log(points[1].first / points[0].first);
  }
  if (name == "singular position reported") {
    return static_cast<double>(std::any_of(cell->settings.begin(), cell->settings.end(),
                                           [](const auto& setting) { return setting.first == "singular positions"; }));
  }
  if (name == "cost of a step") return value_in(cell->metrics, "cost", false) * cell->dt.seconds;
  if (metric(cell->metrics, name)) return value_in(cell->metrics, name, false);
  double share = kNone;  // that the engine says a step closes
  for (const auto& [setting, words] : cell->settings)
    if (setting == "erp") share = std::strtod(words.c_str(), nullptr);
  if (name == "gap closed by one step") return share;
  if (name == "steps that stand") return 1 / share;
  if (name == "gap opened by one step") return share * value_in(cell->metrics, "joint_gap", false);
  return {};
}

// A claim about the distances at this step between the first run of each engine. Runs that blew up have none.
std::optional<double> distance_of_runs(const Results& results, const CaseResult& one, const Claim& claim) {
  std::map<std::string, std::string> first_of;  // by engine
  std::map<std::pair<std::string, std::string>, double> all;
  const auto stays = [&](std::size_t run) {
    const Cell* cell = cell_of(results, {"", claim.of_case, results.runs[run].text, claim.dt});
    return cell && !cell->metrics.empty() && !blown(*cell);
  };
  if (claim.quantity == "change to the finest step") {
    for (const Spread& spread : one.spreads) {
      const bool is_own = spread.first == spread.second && results.runs[spread.first].text == claim.of_run;
      if (is_own && spread.dt.text == claim.dt) return spread.distance.value;
    }
    return {};
  }
  for (const Spread& spread : one.spreads) {
    if (spread.first == spread.second || spread.dt.text != claim.dt || !stays(spread.first) || !stays(spread.second))
      continue;
    const std::string &a = results.runs[spread.first].text, &b = results.runs[spread.second].text;
    all[{a, b}] = all[{b, a}] = spread.distance.value;
  }
  for (const RunName& run : results.runs) {
    const bool is_there =
        std::any_of(all.begin(), all.end(), [&](const auto& row) { return row.first.first == run.text; });
    if (is_there) first_of.try_emplace(run.engine, run.text);
  }
  if (claim.quantity == "distance between runs") return all.at({claim.of_run, claim.part});
  if (claim.quantity == "engines compared") return static_cast<double>(first_of.size());
  if (claim.quantity != "distance of the nearest") return {};
  double nearest = HUGE_VAL;
  const auto voice = [](const std::string& run) { return run.substr(0, 6) == "mujoco"; };  // MuJoCo 3 is no other
  for (const auto& [engine, other] : first_of) {
    const bool is_same_voice = other == claim.of_run || (voice(other) && voice(claim.of_run));
    if (!is_same_voice) nearest = std::min(nearest, all.at({claim.of_run, other}));
  }
  return nearest;
}

std::optional<double> of_case(const Results& results, const Claim& claim) {
  const CaseResult* one = case_of(results, claim.of_case);
  if (!one) return {};
  const Scene& scene = one->definition.scene;
  if (claim.quantity == "missed fall") {
    for (const StepSize& dt : one->definition.dt)
      if (dt.text == claim.dt) return scene.gravity.norm() / 2 * dt.seconds;
  }
  if (claim.quantity == "duration") return one->definition.duration;
  if (claim.quantity == "trials")
    return one->definition.recording ? static_cast<double>(one->definition.recording->trials.size()) : kNone;
  if (claim.quantity == "ensemble starts") return one->definition.ensemble;
  if (const auto distance = distance_of_runs(results, *one, claim)) return distance;
  if (claim.quantity == "joints in a row") return joints_in_a_row_of(scene);
  if (claim.quantity == "mass ratio") return mass_ratio_of(scene);
  if (claim.quantity == "joint size") return joint_size(scene);
  if (claim.quantity == "shortened search") {
    for (std::size_t run = 0; run < results.runs.size(); ++run)
      if (results.runs[run].text == claim.of_run) return !one->stable_steps[run].step.cut.empty();
  }
  return {};
}

double worst_gap_of(const Results& results, const Claim& claim, bool over_size) {
  double worst = 0, gap = kNone;
  std::string where;
  each_cell(results, claim.dt, [&](const CaseResult& one, const Cell& cell) {
    const double value = value_in(cell.metrics, "joint_gap", false);
    if (results.runs[cell.run].text != claim.of_run || blown(cell) || std::isnan(value)) return;
    const double ratio = value / joint_size(one.definition.scene);
    if (ratio > worst) worst = ratio, gap = value, where = one.definition.id;
  });
  return over_size ? worst : where == claim.of_case ? gap : kNone;
}

std::optional<double> of_all(const Results& results, const Claim& claim) {
  const std::string& what = claim.quantity;
  const auto blew_up = [](const CaseResult&, const Cell& cell) { return blown(cell); };
  if (what == "worst energy loss") return worst_energy(results, claim, true);
  if (what == "worst energy gain") return worst_energy(results, claim, false);
  if (what == "worst sampling") return worst_sampling(results, claim);
  if (what == "largest unexplained_error") return largest_unexplained(results, claim);
  if (what == "worst joint gap over size") return worst_gap_of(results, claim, true);
  if (what == "worst joint gap") return worst_gap_of(results, claim, false);
  if (what == "cells that blew up") return count_cells(results, claim, blew_up);
  if (what == "cells that ran") return count_cells(results, claim, [](const auto&, const auto&) { return true; });
  if (what == "stiff cells that blew up")
    return count_cells(results, claim,
                       [](const auto& one, const auto& cell) { return blown(cell) && has_stiff_springs(one, cell); });
  if (what == "stiff cells that ran") return count_cells(results, claim, has_stiff_springs);
  if (what == "stiff cells that are not stable")
    return count_cells(results, claim, [](const auto& one, const auto& cell) {
      return has_stiff_springs(one, cell) && cell.stability.verdict != Verdict::stable && !blown(cell);
    });
  if (what == "cells with a twin") {
    double count = 0;
    each_cell(results, claim.dt, [&](const CaseResult&, const Cell& cell) {
      count += !cell.scheme.twin.empty() && !blown(cell) && metric(cell.metrics, "unexplained_error") != nullptr;
    });
    return count;
  }
  if (what == "worst friction_anisotropy") {
    double worst = kNone;
    each_cell(results, claim.dt, [&](const CaseResult&, const Cell& cell) {
      const double value = value_in(cell.metrics, "friction_anisotropy", false);
      if (results.runs[cell.run].text == claim.of_run && !blown(cell) && !std::isnan(value) && !(value <= worst))
        worst = value;
    });
    return worst;
  }
  if (what.starts_with("core methods: ")) return core_methods(results, what.substr(14));
  if (what.starts_with("core methods in all: ")) return core_methods_in_all(results, what.substr(21));
  if (what == "core methods whose joints hold") {
    double count = 0;
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
      Claim of_run = claim;
      of_run.of_run = results.runs[run].text;
      bool has_gap = false;
      each_cell(results, claim.dt, [&](const CaseResult&, const Cell& cell) {
        has_gap |= cell.run == run && !blown(cell) && metric(cell.metrics, "joint_gap");
      });
      count += is_core(results, run) && has_gap && worst_gap_of(results, of_run, true) <= 1e-6;
    }
    return count;
  }
  if (what == "runs beyond the named: joints" || what == "runs beyond the named: friction") {
    double count = -6;
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
      Claim of_run = claim;
      of_run.of_run = results.runs[run].text;
      count += worst_gap_of(results, of_run, true) > 1e-6;
    }
    return count;
  }
  const double tolerance = claim.part.empty() ? 0 : std::strtod(claim.part.c_str(), nullptr);
  if (what == "largest step for a tolerance") {
    for (std::size_t run = 0; run < results.runs.size(); ++run)
      if (results.runs[run].text == claim.of_run) return largest_step(results, run, tolerance);
  }
  if (what == "core methods with an error") return static_cast<double>(core_steps(results, tolerance).size());
  if (what == "core methods that share the best step, not named") {
    const auto steps = core_steps(results, tolerance);
    const double best = *std::max_element(steps.begin(), steps.end());
    return static_cast<double>(
               std::count_if(steps.begin(), steps.end(), [&](double s) { return s > best * (1 - 1e-9); })) -
           3;
  }
  if (what == "error at equal cost" || what == "times less at equal cost") {
    const auto found = at_equal_cost_of(results, claim);
    if (found) return what.starts_with("error") ? found->first : found->second;
  }
  return {};
}

}  // namespace

std::optional<double> recomputed(const Results& results, const Claim& claim) {
  for (const auto& of : {of_all, of_motions, of_case, of_cell})
    if (const auto value = of(results, claim)) return value;
  return {};
}

std::vector<std::string> errors_of(const Results& results, const Message& message) {
  // Differences of 1e-6, a pseudo-inverse, and growth measured with 1e-8 of rounding; metrics agree to rounding.
  constexpr double kDifferences = 5e-4, kPrinted = 0.06;  // two digits: at worst 5 % at 1.0, half a unit
  std::vector<std::string> errors;
  const auto fail = [&](const Claim& claim, const std::string& what) {
    errors.push_back(fmt::format("\"{}\": {} of {} {} {} {}: {}", message.text, claim.quantity, claim.of_case,
                                 claim.of_run, claim.dt, claim.part, what));
  };
  std::multiset<std::string> printed;
  for (const Claim& claim : message.claims) {
    const auto value = recomputed(results, claim);
    if (!value)
      fail(claim, "is unknown to the oracle");
    else if (!(std::abs(*value - claim.value) <= kDifferences * std::abs(claim.value) + 1e-300))
      fail(claim, fmt::format("is {}, not {}", *value, claim.value));
    if (!holds(claim)) fail(claim, fmt::format("{} is not {} {}", claim.value, word_of(claim.relation), claim.bound));
    if (claim.printed.empty()) continue;
    if (message.text.find(claim.printed) == std::string::npos && message.more.find(claim.printed) == std::string::npos)
      fail(claim, fmt::format("{} is not in the text", claim.printed));
    if (!(std::abs(printed_value(claim.quantity, claim.printed) - claim.value) <= kPrinted * std::abs(claim.value)))
      fail(claim, fmt::format("{} is printed as {}", claim.value, claim.printed));
    for (const std::string& number : numbers_in(claim.printed)) printed.insert(number);
  }
  for (const std::string& number : numbers_in(without_names(results, message.text))) {
    const auto at = printed.find(number);
    if (at == printed.end()) errors.push_back(fmt::format("\"{}\": no claim states {}", message.text, number));
  }
  return errors;
}

std::vector<std::string> errors_of_all_messages(const Results& results) {
  std::vector<std::string> errors;
  const auto add = [&](const std::vector<Message>& messages) {
    for (const Message& message : messages) {
      for (std::string& error : errors_of(results, message)) errors.push_back(std::move(error));
    }
  };
  add(findings(results));
  for (const CaseResult& one : results.cases)
    add(explanations(results, one)), add(work_precision_messages(results, one));
  return errors;
}

}  // namespace rigor::test
