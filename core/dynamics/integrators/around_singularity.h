// Steps of any method past a singular position of a mechanism with loops. At a distance of d rad from one, what J and S
// say of the motion across the way has lost d^-2 roundings: a step, or a stage of one, that ends very near puts them
// into the motion for good. A step that came too near is taken again in two parts, divided where neither comes as near.
#pragma once

#include <memory>
#include <string>

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/joints/joints.h"
#include "core/engine/body_table.h"

namespace rigor {

class AroundSingularity : public Stepper {
 public:
  // The joints are those that `inner` holds; they must outlive it.
  AroundSingularity(Joints& joints, std::size_t bodies, std::unique_ptr<Stepper> inner)
      : joints_(joints), inner_(std::move(inner)), start_(bodies), best_(bodies) {}

  void step(MutableBodyColumns state, double t, double dt) override;
  std::string solver_warning() const override { return solver_warning_; }

 private:
  // Two steps, or one for a share of 1. Returns the smallest pivot on the way.
  double attempt(MutableBodyColumns state, double t, double dt, double share);

  Joints& joints_;
  std::unique_ptr<Stepper> inner_;
  BodyTable start_, best_;
  std::string noted_, solver_warning_;
};

}  // namespace rigor
