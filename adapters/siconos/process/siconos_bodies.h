// The moving bodies of a scene as Siconos's dynamical systems: position (x, q wxyz) in W, twist (v in W, w in B), and
// their loads. Rigor's law computes the loads whenever Siconos asks for forces: at both ends of a step.
#pragma once

#include <NewtonEulerDS.hpp>
#include <SiconosVector.hpp>
#include <memory>
#include <vector>

#include "adapters/siconos/siconos_slope.h"
#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline adapters::siconos {

inline SP::SiconosVector vector_of(const Vec3& v) {
  const auto out = std::make_shared<SiconosVector>(3);
  for (int k = 0; k < 3; ++k) (*out)(k) = v[k];
  return out;
}

class Bodies;

// One body, whose forces hang on where all are.
class LoadedBody : public NewtonEulerDS {
 public:
  LoadedBody(Bodies& all, int index, SP::SiconosVector q, SP::SiconosVector twist, double mass,
             SP::SimpleMatrix inertia);

  using NewtonEulerDS::computeForces;
  void computeForces(double time, SP::SiconosVector q, SP::SiconosVector twist) override;
  // Derivatives by the twist, of the gyroscopic moment and of the loads, which follow the position that results from
  // the twist.
  void computeJacobianvForces(double time) override;

 private:
  Bodies& all_;
  int index_;
};
using BodyPointer = std::shared_ptr<LoadedBody>;

class Bodies {
 public:
  explicit Bodies(const Scene& scene);

  // Systems made anew from where the bodies are. A step of dt [s] moves them by theta dt times the twist at its end.
  void make_systems(double theta, double dt);
  const std::vector<BodyPointer>& systems() const { return systems_; }  // null for a fixed body
  // Siconos's present state in columns; fixed bodies are unchanged.
  void gather();
  BodyColumns state() const { return table_.columns(); }
  const Loads& loads() const { return loads_; }
  // Timed loads are those at `time` [s] from now on.
  void set_time(double time) { time_ = time; }
  // Force and torque on a body; valid until the next call.
  const Wrench& wrench(int body);
  const Mat6& slope(int body);  // likewise; see siconos_slope.h

 private:
  const Scene& scene_;
  Loads loads_;
  BodyTable table_;
  std::vector<BodyPointer> systems_;
  Wrenches wrenches_;
  std::vector<Mat6> slopes_;
  double reach_ = 0, time_ = 0;  // s
  int last_wrench_ = 0, last_slope_ = 0;
};

}  // namespace rigor::inline adapters::siconos
