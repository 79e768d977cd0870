// Finds the bodies of a model that may touch each other. A scene lists the pairs that never do, and the pairs whose
// friction or restitution differs from the usual.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/scene/link_model.h"

namespace rigor::inline imports {

// A body of the scene, and the shapes that it was made of.
struct ContactSource {
  struct Part {
    int link;
    const LinkShape* shape;
  };
  int body = -1, link = -1;
  std::vector<Part> parts;
};

class Touching {
 public:
  using Pairs = std::set<std::pair<int, int>>;  // of sources, the smaller index first

  // `body`: see RigidGroups.
  Touching(const LinkModel& model, const std::vector<int>& body);

  // Whether anything that moves in the model may touch this shape.
  bool can_be_touched(int link, const LinkShape& shape) const;
  // Whether a joint holds the two together, or they are parts of one.
  bool are_joined(const ContactSource& a, const ContactSource& b) const;
  // Whether the file's filters and exclusions let two shapes touch.
  bool may_touch(const ContactSource::Part& a, const ContactSource::Part& b) const;

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
  Pairs apart_;                          // links that the file keeps apart; kWorld: all that stand still
};

// Lists the pairs that never touch in the scene, and gives the others their friction and restitution.
void settle_contacts(LinkModel& model, const Touching& touching, const std::vector<ContactSource>& sources,
                     Scene& scene);

}  // namespace rigor::inline imports
