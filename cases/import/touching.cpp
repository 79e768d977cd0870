#include "cases/import/touching.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "cases/import/rigid_groups.h"
#include "core/dynamics/collision/broad_phase.h"
#include "core/dynamics/collision/narrow_phase.h"

namespace rigor {
namespace {

constexpr std::size_t kMostPairs = 10000;  // rows of a case file that differ from its default

Pose pose_of(const Body& body) { return {body.position, matrix_of(body.orientation)}; }

double gap_of(const Body& a, const Body& b) {
  Manifold manifold;
  collide(*a.shape, pose_of(a), *b.shape, pose_of(b), manifold);
  double gap = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& point : manifold) gap = std::min(gap, point.gap);
  return gap;
}

// The pairs of sources whose bodies overlap.
std::vector<std::pair<int, int>> overlapping(const std::vector<ShapeSource>& sources, const Scene& scene) {
  std::vector<Aabb> boxes;
  for (const ShapeSource& source : sources) {
    const Body& body = scene.bodies[source.body];
    boxes.push_back(aabb_of(*body.shape, pose_of(body), 0));
  }
  std::vector<std::pair<int, int>> found;
  BroadPhase search;
  for (const auto& [a, b] : search.overlaps(boxes)) {
    const Body &first = scene.bodies[sources[a].body], &second = scene.bodies[sources[b].body];
    if (!(first.fixed && second.fixed) && gap_of(first, second) < 0) found.emplace_back(a, b);
  }
  return found;
}

// Of two shapes' surfaces.
ContactLaw law_of(const LinkModel& model, const LinkShape& a, const LinkShape& b) {
  return {model.combine(a.surface.restitution, b.surface.restitution),
          model.combine(a.surface.friction, b.surface.friction)};
}

bool same(const ContactLaw& a, const ContactLaw& b) {
  return a.restitution == b.restitution && a.friction == b.friction;
}

// The law that most shapes have among themselves is the default; pairs that differ get rows.
void set_laws(LinkModel& model, const std::vector<ShapeSource>& sources, Scene& scene) {
  std::vector<const LinkShape*> shapes;
  std::map<std::pair<double, double>, std::pair<int, const LinkShape*>> count;
  for (const ShapeSource& source : sources) {
    if (!scene.bodies[source.body].collides) continue;
    auto& [number, shape] = count[{source.shape->surface.restitution, source.shape->surface.friction}];
    ++number, shape = source.shape;
  }
  if (count.empty()) return;
  const auto most = std::max_element(count.begin(), count.end(),
                                     [](const auto& a, const auto& b) { return a.second.first < b.second.first; });
  const LinkShape& usual = *most->second.second;
  scene.contact_default = law_of(model, usual, usual);
  if (count.size() == 1) return;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Body &a = scene.bodies[sources[j].body], &b = scene.bodies[sources[i].body];
      if (!a.collides || !b.collides || (a.fixed && b.fixed)) continue;
      const ContactLaw law = law_of(model, *sources[j].shape, *sources[i].shape);
      if (same(law, scene.contact_default)) continue;
      if (scene.contact_pairs.size() == kMostPairs) {
        scene.contact_pairs.clear();
        return model.left_out.add(model.name, "surfaces that differ",
                                  fmt::format("more than {} pairs would have rows of their own: all have friction {:g}",
                                              kMostPairs, scene.contact_default.friction));
      }
      scene.contact_pairs.push_back({sources[j].body, sources[i].body, law});
    }
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
  const auto keep_apart = [&](int a, int b) {
    const int first = a == kWorld ? kWorld : body[a], second = b == kWorld ? kWorld : body[b];
    apart_.insert(std::minmax(first, second));
  };
  for (const LinkJoint& row : model.joints) {
    if (row.joint.a != kWorld) keep_apart(row.joint.a, row.joint.b);  // what hangs on the world may touch its floor
  }
  for (const auto& [a, b] : model.kept_apart) keep_apart(a, b);
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
  for (const auto& [kind, bodies] : kinds_) {
    const bool is_another = bodies.size() > 1 || *bodies.begin() != body_[link];
    if (is_another && may_touch(own, kind)) return true;
  }
  return false;
}

bool Touching::may_touch(int link_a, const LinkShape& a, int link_b, const LinkShape& b) const {
  if (body_[link_a] == body_[link_b]) return false;
  if (apart_.contains(std::minmax(body_[link_a], body_[link_b]))) return false;
  return may_touch(kind_of(link_a, a), kind_of(link_b, b));
}

void settle_contacts(LinkModel& model, const Touching& touching, const std::vector<ShapeSource>& sources,
                     Scene& scene) {
  const std::vector<int> depth = depths(model);
  std::vector<std::vector<int>> clashes(sources.size());
  for (const auto& [a, b] : overlapping(sources, scene)) {
    if (touching.may_touch(sources[a].link, *sources[a].shape, sources[b].link, *sources[b].shape)) continue;
    clashes[a].push_back(b), clashes[b].push_back(a);
  }
  std::vector<int> order(sources.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return depth[sources[a].link] > depth[sources[b].link]; });
  std::vector<bool> is_kept(sources.size(), false);
  for (const int i : order) {
    const auto clash = std::find_if(clashes[i].begin(), clashes[i].end(), [&](int other) { return is_kept[other]; });
    is_kept[i] = clash == clashes[i].end();
    if (is_kept[i]) continue;
    scene.bodies[sources[i].body].collides = false;
    model.left_out.add(sources[i].shape->where, "touching",
                       fmt::format("it overlaps '{}', which the file does not let it touch and a scene would",
                                   scene.bodies[sources[*clash].body].name));
  }
  const bool some_keep_apart = std::any_of(sources.begin(), sources.end(), [&](const ShapeSource& source) {
    return scene.bodies[source.body].collides && !scene.bodies[source.body].fixed &&
           !model.links[source.link].touches_own_model;
  });
  const auto colliding = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                       [](const Body& body) { return body.collides && !body.fixed; });
  if (some_keep_apart && colliding > 1)
    model.left_out.add(model.name, "links that do not touch each other",
                       "in a scene all that collide may: links of one model too");
  set_laws(model, sources, scene);
}

}  // namespace rigor
