#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/mjcf/mjcf_import.h"
#include "core/base/error.h"

namespace rigor::inline adapters {
namespace {

using namespace mjcf;

constexpr double kClosed = 1e-6;  // m, rad: digits of a file that a person wrote
constexpr int kEqualityNumbers = 11;

struct FixedTendon {
  std::vector<std::pair<int, double>> joints;  // MuJoCo's, with their coefficients
};

bool is_fixed_tendon(const MjcfImport& import, int tendon) {
  return import.whole("wrap_type", import.whole("tendon_adr", tendon)) == kWrapJoint;
}

FixedTendon fixed_tendon(const MjcfImport& import, int tendon) {
  FixedTendon found;
  const int first = import.whole("tendon_adr", tendon), count = import.whole("tendon_num", tendon);
  for (int k = first; k < first + count; ++k)
    found.joints.emplace_back(import.whole("wrap_objid", k), import.value("wrap_prm", k));
  return found;
}

struct Ends {
  int a, b;
  Vec3 point_a, point_b;  // in the links' frames
};

// Between two sites and round nothing.
bool is_straight(const MjcfImport& import, int tendon) {
  const int first = import.whole("tendon_adr", tendon);
  return import.whole("tendon_num", tendon) == 2 && import.whole("wrap_type", first) == kWrapSite &&
         import.whole("wrap_type", first + 1) == kWrapSite;
}

Ends ends_of(const MjcfImport& import, int tendon) {
  const int first = import.whole("tendon_adr", tendon);
  const int a = import.whole("wrap_objid", first), b = import.whole("wrap_objid", first + 1);
  return {MjcfImport::link_of(import.whole("site_bodyid", a)), MjcfImport::link_of(import.whole("site_bodyid", b)),
          import.vector("site_pos", a), import.vector("site_pos", b)};
}

// The frames that a connection or a weld holds together, one of each body: of sites, or of points in bodies.
struct Held {
  int a, b;  // MuJoCo's bodies
  BodyPose in_a, in_b;
};

Held held_by(const MjcfImport& import, int k) {
  const int first = import.whole("eq_obj1id", k), second = import.whole("eq_obj2id", k);
  if (import.whole("eq_objtype", k) == kObjectSite) {
    const auto site = [&](int id) { return BodyPose{import.vector("site_pos", id), Quat::Identity()}; };
    return {import.whole("site_bodyid", first), import.whole("site_bodyid", second), site(first), site(second)};
  }
  const auto data = [&](int i) { return import.value("eq_data", kEqualityNumbers * k + i); };
  const Vec3 one(data(0), data(1), data(2)), other(data(3), data(4), data(5));
  if (import.whole("eq_type", k) == kConnect) return {first, second, {one, {}}, {other, {}}};
  const Quat turn(data(6), data(7), data(8), data(9));
  return {first, second, {other, turn.normalized()}, {one, Quat::Identity()}};
}

// How far the two are apart at the start, m or rad.
double opening_of(const MjcfImport& import, int k, const Held& held) {
  const BodyPose one = import.pose_of(held.a) * held.in_a, other = import.pose_of(held.b) * held.in_b;
  const double gap = (one.position - other.position).norm();
  const bool is_weld_of_bodies = import.whole("eq_type", k) == kWeld && import.whole("eq_objtype", k) != kObjectSite;
  if (!is_weld_of_bodies) return gap;
  return std::max(gap, 2 * (one.orientation.conjugate() * other.orientation).vec().norm());
}

void refuse_open(MjcfImport& import, int k, double gap) {
  if (gap > kClosed)
    throw InputError(
        fmt::format("{}: is open by {:.3g} (m or rad) where the model starts, and a scene's joints hold "
                    "what they find; allowed: a start, as a keyframe, at which it is closed",
                    import.at("equality", k), gap));
}

// `terms`: of MuJoCo's joints.
void add_coupling(MjcfImport& import, int k, int joint, const std::vector<JointTerm>& terms, double gap) {
  LinkCoupling row{joint, terms, 0, import.at("equality", k)};
  if (!renumber(row, import.row_of_joint))
    return import.lose("equality", k, "an equality of joints", "one of them has no axis of its own");
  refuse_open(import, k, std::abs(gap));
  import.model.couplings.push_back(std::move(row));
}

// q1 - q1(0) = polynomial of q2 - q2(0).
void read_joint_equality(MjcfImport& import, int k) {
  const int one = import.whole("eq_obj1id", k), other = import.whole("eq_obj2id", k);
  const auto data = [&](int i) { return import.value("eq_data", kEqualityNumbers * k + i); };
  const auto moved = [&](int joint) {
    return import.start_of(joint) - import.value("qpos0", import.whole("jnt_qposadr", joint));
  };
  if (other < 0 || data(2) != 0 || data(3) != 0 || data(4) != 0)
    return import.lose("equality", k, other < 0 ? "an equality that holds a joint" : "an equality that is no line",
                       "a scene's coupling is a ratio of two joints");
  add_coupling(import, k, one, {{other, data(1)}}, moved(one) - data(0) - data(1) * moved(other));
}

void read_tendon_equality(MjcfImport& import, int k) {
  const int tendon = import.whole("eq_obj1id", k);
  if (import.whole("eq_obj2id", k) < 0 && is_straight(import, tendon)) {
    const Ends ends = ends_of(import, tendon);
    LinkJoint row;
    row.where = import.at("equality", k), row.is_loop = true;
    row.joint.a = ends.a, row.joint.b = ends.b, row.joint.type = DistanceJoint{ends.point_a, ends.point_b};
    import.model.joints.push_back(std::move(row));
    return;
  }
  const FixedTendon fixed = is_fixed_tendon(import, tendon) ? fixed_tendon(import, tendon) : FixedTendon();
  if (import.whole("eq_obj2id", k) >= 0 || fixed.joints.size() < 2)
    return import.lose("equality", k, "an equality of tendons", "a scene's coupling is a sum of joints");
  const auto moved = [&](int joint) {
    return import.start_of(joint) - import.value("qpos0", import.whole("jnt_qposadr", joint));
  };
  // coefficient_1 x_1 + coefficient_2 x_2 + ... = constant
  const auto& [one, first] = fixed.joints.front();
  std::vector<JointTerm> terms;
  double gap = moved(one) - import.value("eq_data", kEqualityNumbers * k) / first;
  for (auto other = fixed.joints.begin() + 1; other != fixed.joints.end(); ++other) {
    terms.push_back({other->first, -other->second / first});
    gap -= terms.back().ratio * moved(other->first);
  }
  add_coupling(import, k, one, terms, gap);
}

void read_equality(MjcfImport& import, int k) {
  if (!import.whole("eq_active", k))
    return import.model.left_out.add(import.at("equality", k), "an equality", no_motion("is not active"));
  const int type = import.whole("eq_type", k);
  if (type == kJointEquality) return read_joint_equality(import, k);
  if (type == kTendonEquality) return read_tendon_equality(import, k);
  if (type != kConnect && type != kWeld)
    return import.lose("equality", k, "an equality of flexible bodies", "a scene's bodies are rigid");
  const Held held = held_by(import, k);
  refuse_open(import, k, opening_of(import, k, held));
  LinkJoint row;
  row.where = import.at("equality", k), row.is_loop = true;
  row.joint.name = import.m.name_of("equality", static_cast<std::size_t>(k));
  row.joint.a = MjcfImport::link_of(held.b), row.joint.b = MjcfImport::link_of(held.a);
  if (type == kConnect) row.joint.type = BallJoint{(import.pose_of(held.a) * held.in_a).position};
  if (type == kWeld) row.joint.type = FixedJoint{};
  import.model.joints.push_back(std::move(row));
}

// A tendon over one joint acts on that joint's coordinate.
void read_fixed_tendon(MjcfImport& import, int k, double stiffness, double damping) {
  const FixedTendon fixed = fixed_tendon(import, k);
  const int row = fixed.joints.size() == 1 ? import.row_of_joint[fixed.joints[0].first] : -1;
  const bool is_limited = import.whole("tendon_limited", k);
  if (row < 0 || is_limited)
    return import.lose("tendon", k, is_limited ? "the range of a fixed tendon" : "the spring of a fixed tendon",
                       "no scene has springs or limits over several joints");
  const auto [joint, coefficient] = fixed.joints[0];
  Joint& driven = import.model.joints[row].joint;
  const double rest = import.value("tendon_lengthspring", 2 * k) / coefficient - import.start_of(joint);
  const double added = stiffness * coefficient * coefficient;
  if (added > 0) driven.rest = (driven.stiffness * driven.rest + added * rest) / (driven.stiffness + added);
  driven.stiffness += added, driven.damping += damping * coefficient * coefficient;
  if (import.may_turn_round(joint) && added > 0)
    import.lose("tendon", k, "a spring beyond half a turn", "a scene's spring does not count whole turns");
}

void read_tendon(MjcfImport& import, int k) {
  const double stiffness = import.value("tendon_stiffness", k), damping = import.value("tendon_damping", k);
  const bool is_limited = import.whole("tendon_limited", k);
  for (const char* name : {"frictionloss", "armature"}) {
    if (import.value(fmt::format("tendon_{}", name), k) != 0)
      import.lose("tendon", k, fmt::format("{} of a tendon", name), "acts along a tendon, and no scene has one");
  }
  for (int i = 0; i < 2; ++i) {
    if (import.value("tendon_stiffnesspoly", 2 * k + i) != 0 || import.value("tendon_dampingpoly", 2 * k + i) != 0)
      import.lose("tendon", k, "a spring or damper of higher powers", "a scene's are linear");
  }
  if (stiffness == 0 && damping == 0 && !is_limited)
    return import.model.left_out.add(import.at("tendon", k), "a tendon", no_motion("has no spring and no range"));
  if (is_fixed_tendon(import, k)) return read_fixed_tendon(import, k, stiffness, damping);
  if (is_limited) import.lose("tendon", k, "a spatial tendon", "bounds a length, which no scene does");
  if (stiffness == 0 && damping == 0) return;
  const double from = import.value("tendon_lengthspring", 2 * k), to = import.value("tendon_lengthspring", 2 * k + 1);
  if (!is_straight(import, k) || from != to)
    return import.lose("tendon", k, "a spatial tendon",
                       "a scene's springs are straight, from one point to another, with one rest length");
  const Ends ends = ends_of(import, k);
  import.model.springs.push_back({ends.a, ends.b, ends.point_a, ends.point_b, stiffness, damping, from});
}

}  // namespace

void read_mjcf_constraints(MjcfImport& import) {
  for (int k = 0; k < import.count("tendon_adr"); ++k) read_tendon(import, k);
  for (int k = 0; k < import.count("eq_type"); ++k) read_equality(import, k);
}

}  // namespace rigor::inline adapters
