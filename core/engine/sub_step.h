// A world whose method divides each step. The step of its name is then not the step that it takes. Optional.
#pragma once

#include <optional>

#include "core/engine/engine.h"

namespace rigor {

class MayDivideSteps {
 public:
  virtual ~MayDivideSteps() = default;
  // s, of the last step's parts; none if the last step was taken as one.
  virtual std::optional<double> sub_step() const = 0;
};

inline std::optional<double> sub_step_of(const World& world) {
  const auto* may = dynamic_cast<const MayDivideSteps*>(&world);
  return may ? may->sub_step() : std::nullopt;
}

}  // namespace rigor
