#include "cases/import/touching.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/dynamics/collision/broad_phase.h"
#include "core/dynamics/collision/narrow_phase.h"
#include "core/scene/contact_laws.h"

namespace rigor {
namespace {

constexpr std::size_t kMostPairs = 10000;   // with a law of their own
constexpr std::size_t kMostApart = 100000;  // that never touch

Pose pose_of(const Body& body) { return {body.position, matrix_of(body.orientation)}; }

double gap_of(const Body& a, const Body& b) {
  Manifold manifold;
  collide(*a.shape, pose_of(a), *b.shape, pose_of(b), manifold);
  double gap = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& point : manifold) gap = std::min(gap, point.gap);
  return gap;
}

// Returns the pairs of sources whose bodies overlap at the start.
Touching::Pairs overlapping(const std::vector<ShapeSource>& sources, const Scene& scene) {
  std::vector<Aabb> boxes;
  for (const ShapeSource& source : sources) {
    const Body& body = scene.bodies[source.body];
    boxes.push_back(aabb_of(*body.shape, pose_of(body), 0));
  }
  Touching::Pairs found;
  BroadPhase search;
  for (const auto& [a, b] : search.overlaps(boxes)) {
    const Body &first = scene.bodies[sources[a].body], &second = scene.bodies[sources[b].body];
    if (can_meet(first, second) && gap_of(first, second) < 0) found.insert(std::minmax({a, b}));
  }
  return found;
}

// The law of a pair, from the surfaces of two shapes.
ContactLaw law_of(const LinkModel& model, const LinkShape& a, const LinkShape& b) {
  return {model.combine(a.surface.restitution, b.surface.restitution),
          model.combine(a.surface.friction, b.surface.friction)};
}

bool same(const ContactLaw& a, const ContactLaw& b) {
  return a.restitution == b.restitution && a.friction == b.friction;
}

// The most frequent law becomes the scene's default. Pairs with another law get rows.
void set_laws(LinkModel& model, const std::vector<ShapeSource>& sources, const Touching::Pairs& apart, Scene& scene) {
  std::map<std::pair<double, double>, std::pair<int, const LinkShape*>> count;
  for (const ShapeSource& source : sources) {
    auto& [number, shape] = count[{source.shape->surface.restitution, source.shape->surface.friction}];
    ++number, shape = source.shape;
  }
  if (count.empty()) return;
  const auto most = std::max_element(count.begin(), count.end(),
                                     [](const auto& a, const auto& b) { return a.second.first < b.second.first; });
  const LinkShape& usual = *most->second.second;
  scene.contact_default = law_of(model, usual, usual);
  if (count.size() == 1) return;
  std::vector<ContactPair> rows;
  for (int i = 0; i < static_cast<int>(sources.size()); ++i) {
    for (int j = 0; j < i; ++j) {
      const int a = sources[j].body, b = sources[i].body;
      if (!can_meet(scene.bodies[a], scene.bodies[b]) || apart.contains({j, i})) continue;
      const ContactLaw law = law_of(model, *sources[j].shape, *sources[i].shape);
      if (same(law, scene.contact_default)) continue;
      if (rows.size() == kMostPairs)
        return model.left_out.add(model.name, "surfaces that differ",
                                  fmt::format("more than {} pairs would need rows: all pairs have friction {:g}",
                                              kMostPairs, scene.contact_default.friction));
      rows.push_back({a, b, law});
    }
  }
  scene.contact_pairs.insert(scene.contact_pairs.end(), rows.begin(), rows.end());
}

// A file that does not say which links touch leaves links that overlap to the reader.
void keep_overlaps_apart(LinkModel& model, const std::vector<ShapeSource>& sources, const Scene& scene,
                         Touching::Pairs& apart) {
  for (const auto& pair : overlapping(sources, scene)) {
    if (!apart.insert(pair).second) continue;
    model.left_out.add(
        sources[pair.first].shape->where, "touching",
        fmt::format("overlaps '{}' at the start: these two never touch", scene.bodies[sources[pair.second].body].name));
  }
}

}  // namespace

Touching::Touching(const LinkModel& model, const std::vector<int>& body) : model_(model), body_(body) {
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) {
    for (const LinkShape& shape : model.links[i].shapes) {
      auto& bodies = kinds_[kind_of(i, shape)];
      if (bodies.size() < 2) bodies.insert(body[i]);
    }
  }
  find_parts();
  for (const LinkJoint& row : model.joints) {
    const int a = row.joint.a, b = row.joint.b;
    if (a != kWorld && b != kWorld && part_[a] != part_[b]) joined_.insert(std::minmax({part_[a], part_[b]}));
  }
}

// A part is named by one of its links.
void Touching::find_parts() {
  part_.resize(model_.links.size());
  std::iota(part_.begin(), part_.end(), 0);
  const auto first_of = [&](int link) {
    while (part_[link] != link) link = part_[link] = part_[part_[link]];
    return link;
  };
  const auto join = [&](int a, int b) { part_[first_of(a)] = first_of(b); };
  for (int i = 0; i < static_cast<int>(part_.size()); ++i) {
    if (body_[i] >= 0) join(i, body_[i]);
  }
  for (const LinkJoint& row : model_.joints) {
    const bool are_links = row.joint.a != kWorld && row.joint.b != kWorld;
    if (are_links && std::holds_alternative<FixedJoint>(row.joint.type)) join(row.joint.a, row.joint.b);
  }
  for (int i = 0; i < static_cast<int>(part_.size()); ++i) part_[i] = first_of(i);
}

Touching::Kind Touching::kind_of(int link, const LinkShape& shape) const {
  const Link& of = model_.links[link];
  return {of.model, of.touches_own_model, body_[link] == kWorld, shape.type, shape.affinity};
}

bool Touching::may_touch(const Kind& a, const Kind& b) {
  if (a.is_static && b.is_static) return false;
  if (a.model == b.model && !(a.touches_own && b.touches_own)) return false;
  return (a.type & b.affinity) || (b.type & a.affinity);
}

bool Touching::can_be_touched(int link, const LinkShape& shape) const {
  const Kind own = kind_of(link, shape);
  return std::any_of(kinds_.begin(), kinds_.end(), [&](const auto& row) {
    const auto& [kind, bodies] = row;
    const bool is_another = bodies.size() > 1 || *bodies.begin() != body_[link];
    return is_another && may_touch(own, kind);
  });
}

std::optional<Touching::Pairs> Touching::kept_apart(const std::vector<ShapeSource>& sources, std::size_t most) const {
  std::map<int, std::vector<int>> of_part, of_link;  // kWorld: all sources that stand still
  std::map<Kind, std::vector<int>> of_kind;
  const auto is_static = [&](int source) { return body_[sources[source].link] == kWorld; };
  for (int i = 0; i < static_cast<int>(sources.size()); ++i) {
    const int link = sources[i].link;
    of_part[part_[link]].push_back(i), of_link[link].push_back(i);
    if (is_static(i)) of_link[kWorld].push_back(i);
    of_kind[kind_of(link, *sources[i].shape)].push_back(i);
  }
  Pairs apart;
  const auto add = [&](const std::vector<int>& first, const std::vector<int>& second) {
    for (const int a : first) {
      for (const int b : second) {
        if (a == b || (is_static(a) && is_static(b))) continue;
        apart.insert(std::minmax({a, b}));
        if (apart.size() > most) return;
      }
    }
  };
  for (const auto& [part, own] : of_part) add(own, own);
  for (const auto& [a, b] : joined_) {
    if (of_part.contains(a) && of_part.contains(b)) add(of_part[a], of_part[b]);
  }
  for (const auto& [a, b] : model_.kept_apart) {
    if (of_link.contains(a) && of_link.contains(b)) add(of_link[a], of_link[b]);
  }
  for (auto a = of_kind.begin(); a != of_kind.end(); ++a) {
    for (auto b = a; b != of_kind.end() && apart.size() <= most; ++b) {
      if (!may_touch(a->first, b->first)) add(a->second, b->second);
    }
  }
  return apart.size() > most ? std::nullopt : std::optional(std::move(apart));
}

void settle_contacts(LinkModel& model, const Touching& touching, const std::vector<ShapeSource>& sources,
                     Scene& scene) {
  std::optional<Touching::Pairs> apart = touching.kept_apart(sources, kMostApart);
  if (!apart) {
    for (const ShapeSource& source : sources) scene.bodies[source.body].collides = false;
    return model.left_out.add(model.name, "touching",
                              fmt::format("the file keeps more than {} pairs apart: nothing touches", kMostApart));
  }
  if (model.keeps_overlaps_apart) keep_overlaps_apart(model, sources, scene, *apart);
  for (const auto& [a, b] : *apart) {
    if (can_meet(scene.bodies[sources[a].body], scene.bodies[sources[b].body]))
      scene.contact_pairs.push_back({sources[a].body, sources[b].body, kApart});
  }
  set_laws(model, sources, *apart, scene);
}

}  // namespace rigor
