#include "cases/metrics/measures/contact/tunnelling.h"

#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/shape_gap.h"

namespace rigor::inline metric {
namespace {

constexpr double kMostTurned = 2;  // rad between two instants, from which on orientations do not tell the turn

bool is_solid(const Body& body) { return body.collides && !std::holds_alternative<Plane>(*body.shape); }

// m, half the least width. Of a closed mesh its volume over its area, which is never more.
double half_width(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!mesh) return inradius(shape);
  const TriangleSurface& surface = *mesh->surface;
  double area = 0;
  for (const TriangleSurface::Triangle& triangle : surface.triangles) {
    const auto corner = [&](std::size_t k) { return surface.points[static_cast<std::size_t>(triangle.corners[k])]; };
    area += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return surface.volume / area;
}

BodyState part_way(const BodyState& from, const BodyState& to, double share) {
  BodyState state = from;
  state.position += share * (to.position - from.position);
  state.orientation = from.orientation.normalized().slerp(share, to.orientation.normalized());
  return state;
}

double turned(const BodyState& from, const BodyState& to) { return angle_between(from.orientation, to.orientation); }

}  // namespace

Tunnelling::Tunnelling(const Scene& scene) : scene_(scene), radii_(scene.bodies.size()), inradii_(scene.bodies.size()) {
  int solid = 0, moving = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (!is_solid(body)) continue;
    radii_[i] = bounding_radius(*body.shape), inradii_[i] = half_width(*body.shape);
    ++solid, moving += !body.fixed;
  }
  is_possible_ = solid > 1 && moving > 0;
}

std::optional<Passage> Tunnelling::go_on(double time, BodyColumns bodies, bool is_step) {
  if (!is_possible_) return {};
  std::optional<Passage> found;
  if (before_.size() > 0) {
    for (const Pair& pair : near_pairs(bodies)) {
      if (has_passed(pair, time - time_, bodies, is_step) && !found) found = {pair.first, pair.second, time};
    }
  }
  before_ = bodies, time_ = time;
  return found;
}

// Pairs whose bounding spheres meet on straight ways from the instant before to this one, in order.
std::vector<Tunnelling::Pair> Tunnelling::near_pairs(BodyColumns bodies) const {
  const BodyColumns before = before_.columns();
  struct Extent {
    double low, high;  // m, along x
    int body;
  };
  std::vector<Extent> extents;
  for (int i = 0; i < static_cast<int>(bodies.size()); ++i) {
    if (!is_solid(scene_.bodies[i])) continue;
    const auto [low, high] = std::minmax({before.position(i).x(), bodies.position(i).x()});
    extents.push_back({low - radii_[i], high + radii_[i], i});
  }
  std::sort(extents.begin(), extents.end(), [](const Extent& a, const Extent& b) { return a.low < b.low; });
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < extents.size(); ++k) {
    for (std::size_t l = k + 1; l < extents.size() && extents[l].low <= extents[k].high; ++l) {
      const auto [a, b] = std::minmax({extents[k].body, extents[l].body});
      if (scene_.bodies[a].fixed && scene_.bodies[b].fixed) continue;
      const Vec3 start = before.position(a) - before.position(b), way = bodies.position(a) - bodies.position(b) - start;
      const double share = way.squaredNorm() > 0 ? std::clamp(-start.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0;
      if ((start + share * way).norm() <= radii_[a] + radii_[b]) pairs.push_back({a, b});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

double Tunnelling::deep(const Pair& pair) const { return std::min(inradii_[pair.first], inradii_[pair.second]); }

double Tunnelling::gap(const Pair& pair, const BodyState& a, const BodyState& b) const {
  return shape_gap(*scene_.bodies[pair.first].shape, {a.position, a.orientation.normalized()},
                   *scene_.bodies[pair.second].shape, {b.position, b.orientation.normalized()});
}

Tunnelling::Path Tunnelling::path_of(int body, double h, BodyColumns bodies, bool is_step) const {
  const BodyState from = before_.columns().body(body), to = bodies.body(body);
  constexpr double kOfSinglePrecision = 1e-4, kOfNothing = 1e-9;  // of the way; m
  const Vec3 way = to.position - from.position;
  const bool is_straight = is_step && (way - h * to.velocity).norm() <= kOfSinglePrecision * way.norm() + kOfNothing;
  return {from, to, is_straight || scene_.bodies[body].fixed};
}

// An impact takes at least all of the velocity with which they approach. So a smaller change, beside gravity, says that
// they were not stopped.
bool Tunnelling::is_known(const Pair& pair, const Path& a, const Path& b, double h) const {
  if (a.is_straight && b.is_straight) return true;
  constexpr double kStep = 1e-3;  // of the way
  const auto touch = first_within(pair, a, b, 0);
  if (!touch) return false;
  const double here = std::max(*touch, kStep);
  const BodyState at_a = part_way(a.from, a.to, here), at_b = part_way(b.from, b.to, here);
  const double before = gap(pair, part_way(a.from, a.to, here - kStep), part_way(b.from, b.to, here - kStep));
  const double approach = (before - gap(pair, at_a, at_b)) / (kStep * h);  // m/s
  const auto pushed = [&](int body, const Path& path) {
    const Vec3 fall = scene_.bodies[body].fixed ? Vec3::Zero() : Vec3(h * scene_.gravity);
    return Vec3(path.to.velocity - path.from.velocity - fall);
  };
  return (pushed(pair.first, a) - pushed(pair.second, b)).norm() < 0.5 * approach;
}

// m, that their surfaces move relative to each other, at most.
double Tunnelling::length_of(const Pair& pair, const Path& a, const Path& b) const {
  return (a.to.position - a.from.position - b.to.position + b.from.position).norm() +
         turned(a.from, a.to) * radii_[pair.first] + turned(b.from, b.to) * radii_[pair.second];
}

// The gap falls no faster than the surfaces move, so that as much of the way is clear.
std::optional<double> Tunnelling::first_within(const Pair& pair, const Path& a, const Path& b, double nearest) const {
  const double way = length_of(pair, a, b);
  constexpr double kFine = 0.1;      // of the thickness that is passed, in which no more is missed
  constexpr int kMostPieces = 2000;  // of a way
  const double least = std::max(kFine * deep(pair), way / kMostPieces);
  for (double gone = 0; gone < way + least;) {
    const double share = way > 0 ? std::min(1.0, gone / way) : 0;
    const double apart = gap(pair, part_way(a.from, a.to, share), part_way(b.from, b.to, share)) - nearest;
    if (apart <= 0) return share;
    gone += std::max(apart, least);
  }
  return {};
}

bool Tunnelling::has_passed(const Pair& pair, double h, BodyColumns bodies, bool is_step) {
  const Path a = path_of(pair.first, h, bodies, is_step), b = path_of(pair.second, h, bodies, is_step);
  const double now = gap(pair, a.to, b.to);
  const auto known = overlapping_.find(pair);
  if (!(now > 0)) {
    const bool is_new = known == overlapping_.end();
    Overlapping& overlap = is_new ? overlapping_[pair] : known->second;
    if (is_new) overlap = {a.from, b.from, false, gap(pair, a.from, b.from) > 0};
    overlap.is_deep = overlap.is_deep || now < -deep(pair);
    return false;
  }
  if (known != overlapping_.end()) {
    const Overlapping overlap = known->second;
    overlapping_.erase(known);
    return overlap.was_apart && overlap.is_deep && is_beyond(pair, {overlap.a, a.to, false}, {overlap.b, b.to, false});
  }
  if (length_of(pair, a, b) <= 2 * deep(pair) || !(gap(pair, a.from, b.from) > 0)) return false;
  return is_beyond(pair, a, b) && is_known(pair, a, b, h);
}

// Whether the straight way from where they were last apart leads through the thinner one.
bool Tunnelling::is_beyond(const Pair& pair, const Path& a, const Path& b) const {
  if (turned(a.from, a.to) > kMostTurned || turned(b.from, b.to) > kMostTurned) return false;
  return first_within(pair, a, b, -deep(pair)).has_value();
}

}  // namespace rigor::inline metric
