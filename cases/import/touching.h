// Finds the shapes of a model that may touch each other. A scene lists the pairs that never do.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/scene/link_model.h"

namespace rigor {

// A body of the scene, and the shape that it was made of.
struct ShapeSource {
  int body = -1, link = -1;
  const LinkShape* shape = nullptr;
};

class Touching {
 public:
  using Pairs = std::set<std::pair<int, int>>;  // of sources, the smaller index first

  // `body`: see RigidGroups.
  Touching(const LinkModel& model, const std::vector<int>& body);

  // Whether anything that moves in the model may touch this shape.
  bool can_be_touched(int link, const LinkShape& shape) const;
  // Every pair of sources that the file keeps apart, without pairs that stand still. Nothing if there are more than
  // `most`.
  std::optional<Pairs> kept_apart(const std::vector<ShapeSource>& sources, std::size_t most) const;

 private:
  struct Kind {
    int model;
    bool touches_own, is_static;
    unsigned type, affinity;
    auto operator<=>(const Kind&) const = default;
  };
  void find_parts();
  Kind kind_of(int link, const LinkShape& shape) const;
  static bool may_touch(const Kind& a, const Kind& b);

  const LinkModel& model_;
  const std::vector<int>& body_;
  std::map<Kind, std::set<int>> kinds_;  // with the first two bodies of each kind
  std::vector<int> part_;                // by link; fixed joints make one part of many links
  Pairs joined_;                         // parts that a joint connects
};

// Lists the pairs that never touch in the scene, and gives the others their friction and restitution.
void settle_contacts(LinkModel& model, const Touching& touching, const std::vector<ShapeSource>& sources, Scene& scene);

}  // namespace rigor
