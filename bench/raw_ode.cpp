#include <ode/ode.h>

#include <algorithm>

#include "adapters/ode/ode_library.h"
#include "bench/raw_engines.h"

namespace rigor::bench {
namespace {

class RawOde : public RawWorld {
 public:
  explicit RawOde(const Scene& scene) {
    ode_library::start();
    world_ = dWorldCreate();
    dWorldSetGravity(world_, scene.gravity.x(), scene.gravity.y(), scene.gravity.z());
    dWorldSetAutoDisableFlag(world_, 0);
    dWorldSetDamping(world_, 0, 0);
    for (const Body& body : scene.bodies) add(body);
  }
  ~RawOde() override { dWorldDestroy(world_); }
  RawOde(const RawOde&) = delete;
  RawOde& operator=(const RawOde&) = delete;

  void run(int steps, double dt, std::vector<double>& out) override {
    out.resize(13 * bodies_.size());
    for (int n = 0; n < steps; ++n) {
      dWorldStep(world_, dt);
      double* to = out.data();
      for (const dBodyID body : bodies_) {
        to = std::copy_n(dBodyGetPosition(body), 3, to);
        to = std::copy_n(dBodyGetQuaternion(body), 4, to);
        to = std::copy_n(dBodyGetLinearVel(body), 3, to);
        to = std::copy_n(dBodyGetAngularVel(body), 3, to);
      }
    }
  }

 private:
  void add(const Body& body) {
    const dBodyID id = dBodyCreate(world_);
    dMass mass;
    const Mat3& I = body.inertia;
    dMassSetParameters(&mass, body.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
    dBodySetMass(id, &mass);
    const Quat& q = body.orientation;
    const dQuaternion orientation = {q.w(), q.x(), q.y(), q.z()};
    dBodySetPosition(id, body.position.x(), body.position.y(), body.position.z());
    dBodySetQuaternion(id, orientation);
    dBodySetLinearVel(id, body.velocity.x(), body.velocity.y(), body.velocity.z());
    dBodySetAngularVel(id, body.angular_velocity.x(), body.angular_velocity.y(), body.angular_velocity.z());
    dBodySetFiniteRotationMode(id, 1);
    dBodySetGyroscopicMode(id, 1);
    bodies_.push_back(id);
  }

  dWorldID world_;
  std::vector<dBodyID> bodies_;
};

}  // namespace

std::unique_ptr<RawWorld> raw_ode(const Scene& scene) { return std::make_unique<RawOde>(scene); }

}  // namespace rigor::bench
