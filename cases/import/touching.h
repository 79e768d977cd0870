// Which shapes of a model may touch which, and what a scene, in which all that collide may touch, makes of it.
#pragma once

#include <map>
#include <set>
#include <utility>

#include "core/scene/link_model.h"

namespace rigor {

class Touching {
 public:
  // `body`: of RigidGroups.
  Touching(const LinkModel& model, const std::vector<int>& body);

  // Whether anything in the model may touch the shape.
  bool can_be_touched(int link, const LinkShape& shape) const;
  // Whether the file lets two shapes touch, of which one is part of a moving link.
  bool may_touch(int link_a, const LinkShape& a, int link_b, const LinkShape& b) const;

 private:
  struct Kind {
    int model;
    bool touches_own, is_static;
    unsigned type, affinity;
    auto operator<=>(const Kind&) const = default;
  };
  Kind kind_of(int link, const LinkShape& shape) const;
  static bool may_touch(const Kind& a, const Kind& b);

  const LinkModel& model_;
  const std::vector<int>& body_;
  std::map<Kind, std::set<int>> kinds_;  // and the first two bodies that have it
  std::set<std::pair<int, int>> apart_;  // bodies that a joint holds together, or that the file keeps apart
};

// A body of the scene that a shape was made of.
struct ShapeSource {
  int body = -1, link = -1;
  const LinkShape* shape = nullptr;
};

// Ends the part in contact of bodies that overlap at t = 0 with what the file keeps them apart from, as few as will do
// and those next to the root first; says which. Then gives each pair of the others its friction and restitution.
void settle_contacts(LinkModel& model, const Touching& touching, const std::vector<ShapeSource>& sources, Scene& scene);

}  // namespace rigor
