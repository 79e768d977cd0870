// The contact forces and moments that the truth's motion implies, step by step.
#pragma once

#include "cases/metrics/measures/contact/equilibrium.h"

namespace rigor::inline metric {

class TrueWrenches {
 public:
  explicit TrueWrenches(const JudgedRun& run) : run_(run), laws_(run.scene) {}

  // Over the step that ends with sample n. Valid until the next call.
  const Equilibrium& of_step(std::size_t n);

 private:
  bool is_as_before(std::size_t n) const;

  const JudgedRun& run_;
  ContactLaws laws_;
  Equilibrium known_;
  std::size_t known_of_ = 0;  // the step of known_; 0: none
};

// Of a scene that stands as it starts.
Equilibrium wrenches_at_rest(const Scene& scene, BodyColumns bodies);

}  // namespace rigor::inline metric
