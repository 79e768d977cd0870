#include "cases/analysis/repeats/reordered_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>

namespace rigor::inline analysis {
namespace {

// A shuffle of its own, so that it is the same with every library.
std::vector<std::size_t> shuffled(std::size_t size, std::mt19937_64& random) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = size; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

// Of joints. The axes of a compound joint stay behind it.
std::vector<std::size_t> shuffled_joints(const std::vector<Joint>& joints, std::mt19937_64& random) {
  std::vector<std::size_t> firsts;
  for (std::size_t k = 0; k < joints.size(); ++k)
    if (!is_axis_of_compound(joints[k])) firsts.push_back(k);
  std::vector<std::size_t> order;
  for (const std::size_t first : shuffled(firsts.size(), random)) {
    std::size_t k = firsts[first];
    do order.push_back(k++);
    while (k < joints.size() && is_axis_of_compound(joints[k]));
  }
  return order;
}

template <typename Row>
std::vector<Row> in_order(const std::vector<Row>& rows, const std::vector<std::size_t>& order) {
  std::vector<Row> out;
  for (const std::size_t from : order) out.push_back(rows[from]);
  return out;
}

// places[from] of an order, which lists where each new row comes from.
std::vector<std::size_t> inverse_of(const std::vector<std::size_t>& order) {
  std::vector<std::size_t> places(order.size());
  for (std::size_t to = 0; to < order.size(); ++to) places[order[to]] = to;
  return places;
}

bool is_plane(const Body& body) { return body.shape && std::holds_alternative<Plane>(*body.shape); }

using Renumber = std::function<int(int)>;

void renumber_bodies(Scene& scene, const Renumber& number) {
  for (Joint& joint : scene.joints) joint.a = number(joint.a), joint.b = number(joint.b);
  for (Spring& spring : scene.springs) spring.a = number(spring.a), spring.b = number(spring.b);
  for (ContactPair& pair : scene.contact_pairs) pair.a = number(pair.a), pair.b = number(pair.b);
  for (TimedForce& force : scene.forces) force.body = number(force.body);
}

template <typename Row>
void append(std::vector<Row>& to, const std::vector<Row>& rows) {
  to.insert(to.end(), rows.begin(), rows.end());
}

}  // namespace

ReorderedScene reordered(const Scene& scene, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  ReorderedScene out{scene, {}};
  const auto bodies = shuffled(scene.bodies.size(), random), joints = shuffled_joints(scene.joints, random);
  out.places = inverse_of(bodies);
  renumber_bodies(out.scene, [&](int body) {
    return body == kWorld ? kWorld : static_cast<int>(out.places[static_cast<std::size_t>(body)]);
  });
  const std::vector<std::size_t> joint_places = inverse_of(joints);
  renumber_joints(out.scene,
                  [&](int joint) { return static_cast<int>(joint_places[static_cast<std::size_t>(joint)]); });
  out.scene.bodies = in_order(out.scene.bodies, bodies), out.scene.joints = in_order(out.scene.joints, joints);
  out.scene.springs = in_order(out.scene.springs, shuffled(scene.springs.size(), random));
  out.scene.couplings = in_order(out.scene.couplings, shuffled(scene.couplings.size(), random));
  out.scene.motors = in_order(out.scene.motors, shuffled(scene.motors.size(), random));
  out.scene.contact_pairs = in_order(out.scene.contact_pairs, shuffled(scene.contact_pairs.size(), random));
  out.scene.forces = in_order(out.scene.forces, shuffled(scene.forces.size(), random));
  return out;
}

Scene moved_scene(const Scene& scene, const Vec3& offset) {
  Scene out = scene;
  for (Body& body : out.bodies) {
    if (!is_plane(body)) body.position += offset;
  }
  for (Spring& spring : out.springs) {
    if (spring.a == kWorld) spring.point_a += offset;
    if (spring.b == kWorld) spring.point_b += offset;
  }
  for (Joint& joint : out.joints) {
    for_each_vector(joint.type, [&](const char*, JointVector kind, Vec3& vector) {
      const bool is_in_world = kind == JointVector::point || (kind == JointVector::point_of_a && joint.a == kWorld) ||
                               (kind == JointVector::point_of_b && joint.b == kWorld);
      if (is_in_world) vector += offset;
    });
  }
  return out;
}

std::optional<Vec3> free_direction(const Scene& scene) {
  std::vector<Vec3> normals;
  for (const Body& body : scene.bodies) {
    if (is_plane(body)) normals.push_back(std::get<Plane>(*body.shape).normal.normalized());
  }
  const auto is_free = [&](const Vec3& d) {
    return std::all_of(normals.begin(), normals.end(), [&](const Vec3& n) { return std::abs(n.dot(d)) < 1e-15; });
  };
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    if (is_free(axis)) return axis;
  }
  return {};
}

CopiedScene copied(const Scene& scene, std::size_t copies, const Vec3& offset) {
  CopiedScene out;
  out.scene = scene;
  out.places.emplace_back(scene.bodies.size());
  std::iota(out.places[0].begin(), out.places[0].end(), 0);
  for (std::size_t k = 1; k < copies; ++k) {
    Scene copy = moved_scene(scene, static_cast<double>(k) * offset);
    std::vector<std::size_t> places(scene.bodies.size());
    for (std::size_t i = 0; i < copy.bodies.size(); ++i) {
      places[i] = i;
      if (is_plane(copy.bodies[i])) continue;
      places[i] = out.scene.bodies.size();
      out.scene.bodies.push_back(copy.bodies[i]);
      out.scene.bodies.back().name += fmt::format("-{}", k);
    }
    renumber_bodies(copy, [&](int body) {
      return body == kWorld ? kWorld : static_cast<int>(places[static_cast<std::size_t>(body)]);
    });
    const int joints = static_cast<int>(out.scene.joints.size());
    renumber_joints(copy, [&](int joint) { return joint + joints; });
    for (Joint& joint : copy.joints) {
      if (!joint.name.empty()) joint.name += fmt::format("-{}", k);
    }
    append(out.scene.joints, copy.joints), append(out.scene.springs, copy.springs);
    append(out.scene.couplings, copy.couplings);
    append(out.scene.motors, copy.motors), append(out.scene.forces, copy.forces);
    append(out.scene.contact_pairs, copy.contact_pairs);
    out.places.push_back(std::move(places));
  }
  return out;
}

}  // namespace rigor::inline analysis
