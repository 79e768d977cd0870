#include "adapters/faults/broken_engine.h"

#include "core/engine/clock.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline adapters {
namespace {

// The scene with its bodies where they are at time t, and its clock set to zero there.
Scene restarted(const Scene& original, BodyColumns bodies, double t) {
  Scene scene = original;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    Body& body = scene.bodies[i];
    if (body.fixed) continue;
    body.position = bodies.position(i), body.orientation = bodies.orientation(i);
    body.velocity = bodies.velocity(i), body.angular_velocity = bodies.angular_velocity(i);
  }
  for (TimedForce& force : scene.forces) force.from -= t, force.until -= t;
  return scene;
}

class BrokenWorld : public World, public ReportsContacts {
 public:
  BrokenWorld(const Engine& engine, const Settings& settings, const Fault& fault, const Scene& scene)
      : engine_(engine), settings_(settings), fault_(fault), scene_(scene) {
    if (fault_.scene) fault_.scene(scene_);
    world_ = engine_.load(scene_, settings_);
    remember();
  }

  void step(double dt) override {
    if (fault_.reads_late) remember();
    if (fault_.step) {
      step_anew(dt);
    } else {
      world_->step(dt);
    }
    clock_.advance(dt), ++steps_;
    if (!fault_.reads_late) remember();
  }

  void read(Snapshot& out) const override {
    const BodyColumns now = seen_.columns();
    const MutableBodyColumns told = out.own(now.size(), now.has_rotation());
    for (int c = 0; c < (now.has_rotation() ? kRotation + 9 : kRotation); ++c) {
      for (std::size_t i = 0; i < now.size(); ++i) told.column(c)[i] = now.column(c)[i];
    }
    if (fault_.read) fault_.read(told, scene_);
    out.time = clock_.time();
  }

  SettingsInForce settings_in_force() const override { return world_->settings_in_force(); }
  std::string solver_warning() const override { return world_->solver_warning(); }

  // A remote run reads few of its steps, and this world reads each one.
  Capabilities capabilities() override {
    Capabilities can = world_->capabilities();
    can.remote = nullptr;
    can.state = nullptr;  // this world has a state of its own
    if (can.contacts) can.contacts = this;
    return can;
  }
  void ask_for_contacts() override {
    asks_for_contacts_ = true;
    rigor::ask_for_contacts(*world_);
  }
  std::vector<ReportedContact> contacts() const override {
    std::vector<ReportedContact> told = reported_contacts(*world_);
    if (fault_.contacts) fault_.contacts(told);
    return told;
  }

 private:
  void remember() {
    Snapshot now;
    world_->read(now);
    seen_ = now.bodies();
  }

  void step_anew(double dt) {
    Snapshot now;
    world_->read(now);
    Scene scene = restarted(scene_, now.bodies(), clock_.time());
    int times = 1;
    if (steps_ == 0) before_ = now.bodies();
    Moment moment{scene, before_.columns(), scene_, dt, times, steps_, clock_.time()};
    fault_.step(moment);
    before_ = now.bodies();
    world_ = engine_.load(scene, settings_);
    if (asks_for_contacts_) rigor::ask_for_contacts(*world_);
    for (int i = 0; i < times; ++i) world_->step(dt);
  }

  const Engine& engine_;
  Settings settings_;
  const Fault& fault_;
  Scene scene_;
  std::unique_ptr<World> world_;
  BodyTable seen_, before_;  // as it is told; as it was before the last step
  Clock clock_;
  long steps_ = 0;
  bool asks_for_contacts_ = false;
};

}  // namespace

std::unique_ptr<World> BrokenEngine::load(const Scene& scene, const Settings& settings) const {
  if (fault_.step && !scene.joints.empty())
    throw EngineFailure(FailureKind::unsupported, "joints count from t = 0, and a step that is changed starts anew");
  return std::make_unique<BrokenWorld>(engine_, settings, fault_, scene);
}

}  // namespace rigor::inline adapters
