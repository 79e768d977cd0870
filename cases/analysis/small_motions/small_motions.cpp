#include "cases/analysis/small_motions/small_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/eigen_of.h"
#include "core/dynamics/joints/joint_rows.h"

namespace rigor::inline analysis {
namespace {

using DenseMatrix = Eigen::MatrixXd;
using RateRow = Eigen::RowVectorXd;

// Rows that take all bodies' velocities (linear, then angular, in W) and the rotors' speeds to the rate of a
// coordinate.
class VelocityRows {
 public:
  explicit VelocityRows(const Scene& scene) : scene_(scene), start_(scene.bodies.size()) {
    set_initial_state(scene, start_.columns());
    for (std::size_t k = 0; k < scene.joints.size(); ++k)
      if (scene.joints[k].armature > 0) rotors_.push_back(k);
  }

  Eigen::Index columns() const { return 6 * bodies() + static_cast<Eigen::Index>(rotors_.size()); }

  // Of a spring's length.
  RateRow spring_row(const Spring& spring, const Vec3& arm_a, const Vec3& arm_b, const Vec3& direction) const {
    RateRow row = RateRow::Zero(columns());
    add(row, spring.a, -direction, -arm_a.cross(direction)), add(row, spring.b, direction, arm_b.cross(direction));
    return row;
  }
  // Of a joint's free coordinate.
  RateRow coordinate_row(const Joint& joint) const {
    const JointCoordinate::Value at = JointCoordinate(scene_, joint).at(start_.columns());
    RateRow row = RateRow::Zero(columns());
    add(row, joint.a, -at.force, at.torque_a), add(row, joint.b, at.force, at.torque_b);
    return row;
  }
  // The rates that joints, couplings and rotors hold at zero.
  std::vector<RateRow> held() const {
    const System system(scene_);
    JointRows joints(scene_, system);
    joints.evaluate(start_.columns());
    std::vector<RateRow> rows;
    for (const JointRow& joint : joints.joints()) {
      for (int k = 0; k < joint.rows; ++k) {
        RateRow& row = rows.emplace_back(RateRow::Zero(columns()));
        for (int end = 0; end < joint.ends; ++end) {
          const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6>> J(joint.J[end], joint.most_rows, 6);
          add(row, joint.end[end], J.row(k).head<3>(), J.row(k).tail<3>());
        }
      }
    }
    for (std::size_t r = 0; r < rotors_.size(); ++r) {
      rows.push_back(coordinate_row(scene_.joints[rotors_[r]]));
      rows.back()[6 * bodies() + static_cast<Eigen::Index>(r)] = -1;
    }
    return rows;
  }
  // M^-1/2, in W: blocks of six for bodies, then the rotors.
  DenseMatrix inverse_root_masses() const {
    DenseMatrix root = DenseMatrix::Zero(columns(), columns());
    for (Eigen::Index i = 0; i < bodies(); ++i) {
      const Body& body = scene_.bodies[static_cast<std::size_t>(i)];
      if (body.fixed) continue;
      const Mat3 R = body.orientation.toRotationMatrix(), inertia = R * body.inertia * R.transpose();
      root.block<3, 3>(6 * i, 6 * i) = Mat3::Identity() / std::sqrt(body.mass);
      const SymmetricEigen principal = eigen_of(inertia);
      const Vec3 roots = principal.values.cwiseSqrt().cwiseInverse();
      root.block<3, 3>(6 * i + 3, 6 * i + 3) = principal.vectors * roots.asDiagonal() * principal.vectors.transpose();
    }
    for (std::size_t r = 0; r < rotors_.size(); ++r) {
      const Eigen::Index at = 6 * bodies() + static_cast<Eigen::Index>(r);
      root(at, at) = 1 / std::sqrt(scene_.joints[rotors_[r]].armature);
    }
    return root;
  }
  Vec3 centre(int body) const { return scene_.pose(body).position; }

 private:
  Eigen::Index bodies() const { return static_cast<Eigen::Index>(scene_.bodies.size()); }
  void add(RateRow& row, int body, const Vec3& linear, const Vec3& angular) const {
    if (body == kWorld || scene_.bodies[static_cast<std::size_t>(body)].fixed) return;
    row.segment<3>(6 * body) += linear.transpose(), row.segment<3>(6 * body + 3) += angular.transpose();
  }

  const Scene& scene_;
  BodyTable start_;
  std::vector<std::size_t> rotors_;  // the joints that have one
};

struct ElementRows {
  std::vector<ForceElement> elements;
  std::vector<RateRow> rows;
};

ElementRows elements_of(const Scene& scene, const VelocityRows& rows) {
  ElementRows found;
  for (const Spring& spring : scene.springs) {
    if (spring.stiffness == 0 && spring.damping == 0) continue;
    const Vec3 arm_a = scene.pose(spring.a).orientation * spring.point_a,
               arm_b = scene.pose(spring.b).orientation * spring.point_b;
    const Vec3 line = rows.centre(spring.b) + arm_b - rows.centre(spring.a) - arm_a;
    if (line.isZero(0)) continue;
    found.elements.push_back(
        {ForceElement::Kind::spring,
         fmt::format("the spring of '{}' and '{}'", scene.body_name(spring.a), scene.body_name(spring.b)),
         stiffness_at(spring, scene.extension_at_start(spring)), spring.damping});
    found.rows.push_back(rows.spring_row(spring, arm_a, arm_b, line.normalized()));
  }
  const auto add_on_joint = [&](std::size_t i, const std::string& name, double stiffness, double damping, bool servo) {
    const Joint& joint = scene.joints[i];
    if (!free_axis(joint) || (stiffness == 0 && damping == 0)) return;
    const auto kind = turns(joint) ? ForceElement::Kind::hinge : ForceElement::Kind::slider;
    found.elements.push_back({kind, name, stiffness, damping, servo});
    found.rows.push_back(rows.coordinate_row(joint));
  };
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    add_on_joint(i, scene.joint_name(i), stiffness_at(scene.joints[i], scene.joints[i].rest), scene.joints[i].damping,
                 false);
  for (const Motor& motor : scene.motors) {
    const auto i = static_cast<std::size_t>(motor.joint);
    // A sampled servo holds its effort for its period, at any dt.
    if (motor.servo && motor.servo->period == 0)
      add_on_joint(i, fmt::format("the servo of {}{}", scene.joint_name(i), motor.plus.empty() ? "" : " and others"),
                   motor.servo->kp, motor.servo->kd, true);
    for (const JointTerm& term : motor.plus)
      found.rows.back() += term.ratio * rows.coordinate_row(scene.joints[static_cast<std::size_t>(term.joint)]);
  }
  return found;
}

// Directions of M^1/2 v that joints hold, orthonormal; as columns.
DenseMatrix held_directions(const std::vector<RateRow>& held, const DenseMatrix& root) {
  constexpr double kRedundant = 1e-9;  // of the largest: rows of closed loops repeat each other to rounding
  if (held.empty()) return DenseMatrix(root.rows(), 0);
  DenseMatrix columns(root.rows(), static_cast<Eigen::Index>(held.size()));
  for (std::size_t k = 0; k < held.size(); ++k) {
    const Eigen::VectorXd column = root * held[k].transpose();
    columns.col(static_cast<Eigen::Index>(k)) = column.norm() > 0 ? Eigen::VectorXd(column.normalized()) : column;
  }
  return basis_of(columns, kRedundant);
}

}  // namespace

std::optional<SmallMotions> SmallMotions::of(const Scene& scene) {
  constexpr std::size_t kMostElements = 300, kMostBodies = 150;  // dense algebra takes a tenth of a second
  const VelocityRows rows(scene);
  ElementRows found = elements_of(scene, rows);
  if (found.elements.empty() || found.elements.size() > kMostElements || scene.bodies.size() > kMostBodies) return {};
  const DenseMatrix root = rows.inverse_root_masses();
  const DenseMatrix Q = held_directions(rows.held(), root);
  DenseMatrix G(static_cast<Eigen::Index>(found.rows.size()), rows.columns());
  for (std::size_t i = 0; i < found.rows.size(); ++i) G.row(static_cast<Eigen::Index>(i)) = found.rows[i] * root;
  G -= (G * Q) * Q.transpose();
  const DenseMatrix response = G * G.transpose();  // accelerations of the coordinates by unit forces along them
  SmallMotions motions;
  motions.elements_ = std::move(found.elements);
  for (std::size_t i = 0; i < motions.elements_.size(); ++i) {
    const double own = response(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
    motions.elements_[i].inertia = own > 0 ? 1 / own : std::numeric_limits<double>::infinity();
  }
  motions.find_stiffest(response);
  return motions;
}

void SmallMotions::find_stiffest(const DenseMatrix& response) {
  const auto count = static_cast<Eigen::Index>(elements_.size());
  Eigen::VectorXd root_stiffness(count), damping(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    root_stiffness[i] = std::sqrt(elements_[static_cast<std::size_t>(i)].stiffness);
    damping[i] = elements_[static_cast<std::size_t>(i)].damping;
  }
  const DenseMatrix scaled = root_stiffness.asDiagonal() * response * root_stiffness.asDiagonal();
  const DenseEigen modes = dense_eigen_of(scaled);
  const double squared = modes.values[count - 1];
  if (!(squared > 0)) return;
  const Eigen::VectorXd rates = response * (root_stiffness.cwiseProduct(modes.vectors.col(count - 1)));
  stiffest_ = {std::sqrt(squared), rates.dot(damping.cwiseProduct(rates)) / squared};
}

const ForceElement& SmallMotions::stiffest_element() const {
  return *std::max_element(elements_.begin(), elements_.end(), [](const ForceElement& a, const ForceElement& b) {
    return a.stiffness / a.inertia < b.stiffness / b.inertia;
  });
}

const ForceElement* SmallMotions::most_damped() const {
  const ForceElement* most = nullptr;
  for (const ForceElement& element : elements_) {
    if (element.is_servo || !(element.damping_rate() > 0)) continue;
    if (!most || element.damping_rate() > most->damping_rate()) most = &element;
  }
  return most;
}

const ForceElement* SmallMotions::stiffest_servo() const {
  const ForceElement* most = nullptr;
  for (const ForceElement& element : elements_) {
    if (!element.is_servo) continue;
    if (!most || largest_semi_implicit_step(alone(element)) < largest_semi_implicit_step(alone(*most))) most = &element;
  }
  return most;
}

Oscillator SmallMotions::alone(const ForceElement& element) {
  return {std::sqrt(element.stiffness / element.inertia), element.damping_rate()};
}

double largest_semi_implicit_step(const Oscillator& oscillator) {
  const double w2 = oscillator.frequency * oscillator.frequency, rate = oscillator.rate;
  if (w2 == 0) return rate > 0 ? 2 / rate : std::numeric_limits<double>::infinity();
  return 4 / (rate + std::sqrt(rate * rate + 4 * w2));  // the root of w2 dt² + 2 rate dt = 4, without cancellation
}

}  // namespace rigor::inline analysis
