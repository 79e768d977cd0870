// Optional interface of a world whose report of joint loads takes a large part of a step. Callers can turn the report
// off where nobody reads it.
#pragma once

#include "core/engine/engine.h"

namespace rigor {

class SparesReactions {
 public:
  virtual ~SparesReactions() = default;
  // Whether to report the following steps (reported_reactions.h). The default is true.
  virtual void report_reactions(bool are_read) = 0;
};

inline void report_reactions(World& world, bool are_read) {
  if (auto* spares = dynamic_cast<SparesReactions*>(&world)) spares->report_reactions(are_read);
}

}  // namespace rigor
