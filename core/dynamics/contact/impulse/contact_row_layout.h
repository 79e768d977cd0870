// Contact constraints as rows of the vector kernels (kernels/contact_rows.h). Sequential impulses take the pairs of
// bodies in their order; pairs that share no moving body are independent, so that up to eight of them are solved at
// once with the same result. A pair's level is one more than that of the last pair before it that shares a moving body
// with it; the pairs of one level lie side by side.
#pragma once

#include <vector>

#include "core/dynamics/contact/impulse/manifolds.h"
#include "core/dynamics/kernels/contact_rows.h"
#include "core/dynamics/model/system.h"

namespace rigor {

class ContactRowLayout {
 public:
  explicit ContactRowLayout(const System& system);

  // The record (see SolverBodies) that rows without a constraint read; the one after it is what they write.
  std::size_t idle_body() const { return static_cast<std::size_t>(idle_); }
  // Rows for these constraints, which are sorted by pair; impulses times `impulse_scale`.
  void assign(const std::vector<ContactConstraint>& constraints, double impulse_scale);
  // The rows' impulses back to the constraints they were assigned from.
  void store_impulses(std::vector<ContactConstraint>& constraints) const;

  RowBlock* blocks() { return blocks_.data(); }
  std::size_t size() const { return blocks_.size(); }  // of blocks
  bool has_restitution() const { return has_restitution_; }
  // Of constraints that overlap deeply.
  const std::vector<std::int32_t>& deep_rows() const { return deep_rows_; }

 private:
  struct Pair {
    std::size_t first, points;    // among the constraints
    std::size_t level, of_level;  // its place among the pairs of that level
  };
  void sort_pairs_in_levels(const std::vector<ContactConstraint>& constraints);
  void place_rows(std::size_t constraints);
  void fill_row(const ContactConstraint& constraint, std::size_t row, double impulse_scale);

  const System& system_;
  std::int32_t idle_;
  std::vector<Pair> pairs_;
  std::vector<std::size_t> next_level_, pairs_of_level_;      // by body; then where a level's groups of eight begin
  std::vector<std::size_t> first_block_, row_of_constraint_;  // of eight pairs; of a constraint
  std::vector<RowBlock> blocks_;
  std::vector<std::int32_t> deep_rows_;
  bool has_restitution_ = false;
};

}  // namespace rigor
