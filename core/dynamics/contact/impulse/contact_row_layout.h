// Contact constraints as rows of the vector kernels (kernels/contact_rows.h). Pairs of bodies that share no moving body
// are independent. Up to eight of them are solved at once, and threads share them, with the same result. For this,
// pairs get colours: each pair, in order, gets the first colour that no other pair of its moving bodies has. The pairs
// of one colour are contiguous, and sequential impulses process one colour after another.
#pragma once

#include <array>
#include <vector>

#include "core/dynamics/contact/impulse/manifolds.h"
#include "core/dynamics/kernels/contact_rows.h"
#include "core/dynamics/model/system.h"

namespace rigor::inline dynamics {

// Rows that nothing acts on.
void clear_rows(const RowGroup& group);
// Gives the groups their blocks of these rows; the rows suffice for all.
void place_rows(std::vector<RowGroup>& groups, AlignedDoubles& rows);

class ContactRowLayout {
 public:
  // The gap of a row that stands for no point: it never closes.
  static constexpr double kNoPoint = 1e30;  // m
  struct Share {
    std::size_t begin, end;  // groups
    std::size_t size() const { return end - begin; }
  };

  ContactRowLayout(const Scene& scene, const System& system, std::size_t threads);

  // The record (see SolverBodies) that rows without a constraint read; after it one for each thread, which they write.
  std::size_t idle_body() const { return static_cast<std::size_t>(idle_); }
  std::size_t records() const { return idle_body() + 1 + threads_; }

  // Lays these constraints out, which are sorted by pair. `are_impulses_known`: from a sub-step before.
  void assign(const std::vector<ContactConstraint>& constraints, bool are_impulses_known);
  // Writes the rows of a thread's groups, impulses times `impulse_scale`, with their effective masses.
  void fill(const std::vector<ContactConstraint>& constraints, double impulse_scale, const SolverBodies& bodies,
            std::size_t thread);
  // Impulses of a thread's rows back to the constraints they were assigned from.
  void store_impulses(std::vector<ContactConstraint>& constraints, std::size_t thread) const;

  // Points that carry a load at rest from the start. A soft constraint carries it only by an overlap, so a stack would
  // sag and rock at first. Their gaps count from that overlap on, which leaves the bodies where they are.
  void carry_without_overlap(std::vector<ContactConstraint>& constraints, const SolverParameters& parameters);

  // Adds the impulse of each constraint, on its body a, to its place in `impulses` [N s, in W].
  void add_impulses(const std::vector<ContactConstraint>& constraints, Vec3* impulses) const;
  // The places at which the rows of so many constraints keep their normal impulses [N s], until the next assign().
  std::vector<const double*> normal_impulses(std::size_t constraints) const;
  // The constraint that a row stands for; `first` is the row's element of column 0.
  std::size_t constraint_of(const double* first) const;

  std::size_t colours() const { return first_group_.size() / kKinds; }
  Share share(std::size_t colour, std::size_t thread) const;
  const std::vector<RowGroup>& groups() const { return groups_; }
  bool has_restitution() const { return has_restitution_; }
  // Those that one pass does not bring to rest, in the order of groups: deep overlaps, or all rows without known
  // impulses.
  const std::vector<RowPlace>& rows_of_many_passes() const { return rows_of_many_passes_; }

 private:
  static constexpr std::size_t kMostPoints = 4;  // of a pair in one group
  static constexpr std::size_t kKinds =
      kMostPoints + 1;  // groups of a colour: of balls, and of any bodies with 1 to 4 points
  static constexpr std::size_t kFirstColours = 64;
  struct Colours {
    std::uint64_t first = 0;           // a bit each: that a pair of the body has
    std::size_t next = kFirstColours;  // beyond these, later than which none has
  };
  struct Pair {
    std::size_t first, points;          // among the constraints
    std::size_t kind_of_colour, place;  // which of all kinds of all colours; among the pairs of that
  };
  void colour_pairs(const std::vector<ContactConstraint>& constraints);
  std::size_t colour_of(int a, int b);
  void form_groups();
  void find_rows_of_many_passes(const std::vector<ContactConstraint>& constraints, bool are_impulses_known);
  void fetch_group(std::size_t number, const std::vector<ContactConstraint>& constraints) const;
  void fill_group(std::size_t number, const std::vector<ContactConstraint>& constraints, double impulse_scale,
                  std::size_t thread);
  static Vec3 friction_impulse(const RowGroup& group, double* block, std::size_t k, const Vec3& normal);
  template <typename Visit>
  void for_each_row(std::size_t thread, const Visit& visit) const;

  const System& system_;
  std::size_t threads_;
  std::int32_t idle_;
  std::vector<char> is_round_;       // by body: fixed, or a ball
  std::vector<Colours> colours_of_;  // by body
  std::vector<Pair> pairs_;
  std::vector<std::size_t> first_group_;  // by kind of colour
  std::vector<RowGroup> groups_;
  std::vector<std::array<std::int32_t, kRowsPerBlock>> pairs_of_group_;  // -1: none
  AlignedDoubles rows_;
  std::vector<RowPlace> rows_of_many_passes_;
  bool has_restitution_ = false, has_deep_ = false;
};

}  // namespace rigor::inline dynamics
