#include "tests/relations/relations.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>

namespace rigor::test {
namespace {

using Made = std::optional<Related>;

Related by(const Scene& scene, const Equivalence& how) { return {.scene = equivalent(scene, how), .how = how}; }

Related in_units(const Scene& scene, double length, double time, double mass) {
  Equivalence how;
  how.length = length, how.time = time, how.mass = mass;
  return by(scene, how);
}

bool is_tied_to_world(const Scene& scene) {
  const auto ends_in_world = [](const auto& row) { return row.a == kWorld || row.b == kWorld; };
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) { return body.fixed; }) ||
         std::any_of(scene.springs.begin(), scene.springs.end(), ends_in_world) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), ends_in_world);
}

Made moved(const Original& original, Random& random) {
  Related made{.scene = original.scene, .shift = random.vector(8)};
  for (Body& body : made.scene.bodies) {
    body.position += made.shift;
    if (!body.shape) continue;
    if (auto* plane = std::get_if<Plane>(&*body.shape)) plane->offset += plane->normal.dot(made.shift);
  }
  for (Spring& spring : made.scene.springs) {
    if (spring.a == kWorld) spring.point_a += made.shift;
    if (spring.b == kWorld) spring.point_b += made.shift;
  }
  for (Joint& joint : made.scene.joints) {
    for_each_vector(joint.type, [&](const char*, JointVector kind, Vec3& vector) {
      const bool is_in_world = kind == JointVector::point || (kind == JointVector::point_of_a && joint.a == kWorld) ||
                               (kind == JointVector::point_of_b && joint.b == kWorld);
      if (is_in_world) vector += made.shift;
    });
  }
  return made;
}

Made boosted(const Original& original, Random& random) {
  if (is_tied_to_world(original.scene)) return {};
  Related made{.scene = original.scene, .velocity = random.vector(3)};
  for (Body& body : made.scene.bodies) body.velocity += made.velocity;
  return made;
}

std::vector<std::size_t> any_order(std::size_t count, Random& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
  return order;
}

template <typename Row>
void put_in_order(std::vector<Row>& rows, const std::vector<std::size_t>& order) {
  const std::vector<Row> before = rows;
  for (std::size_t i = 0; i < rows.size(); ++i) rows[order[i]] = before[i];
}

// The axes of a compound joint stay behind it.
std::vector<std::size_t> any_order_of_joints(const Scene& scene, Random& random) {
  std::vector<std::size_t> heads;
  for (std::size_t k = 0; k < scene.joints.size(); ++k)
    if (!is_axis_of_compound(scene.joints[k])) heads.push_back(k);
  const std::vector<std::size_t> places = any_order(heads.size(), random);
  std::vector<std::size_t> in_turn(heads.size()), order(scene.joints.size());
  for (std::size_t i = 0; i < heads.size(); ++i) in_turn[places[i]] = heads[i];
  std::size_t next = 0;
  for (std::size_t k : in_turn) {
    order[k] = next++;
    while (++k < scene.joints.size() && is_axis_of_compound(scene.joints[k])) order[k] = next++;
  }
  return order;
}

// Bodies, springs, joints, couplings, motors and forces in another order, and with other names.
Made shuffled(const Original& original, Random& random) {
  Related made{.scene = original.scene};
  Scene& scene = made.scene;
  made.rows = any_order(scene.bodies.size(), random);
  const auto move = [&](int& body) {
    if (body != kWorld) body = static_cast<int>(made.rows[static_cast<std::size_t>(body)]);
  };
  put_in_order(scene.bodies, made.rows);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].name = "body " + std::to_string(7 * i);
  for (Spring& spring : scene.springs) move(spring.a), move(spring.b);
  for (Joint& joint : scene.joints) move(joint.a), move(joint.b);
  for (ContactPair& pair : scene.contact_pairs) move(pair.a), move(pair.b);
  for (TimedForce& force : scene.forces) move(force.body);
  const std::vector<std::size_t> joints = any_order_of_joints(scene, random);
  put_in_order(scene.joints, joints);
  renumber_joints(scene, [&](int joint) { return static_cast<int>(joints[static_cast<std::size_t>(joint)]); });
  put_in_order(scene.springs, any_order(scene.springs.size(), random));
  put_in_order(scene.motors, any_order(scene.motors.size(), random));
  put_in_order(scene.forces, any_order(scene.forces.size(), random));
  return made;
}

// Too far away to touch anything.
Made with_far_body(const Original& original, Random& random) {
  Related made{.scene = original.scene};
  Body far;
  far.name = "far";
  far.mass = random.between(0.5, 2), far.inertia = Vec3(0.02, 0.03, 0.04).asDiagonal();
  if (std::any_of(made.scene.bodies.begin(), made.scene.bodies.end(), [](const Body& body) { return body.collides; }))
    far.shape = Sphere{0.1}, far.inertia = inertia_of(*far.shape, far.mass), far.collides = true;
  far.position = {60, -30, 40}, far.velocity = random.vector(1), far.angular_velocity = random.vector(2);
  made.rows.resize(original.scene.bodies.size());
  std::iota(made.rows.begin(), made.rows.end(), random.chance(0.5) ? std::size_t{0} : std::size_t{1});
  if (made.rows[0] == 0) {
    made.scene.bodies.push_back(far);
    return made;
  }
  made.scene.bodies.insert(made.scene.bodies.begin(), far);
  const auto move = [](int& body) {
    if (body != kWorld) ++body;
  };
  for (Spring& spring : made.scene.springs) move(spring.a), move(spring.b);
  for (Joint& joint : made.scene.joints) move(joint.a), move(joint.b);
  for (ContactPair& pair : made.scene.contact_pairs) move(pair.a), move(pair.b);
  for (TimedForce& force : made.scene.forces) move(force.body);
  return made;
}

// From a half's centre to the whole body's, in B, along the longest extent. A half has the covariance C/2 - m/2 s sT of
// the whole body's C. With 0.3 of the largest it stays positive, so that the halves are bodies of matter.
Vec3 half_offset(const Body& body) {
  const Mat3 covariance = 0.5 * body.inertia.trace() * Mat3::Identity() - body.inertia;
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(covariance);
  return std::sqrt(0.3 * axes.eigenvalues()[2] / body.mass) * axes.eigenvectors().col(2);
}

// The first half keeps the body's rows and its shape.
Made split(const Original& original, Random& random) {
  Related made{.scene = original.scene};
  Scene& scene = made.scene;
  std::vector<std::size_t> can_move;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (!scene.bodies[i].fixed) can_move.push_back(i);
  const std::size_t whole = random.one_of(can_move);
  Body& body = scene.bodies[whole];
  const Vec3 s = half_offset(body), arm = body.orientation * s;
  body.inertia =
      (0.5 * body.inertia - 0.5 * body.mass * (s.squaredNorm() * Mat3::Identity() - s * s.transpose())).eval();
  body.mass *= 0.5;
  Body other = body;
  other.name = body.name + ", other half", other.shape.reset(), other.collides = false;
  other.position += arm, other.velocity += body.angular_velocity.cross(arm);
  body.position -= arm, body.velocity -= body.angular_velocity.cross(arm);
  if (body.shape) body.shape = Compound{{{*body.shape, {s, Quat::Identity()}}}};
  const int i = static_cast<int>(whole);
  for (Spring& spring : scene.springs) {
    if (spring.a == i) spring.point_a += s;
    if (spring.b == i) spring.point_b += s;
  }
  for (Joint& joint : scene.joints) {
    for_each_vector(joint.type, [&](const char*, JointVector kind, Vec3& vector) {
      if ((kind == JointVector::point_of_a && joint.a == i) || (kind == JointVector::point_of_b && joint.b == i))
        vector += s;
    });
  }
  for (TimedForce& force : scene.forces)
    if (force.body == i) force.point += s;
  scene.bodies.push_back(other);
  scene.joints.push_back({.a = i, .b = static_cast<int>(scene.bodies.size()) - 1, .type = FixedJoint{}});
  made.offset = {whole, s};
  return made;
}

std::vector<BodyTable> until(const Original& original, std::size_t k) {
  return {original.states.begin(), original.states.begin() + static_cast<std::ptrdiff_t>(k) + 1};
}

Made from_half_time(const Original& original, Random&) {
  const std::size_t half = original.last() / 2;
  std::optional<Scene> scene =
      restarted(original.scene, until(original, half), static_cast<double>(half) * original.step);
  if (!scene) return {};
  return Related{.scene = std::move(*scene), .first = half};
}

Made back_in_time(const Original& original, Random&) {
  const std::size_t end = original.last();
  std::optional<Scene> scene = reversed(original.scene, original.states, static_cast<double>(end) * original.step);
  if (!scene) return {};
  return Related{.scene = std::move(*scene), .first = end, .runs_back = true};
}

Made turned_by_any(const Original& original, Random& random) {
  Equivalence how;
  how.turn = random.turn();
  return by(original.scene, how);
}

Made mirrored_in_x(const Original& original, Random&) {
  Equivalence how;
  how.is_mirrored = true;
  return by(original.scene, how);
}

Made in_any_units(const Original& original, Random& random) {
  return in_units(original.scene, random.log_between(0.1, 10), random.log_between(0.3, 4), random.log_between(0.1, 10));
}

double power_of_two(int most, Random& random) { return std::ldexp(1, random.below(2 * most + 1) - most); }

// Masses by a power of four: a factorisation takes their square roots.
Made in_binary_units(const Original& original, Random& random) {
  const double length = power_of_two(12, random), time = power_of_two(12, random), root = power_of_two(10, random);
  return in_units(original.scene, length, time, root * root);
}

}  // namespace

BodyTable Related::original(BodyColumns related, double t) const {
  BodyTable all(related.size());
  to_original(how, related, all.columns());
  if (rows.empty() && shift.isZero(0) && velocity.isZero(0) && !offset) return all;
  const std::size_t count = rows.empty() ? related.size() - (offset ? 1 : 0) : rows.size();
  BodyTable found(count);
  for (std::size_t i = 0; i < count; ++i) {
    BodyState body = std::as_const(all).columns().body(rows.empty() ? i : rows[i]);
    if (offset && offset->first == i) body.position += body.orientation * offset->second;
    body.position -= shift + t * velocity;
    found.columns().set_body(i, body);
  }
  return found;
}

const std::vector<Relation>& relations() {
  static const std::vector<Relation> rows = {
      {"other units", Keeps::steps, in_any_units},
      {"binary units", Keeps::bits, in_binary_units},
      {"mirrored", Keeps::steps, mirrored_in_x},
      {"turned", Keeps::steps, turned_by_any},
      {"moved", Keeps::steps, moved},
      {"boosted", Keeps::stretches, boosted},
      {"shuffled", Keeps::steps, shuffled},
      {"far body", Keeps::stretches, with_far_body},
      {"welded halves", Keeps::motion, split},
      {"restarted", Keeps::stretches, from_half_time},
      {"back in time", Keeps::stretches, back_in_time},
  };
  return rows;
}

}  // namespace rigor::test
