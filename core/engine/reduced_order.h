// An optional interface of a world that continues with a lower-order method if its own would take too long. This is
// allowed, but differs from what the run's name promises. The judge needs the time from which it holds.
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
  // The time from which the run used a lower order; empty if it never did.
  virtual std::optional<ReducedOrder> reduced_order() const = 0;
};

inline std::optional<ReducedOrder> reduced_order_of(const World& world) {
  const auto* may = dynamic_cast<const MayReduceOrder*>(&world);
  return may ? may->reduced_order() : std::nullopt;
}

}  // namespace rigor
