#include "core/engine/saved_bytes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/content_hash.h"
#include "core/base/error.h"

namespace rigor::inline engine {
namespace {

constexpr std::string_view kTitle = "rigor saved state 1\n";
constexpr std::size_t kChecksum = sizeof(std::uint64_t);  // bytes, at the end

std::string run_of(const Settings& settings) {
  std::string text = settings.method + (settings.track == Track::stock ? "@stock" : "");
  for (const auto& [name, value] : settings.options) text += fmt::format(",{}={}", name, value);
  return text;
}

// The numbers of a scene that its motion depends on, without the points of its shapes.
class SceneNumbers {
 public:
  explicit SceneNumbers(const Scene& scene) {
    add(scene.gravity, scene.bodies.size(), scene.springs.size(), scene.joints.size(), scene.couplings.size(),
        scene.motors.size(), scene.contact_pairs.size(), scene.forces.size());
    for (const Body& body : scene.bodies) {
      add(body.mass, body.inertia, body.position, body.orientation, body.velocity, body.angular_velocity, body.fixed,
          body.collides, body.shape ? static_cast<int>(body.shape->index()) : -1);
    }
    for (const Spring& s : scene.springs)
      add(s.a, s.b, s.point_a, s.point_b, s.stiffness, s.damping, s.rest_length, s.quadratic_stiffness);
    for (const Joint& joint : scene.joints) add_joint(joint);
    for (const Coupling& coupling : scene.couplings) {
      add(coupling.joint, coupling.offset);
      add_terms(coupling.to);
    }
    for (const Motor& motor : scene.motors) add_motor(motor);
    add_law(scene.contact_default);
    for (const ContactPair& pair : scene.contact_pairs) add(pair.a, pair.b), add_law(pair.law);
    for (const TimedForce& f : scene.forces) add(f.body, f.force, f.torque, f.point, f.from, f.until);
  }
  std::uint64_t hash() const { return content_hash(archive_.bytes()); }

 private:
  template <typename... Values>
  void add(Values... values) {
    archive_(values...);
  }
  void add_joint(const Joint& joint) {
    add(joint.a, joint.b, joint.type.index(), joint.stiffness, joint.quadratic_stiffness, joint.damping, joint.rest,
        joint.lower, joint.upper, joint.restitution, joint.armature);
    for_each_vector(joint.type, [&](const auto&, const auto&, const Vec3& vector) { add(vector); });
    for_each_number(joint.type, [&](const auto&, double number) { add(number); });
  }
  void add_terms(const std::vector<JointTerm>& terms) {
    add(terms.size());
    for (const JointTerm& term : terms) add(term.joint, term.ratio);
  }
  void add_motor(const Motor& motor) {
    add(motor.joint, motor.effort, motor.speed, motor.most, motor.from, motor.until, motor.is_friction);
    if (motor.efforts) add(motor.efforts->times, motor.efforts->values, motor.efforts->is_linear);
    if (!motor.plus.empty()) add_terms(motor.plus);
    if (!motor.servo) return;
    const Servo& servo = *motor.servo;
    add(servo.target.times, servo.target.values, servo.kp, servo.kd, servo.target_speed, servo.most, servo.period);
  }
  void add_law(const ContactLaw& law) {
    add(law.restitution, law.friction, law.collides, law.static_friction, law.rolling_friction, law.torsional_friction,
        law.stiffness, law.damping, law.dissipation);
  }

  StateArchive archive_;
};

std::uint64_t checksum_of(std::string_view bytes) { return content_hash(bytes); }

std::string with_checksum(std::string bytes) {
  const std::uint64_t sum = checksum_of(bytes);
  return bytes.append(reinterpret_cast<const char*>(&sum), kChecksum);
}

}  // namespace

std::string with_new_checksum(std::string bytes) {
  bytes.resize(bytes.size() < kChecksum ? 0 : bytes.size() - kChecksum);
  return with_checksum(std::move(bytes));
}

StateOwner::StateOwner(std::string engine, std::string version, const Scene& scene, const Settings& settings)
    : engine_(std::move(engine)),
      version_(std::move(version)),
      run_(run_of(settings)),
      scene_(SceneNumbers(scene).hash()) {}

std::unique_ptr<SavedState> StateOwner::sealed(const std::string& state) const {
  StateArchive head;
  std::string engine = engine_, version = version_, run = run_;
  std::uint64_t scene = scene_;
  head(engine, version, run, scene);
  return std::make_unique<SavedBytes>(with_checksum(std::string(kTitle) + head.bytes() + state));
}

std::string_view StateOwner::opened(const SavedState& state) const {
  const auto* saved = dynamic_cast<const SavedBytes*>(&state);
  if (!saved) throw InputError(fmt::format("the saved state is one of another kind of engine than {}", engine_));
  std::string_view bytes = saved->bytes();
  if (!bytes.starts_with(kTitle)) throw InputError("these bytes are no saved state, or one of another format");
  std::uint64_t sum = 0;
  if (bytes.size() >= kTitle.size() + kChecksum)
    bytes.substr(bytes.size() - kChecksum).copy(reinterpret_cast<char*>(&sum), kChecksum);
  bytes.remove_suffix(std::min(kChecksum, bytes.size()));
  if (checksum_of(bytes) != sum) throw InputError("the saved state is damaged: its checksum does not fit");
  bytes.remove_prefix(kTitle.size());
  StateArchive head(bytes);
  std::string engine, version, run;
  std::uint64_t scene = 0;
  head(engine, version, run, scene);
  const auto refuse_other = [](const char* what, const std::string& saved_by, const std::string& own) {
    if (saved_by == own) return;
    throw InputError(fmt::format("the saved state is of {} '{}'; this world is of '{}'", what, saved_by, own));
  };
  refuse_other("the engine", engine, engine_);
  refuse_other("the version", version, version_);
  refuse_other("the method", run, run_);
  if (scene != scene_) throw InputError("the saved state is of another scene than this world's");
  return head.left();
}

std::unique_ptr<SavedState> ArchivesState::save() const {
  return owner_.save([this](StateArchive& archive) { const_cast<ArchivesState*>(this)->archive_state(archive); });
}

void ArchivesState::restore(const SavedState& state) {
  owner_.restore(state, [this](StateArchive& archive) { archive_state(archive); });
}

}  // namespace rigor::inline engine
