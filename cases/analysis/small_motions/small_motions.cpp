#include "cases/analysis/small_motions/small_motions.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/metrics/measures/joints/joint_geometry.h"

namespace rigor {
namespace {

using DenseMatrix = Eigen::MatrixXd;
using RateRow = Eigen::RowVectorXd;

// Rows that take all bodies' velocities (linear, then angular, in W) to the rate of a coordinate.
class VelocityRows {
 public:
  explicit VelocityRows(const Scene& scene) : scene_(scene) {}

  Eigen::Index columns() const { return 6 * static_cast<Eigen::Index>(scene_.bodies.size()); }

  // Adds `factor` times the rate along `direction` of the point at `arm` [m, in W] from the body's centre.
  void add_point(RateRow& row, int body, const Vec3& arm, const Vec3& direction) const {
    if (!moves(body)) return;
    row.segment<3>(6 * body) += direction.transpose();
    row.segment<3>(6 * body + 3) += arm.cross(direction).transpose();
  }
  void add_turn(RateRow& row, int body, const Vec3& direction) const {
    if (moves(body)) row.segment<3>(6 * body + 3) += direction.transpose();
  }
  RateRow point_row(int a, const Vec3& arm_a, int b, const Vec3& arm_b, const Vec3& direction) const {
    RateRow row = RateRow::Zero(columns());
    add_point(row, a, arm_a, -direction), add_point(row, b, arm_b, direction);
    return row;
  }
  RateRow turn_row(int a, int b, const Vec3& direction) const {
    RateRow row = RateRow::Zero(columns());
    add_turn(row, a, -direction), add_turn(row, b, direction);
    return row;
  }
  bool moves(int body) const { return body != kWorld && !scene_.bodies[static_cast<std::size_t>(body)].fixed; }
  Vec3 centre(int body) const { return scene_.pose(body).position; }

 private:
  const Scene& scene_;
};

// Two directions that complete the axis to a frame.
std::pair<Vec3, Vec3> across(const Vec3& axis) {
  Vec3::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Vec3 first = axis.cross(Vec3::Unit(least)).normalized();
  return {first, axis.cross(first)};
}

void add_held_rows(const Scene& scene, const Joint& joint, const VelocityRows& rows, std::vector<RateRow>& held) {
  const JointGeometry geometry(scene, joint);
  const BodyPose a = scene.pose(joint.a), b = scene.pose(joint.b);
  const Vec3 arm_b = b.orientation * geometry.b().point, place = b.position + arm_b;
  const Vec3 arm_a = place - a.position;  // of the point of a that lies there
  const auto hold_point = [&](const Vec3& direction) {
    held.push_back(rows.point_row(joint.a, arm_a, joint.b, arm_b, direction));
  };
  const auto hold_turn = [&](const Vec3& direction) { held.push_back(rows.turn_row(joint.a, joint.b, direction)); };
  if (std::holds_alternative<DistanceJoint>(joint.type)) {
    const Vec3 own_arm = a.orientation * geometry.a().point;
    const Vec3 line = (place - a.position - own_arm).normalized();
    held.push_back(rows.point_row(joint.a, own_arm, joint.b, arm_b, line));
    return;
  }
  const Vec3 axis = a.orientation * geometry.a().axis;
  if (std::holds_alternative<SliderJoint>(joint.type)) {
    const auto [u, v] = across(axis);
    hold_point(u), hold_point(v);
  } else {
    for (int k = 0; k < 3; ++k) hold_point(Vec3::Unit(k));
  }
  if (std::holds_alternative<HingeJoint>(joint.type)) {
    const auto [u, v] = across(axis);
    hold_turn(u), hold_turn(v);
  } else if (std::holds_alternative<UniversalJoint>(joint.type)) {
    hold_turn(axis.cross(b.orientation * geometry.b().axis).normalized());
  } else if (!std::holds_alternative<BallJoint>(joint.type)) {
    for (int k = 0; k < 3; ++k) hold_turn(Vec3::Unit(k));
  }
}

// M^-1/2 of each body, in W, as blocks of six.
DenseMatrix inverse_root_masses(const Scene& scene, const VelocityRows& rows) {
  DenseMatrix root = DenseMatrix::Zero(rows.columns(), rows.columns());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const auto at = 6 * static_cast<Eigen::Index>(i);
    if (body.fixed) continue;
    const Mat3 R = body.orientation.toRotationMatrix(), inertia = R * body.inertia * R.transpose();
    root.block<3, 3>(at, at) = Mat3::Identity() / std::sqrt(body.mass);
    root.block<3, 3>(at + 3, at + 3) = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).operatorInverseSqrt();
  }
  return root;
}

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
         spring.stiffness, spring.damping});
    found.rows.push_back(rows.point_row(spring.a, arm_a, spring.b, arm_b, line.normalized()));
  }
  const auto add_on_joint = [&](std::size_t i, const std::string& name, double stiffness, double damping, bool servo) {
    const Joint& joint = scene.joints[i];
    const Vec3* axis = free_axis(joint);
    if (!axis || (stiffness == 0 && damping == 0)) return;
    const bool is_hinge = std::holds_alternative<HingeJoint>(joint.type);
    found.elements.push_back(
        {is_hinge ? ForceElement::Kind::hinge : ForceElement::Kind::slider, name, stiffness, damping, servo});
    const Vec3 to_b = rows.centre(joint.b) - rows.centre(joint.a);
    found.rows.push_back(is_hinge ? rows.turn_row(joint.a, joint.b, *axis)
                                  : rows.point_row(joint.a, to_b, joint.b, Vec3::Zero(), *axis));
  };
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    add_on_joint(i, scene.joint_name(i), scene.joints[i].stiffness, scene.joints[i].damping, false);
  for (const Motor& motor : scene.motors) {
    const auto i = static_cast<std::size_t>(motor.joint);
    // A sampled servo holds its effort for its period, at any dt.
    if (motor.servo && motor.servo->period == 0)
      add_on_joint(i, fmt::format("the servo of {}", scene.joint_name(i)), motor.servo->kp, motor.servo->kd, true);
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
  Eigen::ColPivHouseholderQR<DenseMatrix> qr(columns);
  qr.setThreshold(kRedundant);
  return qr.householderQ() * DenseMatrix::Identity(root.rows(), qr.rank());
}

}  // namespace

std::optional<SmallMotions> SmallMotions::of(const Scene& scene) {
  const bool is_known =
      scene.couplings.empty() && std::none_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) {
        return joint.armature > 0 || std::holds_alternative<CompoundJoint>(joint.type) ||
               std::holds_alternative<PlanarJoint>(joint.type) || std::holds_alternative<ScrewJoint>(joint.type);
      });
  if (!is_known) return {};
  constexpr std::size_t kMostElements = 300, kMostBodies = 150;  // dense algebra takes a tenth of a second
  const VelocityRows rows(scene);
  ElementRows found = elements_of(scene, rows);
  if (found.elements.empty() || found.elements.size() > kMostElements || scene.bodies.size() > kMostBodies) return {};
  const DenseMatrix root = inverse_root_masses(scene, rows);
  std::vector<RateRow> held;
  for (const Joint& joint : scene.joints) add_held_rows(scene, joint, rows, held);
  const DenseMatrix Q = held_directions(held, root);
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
  const Eigen::SelfAdjointEigenSolver<DenseMatrix> modes(root_stiffness.asDiagonal() * response *
                                                         root_stiffness.asDiagonal());
  const double squared = modes.eigenvalues()[count - 1];
  if (!(squared > 0)) return;
  const Eigen::VectorXd rates = response * (root_stiffness.cwiseProduct(modes.eigenvectors().col(count - 1)));
  stiffest_ = {std::sqrt(squared), rates.dot(damping.cwiseProduct(rates)) / squared};
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

}  // namespace rigor
