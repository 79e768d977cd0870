#include <SimTKsimbody.h>

#include <algorithm>

#include "bench/raw_engines.h"

namespace rigor::bench {
namespace {

class RawSimbody : public RawWorld {
 public:
  explicit RawSimbody(const Scene& scene) : matter_(system_), forces_(system_), integrator_(system_) {
    SimTK::Force::UniformGravity(forces_, matter_,
                                 SimTK::Vec3(scene.gravity.x(), scene.gravity.y(), scene.gravity.z()));
    for (const Body& body : scene.bodies) add(body);
    SimTK::State state = system_.realizeTopology();
    for (std::size_t i = 0; i < bodies_.size(); ++i) place(scene.bodies[i], bodies_[i], state);
    integrator_.setFixedStepSize(1e9);
    integrator_.setProjectEveryStep(true);
    integrator_.setAccuracy(0.5);
    integrator_.setConstraintTolerance(1e-3);
    integrator_.setAllowInterpolation(false);
    integrator_.initialize(state);
  }

  void run(int steps, double dt, std::vector<double>& out) override {
    out.resize(13 * bodies_.size());
    for (int n = 1; n <= steps; ++n) {
      while (integrator_.getTime() < n * dt) integrator_.stepTo(n * dt, n * dt);
      read(out);
    }
  }

 private:
  void add(const Body& body) {
    const Mat3& I = body.inertia;
    const SimTK::MassProperties mass(body.mass, SimTK::Vec3(0),
                                     SimTK::Inertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)));
    bodies_.push_back(
        SimTK::MobilizedBody::Free(matter_.Ground(), SimTK::Transform(), SimTK::Body::Rigid(mass), SimTK::Transform()));
  }

  static void place(const Body& body, const SimTK::MobilizedBody& at, SimTK::State& state) {
    const Quat& q = body.orientation;
    const double coordinates[] = {q.w(), q.x(), q.y(), q.z(), body.position.x(), body.position.y(), body.position.z()};
    for (int i = 0; i < 7; ++i) at.setOneQ(state, i, coordinates[i]);
    for (int i = 0; i < 3; ++i)
      at.setOneU(state, i, body.angular_velocity[i]), at.setOneU(state, 3 + i, body.velocity[i]);
  }

  void read(std::vector<double>& out) const {
    const SimTK::State& state = integrator_.getState();
    system_.realize(state, SimTK::Stage::Velocity);
    double* to = out.data();
    for (const SimTK::MobilizedBody& body : bodies_) {
      const SimTK::Vec3& position = body.getBodyTransform(state).p();
      const SimTK::SpatialVec& velocity = body.getBodyVelocity(state);
      to = std::copy_n(&position[0], 3, to);
      for (int i = 0; i < 4; ++i) *to++ = body.getOneQ(state, i);
      to = std::copy_n(&velocity[1][0], 3, to);
      to = std::copy_n(&velocity[0][0], 3, to);
    }
  }

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::RungeKuttaMersonIntegrator integrator_;
  std::vector<SimTK::MobilizedBody> bodies_;
};

}  // namespace

std::unique_ptr<RawWorld> raw_simbody(const Scene& scene) { return std::make_unique<RawSimbody>(scene); }

}  // namespace rigor::bench
