#include "core/dynamics/contact/impulse/contact_row_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/dynamics/kernels/contact_kernels.h"

namespace rigor::inline dynamics {
namespace {

double& at(double* block, int column, std::size_t k) {
  return block[static_cast<std::size_t>(column) * kRowsPerBlock + k];
}
void set_vector(double* block, int column, std::size_t k, const Vec3& x) {
  for (int c = 0; c < 3; ++c) at(block, column + c, k) = x[c];
}
Vec3 vector(double* block, int column, std::size_t k) {
  return {at(block, column, k), at(block, column + 1, k), at(block, column + 2, k)};
}

// A fixed body, or one whose contact points lie where the normal leaves its centre, and that turns alike about all
// axes.
bool is_round(const Body& body, const Inertia& inertia) {
  const Mat3& I = inertia.inertia_B;
  return inertia.fixed || (body.shape && std::holds_alternative<Sphere>(*body.shape) && I.isDiagonal(0) &&
                           I(0, 0) == I(1, 1) && I(1, 1) == I(2, 2));
}

void fill_row(double* block, std::size_t k, bool of_balls, const ContactConstraint& constraint, double impulse_scale) {
  set_vector(block, kNormal, k, constraint.normal);
  set_vector(block, kFrictionImpulse, k, impulse_scale * constraint.friction_impulse);
  at(block, kImpulse, k) = impulse_scale * constraint.normal_impulse;
  at(block, kInitialGap, k) = constraint.gap - constraint.rest_overlap;
  at(block, kFriction, k) = constraint.friction;
  at(block, kRestitution, k) = constraint.restitution;
  if (of_balls) {
    at(block, kLengthA, k) = -constraint.normal.dot(constraint.arm_a);
    at(block, kLengthB, k) = constraint.normal.dot(constraint.arm_b);
  } else {
    set_vector(block, kArmA, k, constraint.arm_a), set_vector(block, kArmB, k, constraint.arm_b);
  }
}

}  // namespace

void clear_rows(const RowGroup& group) {
  for (std::int32_t point = 0; point < group.points; ++point) {
    double* block = group.block(static_cast<std::size_t>(point));
    std::fill_n(block, group.columns() * kRowsPerBlock, 0.0);
    std::fill_n(&at(block, kNormal, 0), kRowsPerBlock, 1.0);
    std::fill_n(&at(block, kNormalMass, 0), kRowsPerBlock, 1.0);
    std::fill_n(&at(block, kInitialGap, 0), kRowsPerBlock, ContactRowLayout::kNoPoint);
    // No impulse, however the bodies of the pair move: else its changes would keep sweeps going.
    std::fill_n(&at(block, kBias, 0), kRowsPerBlock, ContactRowLayout::kNoPoint);
  }
}

void place_rows(std::vector<RowGroup>& groups, AlignedDoubles& rows) {
  std::size_t size = 0;
  for (const RowGroup& group : groups) size += group.columns() * kRowsPerBlock * static_cast<std::size_t>(group.points);
  if (rows.size() < size) rows.resize(size + size / 4);
  double* next = rows.data();
  for (RowGroup& group : groups) {
    group.rows = next;
    next = group.block(static_cast<std::size_t>(group.points));
  }
}

ContactRowLayout::ContactRowLayout(const Scene& scene, const System& system, std::size_t threads)
    : system_(system),
      threads_(threads),
      idle_(static_cast<std::int32_t>(column_stride(system.size()))),
      colours_of_(system.size()) {
  for (std::size_t i = 0; i < system.size(); ++i) is_round_.push_back(is_round(scene.bodies[i], system.bodies[i]));
}

void ContactRowLayout::assign(const std::vector<ContactConstraint>& constraints, bool are_impulses_known) {
  colour_pairs(constraints);
  form_groups();
  rows_of_many_passes_.clear();
  if (has_deep_ || !are_impulses_known) find_rows_of_many_passes(constraints, are_impulses_known);
}

void ContactRowLayout::colour_pairs(const std::vector<ContactConstraint>& constraints) {
  std::fill(colours_of_.begin(), colours_of_.end(), Colours());
  pairs_.clear(), first_group_.clear();
  has_restitution_ = has_deep_ = false;
  for (std::size_t first = 0; first < constraints.size(); first += pairs_.back().points) {
    const auto [a, b] = std::pair(constraints[first].a, constraints[first].b);
    std::size_t last = first;
    // Bodies of several shapes, and those on surfaces, may have more points: these are several pairs, one after
    // another.
    for (; last < constraints.size() && last < first + kMostPoints && constraints[last].a == a &&
           constraints[last].b == b;
         ++last)
      has_deep_ = has_deep_ || constraints[last].is_deep;
    has_restitution_ = has_restitution_ || constraints[first].restitution > 0;
    const std::size_t points = last - first, kind = points == 1 && is_round_[a] && is_round_[b] ? 0 : points;
    const std::size_t kind_of_colour = kKinds * colour_of(a, b) + kind;
    if (kind_of_colour >= first_group_.size()) first_group_.resize(kKinds * (kind_of_colour / kKinds + 1), 0);
    pairs_.push_back({first, points, kind_of_colour, first_group_[kind_of_colour]++});
  }
}

// The first colour that no other pair with a moving body of these has.
std::size_t ContactRowLayout::colour_of(int a, int b) {
  Colours of_fixed_a, of_fixed_b;
  Colours& of_a = system_.bodies[a].fixed ? of_fixed_a : colours_of_[a];
  Colours& of_b = system_.bodies[b].fixed ? of_fixed_b : colours_of_[b];
  std::size_t colour = static_cast<std::size_t>(std::countr_one(of_a.first | of_b.first));
  if (colour < kFirstColours) {
    of_a.first |= std::uint64_t{1} << colour, of_b.first |= std::uint64_t{1} << colour;
  } else {
    colour = std::max(of_a.next, of_b.next);
    of_a.next = of_b.next = colour + 1;
  }
  return colour;
}

void ContactRowLayout::form_groups() {
  std::size_t groups = 0;
  for (std::size_t& pairs : first_group_) groups += (std::exchange(pairs, groups) + kRowsPerBlock - 1) / kRowsPerBlock;
  groups_.resize(groups);
  pairs_of_group_.resize(groups);
  for (auto& pairs : pairs_of_group_) pairs.fill(-1);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    const std::size_t group = first_group_[pair.kind_of_colour] + pair.place / kRowsPerBlock;
    pairs_of_group_[group][pair.place % kRowsPerBlock] = static_cast<std::int32_t>(i);
    groups_[group].points = static_cast<std::int32_t>(pair.points);
    groups_[group].of_balls = pair.kind_of_colour % kKinds == 0;
    groups_[group].colour = static_cast<std::int32_t>(pair.kind_of_colour / kKinds);
  }
  place_rows(groups_, rows_);
}

ContactRowLayout::Share ContactRowLayout::share(std::size_t colour, std::size_t thread) const {
  const std::size_t next = kKinds * (colour + 1), begin = first_group_[kKinds * colour],
                    end = next < first_group_.size() ? first_group_[next] : groups_.size();
  return {begin + (end - begin) * thread / threads_, begin + (end - begin) * (thread + 1) / threads_};
}

// Calls visit(group's number, its row, the constraint's number, the point) for a thread's rows.
template <typename Visit>
void ContactRowLayout::for_each_row(std::size_t thread, const Visit& visit) const {
  for (std::size_t colour = 0; colour < colours(); ++colour) {
    const Share share = this->share(colour, thread);
    for (std::size_t g = share.begin; g < share.end; ++g) {
      for (std::size_t k = 0; k < kRowsPerBlock; ++k) {
        if (pairs_of_group_[g][k] < 0) continue;
        const Pair& pair = pairs_[static_cast<std::size_t>(pairs_of_group_[g][k])];
        for (std::size_t point = 0; point < pair.points; ++point) visit(g, k, pair.first + point, point);
      }
    }
  }
}

void ContactRowLayout::fill(const std::vector<ContactConstraint>& constraints, double impulse_scale,
                            const SolverBodies& bodies, std::size_t thread) {
  for (std::size_t colour = 0; colour < colours(); ++colour) {
    const Share share = this->share(colour, thread);
    for (std::size_t g = share.begin; g < share.end; ++g) {
      if (g + 1 < share.end) fetch_group(g + 1, constraints);
      fill_group(g, constraints, impulse_scale, thread);
      contact_kernels().prepare_rows(&groups_[g], 1, bodies);
    }
  }
}

// The constraints of a group lie anywhere among all.
void ContactRowLayout::fetch_group(std::size_t number, const std::vector<ContactConstraint>& constraints) const {
  for (const std::int32_t pair : pairs_of_group_[number]) {
    if (pair < 0) continue;
    const char* constraint = reinterpret_cast<const char*>(&constraints[pairs_[static_cast<std::size_t>(pair)].first]);
    for (std::size_t line = 0; line <= sizeof(ContactConstraint); line += kCacheLine)
      __builtin_prefetch(constraint + line, 1);
  }
}

void ContactRowLayout::fill_group(std::size_t number, const std::vector<ContactConstraint>& constraints,
                                  double impulse_scale, std::size_t thread) {
  RowGroup& group = groups_[number];
  if (pairs_of_group_[number].back() < 0) clear_rows(group);
  const std::int32_t to_none = idle_ + 1 + static_cast<std::int32_t>(thread);
  for (std::size_t k = 0; k < kRowsPerBlock; ++k) {
    group.a[k] = group.b[k] = idle_, group.to_a[k] = group.to_b[k] = to_none;
    if (pairs_of_group_[number][k] < 0) continue;
    const Pair& pair = pairs_[static_cast<std::size_t>(pairs_of_group_[number][k])];
    const ContactConstraint* points = &constraints[pair.first];
    group.a[k] = points->a, group.b[k] = points->b;
    if (!system_.bodies[points->a].fixed) group.to_a[k] = points->a;
    if (!system_.bodies[points->b].fixed) group.to_b[k] = points->b;
    for (std::size_t p = 0; p < pair.points; ++p) fill_row(group.block(p), k, group.of_balls, points[p], impulse_scale);
  }
}

void ContactRowLayout::find_rows_of_many_passes(const std::vector<ContactConstraint>& constraints,
                                                bool are_impulses_known) {
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    for_each_row(thread, [&](std::size_t group, std::size_t k, std::size_t i, std::size_t point) {
      if (are_impulses_known && !constraints[i].is_deep) return;
      rows_of_many_passes_.push_back(
          {static_cast<std::int32_t>(group), static_cast<std::int16_t>(point), static_cast<std::int16_t>(k)});
    });
  }
  // Their order says nothing of which thread found them.
  std::sort(rows_of_many_passes_.begin(), rows_of_many_passes_.end(), [](const RowPlace& x, const RowPlace& y) {
    return std::tuple(x.group, x.lane, x.point) < std::tuple(y.group, y.lane, y.point);
  });
}

void ContactRowLayout::store_impulses(std::vector<ContactConstraint>& constraints, std::size_t thread) const {
  for_each_row(thread, [&](std::size_t g, std::size_t k, std::size_t i, std::size_t point) {
    ContactConstraint& constraint = constraints[i];
    double* block = groups_[g].block(point);
    constraint.normal_impulse = at(block, kImpulse, k);
    constraint.friction_impulse = friction_impulse(groups_[g], block, k, constraint.normal);
  });
}

// At rest with an overlap x, a soft constraint keeps its impulse p if mass_scale bias_rate x = impulse_scale k p.
void ContactRowLayout::carry_without_overlap(std::vector<ContactConstraint>& constraints,
                                             const SolverParameters& parameters) {
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    for_each_row(thread, [&](std::size_t g, std::size_t k, std::size_t i, std::size_t point) {
      double* block = groups_[g].block(point);
      const bool is_at_rest = std::abs(at(block, kApproachSpeed, k)) <= parameters.tolerance;
      if (!is_at_rest || constraints[i].is_deep) return;
      const double push =
          parameters.impulse_scale * at(block, kImpulse, k) / at(block, kNormalMass, k) / parameters.mass_scale;
      if (push > parameters.max_push_speed) return;
      constraints[i].rest_overlap = push / parameters.bias_rate;
      at(block, kInitialGap, k) -= constraints[i].rest_overlap;
    });
  }
}

// In W. Rows of balls hold it so, others by two tangents.
Vec3 ContactRowLayout::friction_impulse(const RowGroup& group, double* block, std::size_t k, const Vec3& normal) {
  const Vec3 p = vector(block, kFrictionImpulse, k);
  if (group.of_balls) return p;
  const Vec3 t = vector(block, kTangent, k);
  return p.x() * t + p.y() * normal.cross(t);
}

void ContactRowLayout::add_impulses(const std::vector<ContactConstraint>& constraints, Vec3* impulses) const {
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    for_each_row(thread, [&](std::size_t g, std::size_t k, std::size_t i, std::size_t point) {
      double* block = groups_[g].block(point);
      const Vec3& normal = constraints[i].normal;
      impulses[i] += at(block, kImpulse, k) * normal + friction_impulse(groups_[g], block, k, normal);
    });
  }
}

std::vector<const double*> ContactRowLayout::normal_impulses(std::size_t constraints) const {
  std::vector<const double*> places(constraints, nullptr);
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    for_each_row(thread, [&](std::size_t g, std::size_t k, std::size_t i, std::size_t point) {
      places[i] = &at(groups_[g].block(point), kImpulse, k);
    });
  }
  return places;
}

std::size_t ContactRowLayout::constraint_of(const double* first) const {
  const auto next = std::upper_bound(groups_.begin(), groups_.end(), first,
                                     [](const double* row, const RowGroup& group) { return row < group.rows; });
  const RowGroup& group = *std::prev(next);
  const auto offset = static_cast<std::size_t>(first - group.rows), size = group.columns() * kRowsPerBlock;
  const auto pair = pairs_of_group_[static_cast<std::size_t>(&group - groups_.data())][offset % size];
  return pairs_[static_cast<std::size_t>(pair)].first + offset / size;
}

}  // namespace rigor::inline dynamics
