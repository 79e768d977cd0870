// The state of a conversion of an MJCF model to links, joints and shapes, which its parts share.
#pragma once

#include "adapters/common/compiled_mjcf.h"
#include "core/scene/link_model.h"

namespace rigor::inline adapters {

// Words of mjModel's numbers, equal in MuJoCo 2.2 and 3.
namespace mjcf {
enum JointKind { kFree, kBall, kSlide, kHinge };
enum GeomKind { kPlane, kHeightField, kSphere, kCapsule, kEllipsoid, kCylinder, kBox, kMesh };
enum EqualityKind { kConnect, kWeld, kJointEquality, kTendonEquality };
enum WrapKind { kNoWrap, kWrapJoint, kPulley, kWrapSite };
enum TransmissionKind { kOnJoint, kOnJointInParent, kSliderCrank, kOnTendon, kOnSite, kOnBody };
enum DynamicsKind { kNoDynamics, kIntegrator, kFilter };
enum GainKind { kFixedGain, kAffineGain };
enum BiasKind { kNoBias, kAffineBias };
inline constexpr int kObjectSite = 6;
}  // namespace mjcf

struct MjcfImport {
  const MjcfSource& source;
  const CompiledMjcf& m;
  LinkModel model = {};
  std::vector<int> row_of_joint = {};  // by MuJoCo's joint: its row in model.joints, or -1

  std::string at(const char* kind, int index) const {
    return source.place_of(kind, m.name_of(kind, static_cast<std::size_t>(index)), index);
  }
  void lose(const char* kind, int index, const std::string& what, const std::string& why) {
    model.left_out.add(at(kind, index), what, lost(why));
  }
  Vec3 vector(const std::string& name, int row, int stride = 3) const {
    const auto first = static_cast<std::size_t>(row * stride);
    return {m.at(name, first), m.at(name, first + 1), m.at(name, first + 2)};
  }
  Quat turn(const std::string& name, int row) const {
    const auto first = static_cast<std::size_t>(4 * row);
    return Quat(m.at(name, first), m.at(name, first + 1), m.at(name, first + 2), m.at(name, first + 3)).normalized();
  }
  int count(const std::string& name) const { return static_cast<int>(m.size(name)); }
  int whole(const std::string& name, int index) const { return m.whole(name, static_cast<std::size_t>(index)); }
  double value(const std::string& name, int index) const { return m.at(name, static_cast<std::size_t>(index)); }
  // The world's link is kWorld.
  static int link_of(int body) { return body - 1; }
  BodyPose pose_of(int body) const { return body == 0 ? BodyPose() : model.links[link_of(body)].pose; }
  double start_of(int joint) const { return value("qpos", whole("jnt_qposadr", joint)); }
  // Whether a hinge lacks limits less than a turn apart. A scene's springs and servos then do not count whole turns.
  bool may_turn_round(int joint) const;
};

// Each adds its part to import.model.
void read_mjcf_bodies(MjcfImport& import);
void read_mjcf_geoms(MjcfImport& import);
void read_mjcf_constraints(MjcfImport& import);  // equalities and tendons
void read_mjcf_actuators(MjcfImport& import);

// A model as links and joints. Throws InputError.
LinkModel links_of_mjcf(const MjcfSource& source, CompiledMjcf compiled);

}  // namespace rigor::inline adapters
