// A world whose report of what joints carry takes it a good part of a step, and that can be spared it where nobody
// reads the report. Nobody has to offer this.
#pragma once

#include "core/engine/engine.h"

namespace rigor {

class SparesReactions {
 public:
  virtual ~SparesReactions() = default;
  // Whether the steps from now on are reported (reported_reactions.h). They are until somebody says that they are not.
  virtual void report_reactions(bool are_read) = 0;
};

inline void report_reactions(World& world, bool are_read) {
  if (auto* spares = dynamic_cast<SparesReactions*>(&world)) spares->report_reactions(are_read);
}

}  // namespace rigor
