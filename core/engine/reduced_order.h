// A world that, where its method would take too long, goes on by another of lower order: what it does is allowed, but
// not what the run's name promises, and who judges it has to know from when on. Nobody has to offer this.
#pragma once

#include <optional>
#include <string>

#include "core/engine/engine.h"

namespace rigor {

struct ReducedOrder {
  double from = 0;  // s: where the first such step began
  std::string how;  // a phrase: "in part by inelastic steps of first order ..."
  bool operator==(const ReducedOrder&) const = default;
};

class MayReduceOrder {
 public:
  virtual ~MayReduceOrder() = default;
  // Of the run so far; none if all of it was stepped by its method.
  virtual std::optional<ReducedOrder> reduced_order() const = 0;
};

inline std::optional<ReducedOrder> reduced_order_of(const World& world) {
  const auto* may = dynamic_cast<const MayReduceOrder*>(&world);
  return may ? may->reduced_order() : std::nullopt;
}

}  // namespace rigor
