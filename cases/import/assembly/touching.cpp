#include "cases/import/assembly/touching.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "cases/import/assembly/rigid_groups.h"

#include "core/base/error.h"
#include "core/dynamics/collision/broad_phase.h"
#include "core/dynamics/collision/narrow_phase.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline imports {
namespace {

constexpr std::size_t kMostRows = 100000;  // pairs with a law of their own
constexpr std::size_t kMostSources = 3000;

Pose pose_of(const Body& body) { return {body.position, matrix_of(body.orientation)}; }

double gap_of(const Body& a, const Body& b) {
  Manifold manifold;
  collide(*a.shape, pose_of(a), *b.shape, pose_of(b), manifold);
  double gap = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& point : manifold) gap = std::min(gap, point.gap);
  return gap;
}

// Returns the pairs of sources whose bodies overlap at the start.
Touching::Pairs overlapping(const std::vector<ContactSource>& sources, const Scene& scene) {
  std::vector<Aabb> boxes;
  for (const ContactSource& source : sources) {
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

// The law of two shapes.
ContactLaw law_of(const LinkModel& model, const LinkShape& a, const LinkShape& b) {
  const LinkShape* chosen = a.priority > b.priority ? &a : b.priority > a.priority ? &b : nullptr;
  ContactLaw law = chosen ? chosen->surface : a.surface;
  if (!chosen) {
    for (double ContactLaw::*value : {&ContactLaw::restitution, &ContactLaw::friction, &ContactLaw::torsional_friction,
                                      &ContactLaw::rolling_friction})
      law.*value = model.combine(a.surface.*value, b.surface.*value);
  }
  const int dimensions = chosen ? chosen->dimensions : std::max(a.dimensions, b.dimensions);
  if (dimensions < 3) law.friction = 0;
  if (dimensions < 4) law.torsional_friction = 0;
  if (dimensions < 6) law.rolling_friction = 0;
  return law;
}

auto numbers_of(const ContactLaw& law) {
  return std::tuple(law.restitution, law.friction, law.collides, law.torsional_friction, law.rolling_friction);
}
bool same(const ContactLaw& a, const ContactLaw& b) { return numbers_of(a) == numbers_of(b); }

// Finds the law of each pair of sources.
class PairLaws {
 public:
  PairLaws(LinkModel& model, const Touching& touching, const std::vector<ContactSource>& sources, const Scene& scene)
      : model_(model), touching_(touching), sources_(sources), scene_(scene) {}

  std::vector<ContactPair> rows(ContactLaw& usual) {
    if (model_.keeps_overlaps_apart) overlaps_ = overlapping(sources_, scene_);
    std::vector<ContactPair> all;
    for (int i = 0; i < static_cast<int>(sources_.size()); ++i) {
      for (int j = 0; j < i; ++j) {
        if (can_meet(scene_.bodies[sources_[j].body], scene_.bodies[sources_[i].body]))
          all.push_back({sources_[j].body, sources_[i].body, law_of_pair(j, i)});
      }
    }
    usual = most_frequent(all);
    std::erase_if(all, [&](const ContactPair& row) { return same(row.law, usual); });
    if (all.size() > kMostRows)
      throw InputError(fmt::format("its contact filters need {} rows of pairs; allowed: {}", all.size(), kMostRows));
    return all;
  }

 private:
  ContactLaw law_of_pair(int a, int b) {
    const ContactSource &first = sources_[a], &second = sources_[b];
    if (touching_.are_joined(first, second)) return kApart;
    const auto [law, are_alike] = law_of_shapes(first, second);
    if (!law.collides) return kApart;
    if (overlaps_.contains(std::minmax({a, b}))) {
      model_.left_out.add(
          first.parts.front().shape->where, "touching",
          assumed(fmt::format("overlaps '{}' at the start: these two never touch", scene_.bodies[second.body].name)));
      return kApart;
    }
    if (!are_alike)
      model_.left_out.add(first.parts.front().shape->where, "surfaces that differ within a body",
                          lost("a pair of bodies has one law of contact in a scene"));
    return law;
  }

  // The law of the first pair of shapes that may touch, and whether all pairs have it.
  std::pair<ContactLaw, bool> law_of_shapes(const ContactSource& a, const ContactSource& b) const {
    std::optional<ContactLaw> found;
    bool are_alike = true, some_are_apart = false;
    for (const ContactSource::Part& one : a.parts) {
      for (const ContactSource::Part& other : b.parts) {
        if (!touching_.may_touch(one, other)) {
          some_are_apart = true;
          continue;
        }
        const ContactLaw law = law_of(model_, *one.shape, *other.shape);
        if (found && !same(*found, law)) are_alike = false;
        if (!found) found = law;
      }
    }
    if (!found) return {kApart, true};
    return {*found, are_alike && !some_are_apart};
  }

  // The pairs that touch; without any, of shapes against their like.
  ContactLaw most_frequent(const std::vector<ContactPair>& rows) const {
    std::map<decltype(numbers_of(ContactLaw())), std::pair<int, ContactLaw>> count;
    const auto see = [&](const ContactLaw& law) {
      auto& [times, seen] = count[numbers_of(law)];
      ++times, seen = law;
    };
    for (const ContactPair& row : rows) {
      if (row.law.collides) see(row.law);
    }
    for (const ContactSource& source : count.empty() ? sources_ : std::vector<ContactSource>()) {
      for (const ContactSource::Part& part : source.parts) see(law_of(model_, *part.shape, *part.shape));
    }
    const auto most = std::max_element(count.begin(), count.end(),
                                       [](const auto& a, const auto& b) { return a.second.first < b.second.first; });
    return most == count.end() ? ContactLaw{} : most->second.second;
  }

  LinkModel& model_;
  const Touching& touching_;
  const std::vector<ContactSource>& sources_;
  const Scene& scene_;
  Touching::Pairs overlaps_;
};

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
    if (!row.is_loop && a != kWorld && b != kWorld && part_[a] != part_[b])
      joined_.insert(std::minmax({part_[a], part_[b]}));
  }
  for (const auto& [a, b] : model.kept_apart) apart_.insert(std::minmax({a, b}));
}

// A part is named by one of its links. A link without mass between two joints belongs to the link below it.
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
    const int a = row.joint.a, b = row.joint.b;
    if (a == kWorld || b == kWorld || row.is_loop) continue;
    if (std::holds_alternative<FixedJoint>(row.joint.type) || body_[a] == RigidGroups::kBetween) join(a, b);
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

bool Touching::may_touch(const ContactSource::Part& a, const ContactSource::Part& b) const {
  const auto named = [&](const ContactSource::Part& part) { return body_[part.link] == kWorld ? kWorld : part.link; };
  if (apart_.contains(std::minmax({named(a), named(b)})) || apart_.contains(std::minmax({a.link, b.link})))
    return false;
  return may_touch(kind_of(a.link, *a.shape), kind_of(b.link, *b.shape));
}

bool Touching::can_be_touched(int link, const LinkShape& shape) const {
  const Kind own = kind_of(link, shape);
  return std::any_of(kinds_.begin(), kinds_.end(), [&](const auto& row) {
    const auto& [kind, bodies] = row;
    const bool is_another = bodies.size() > 1 || *bodies.begin() != body_[link];
    return is_another && may_touch(own, kind);
  });
}

bool Touching::are_joined(const ContactSource& a, const ContactSource& b) const {
  const std::pair<int, int> parts = std::minmax({part_[a.link], part_[b.link]});
  return parts.first == parts.second || joined_.contains(parts);
}

void settle_contacts(LinkModel& model, const Touching& touching, const std::vector<ContactSource>& sources,
                     Scene& scene) {
  if (sources.size() > kMostSources)
    throw InputError(fmt::format("{} of its bodies collide; allowed: {}", sources.size(), kMostSources));
  scene.contact_pairs = PairLaws(model, touching, sources, scene).rows(scene.contact_default);
}

}  // namespace rigor::inline imports
