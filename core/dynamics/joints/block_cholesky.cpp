#include "core/dynamics/joints/block_cholesky.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <set>

namespace rigor {
namespace {

constexpr double kInfinite = 1e150;  // its square is a number, too

}  // namespace

BlockCholesky::BlockCholesky(std::vector<int> rows, const std::vector<std::pair<int, int>>& coupled)
    : rows_(std::move(rows)), diagonal_(rows_.size()), scale_(rows_.size()), kept_(rows_.size()) {
  order(coupled);
  list_products();
  for (std::size_t p = 0; p < size(); ++p) {
    rank_.push_back(rows_[joint_[p]]);
    for (int k = 0; k < kMostRows; ++k) kept_[p][k] = k < rows_[joint_[p]] ? 1 : 0;
  }
  blocks_.resize(row_below_.size());
}

// Eliminates the joint with the fewest neighbours, which then all become each other's; the first of equals.
void BlockCholesky::order(const std::vector<std::pair<int, int>>& coupled) {
  std::vector<std::set<int>> neighbours(size());
  for (const auto& [a, b] : coupled) {
    if (a != b) neighbours[a].insert(b), neighbours[b].insert(a);
  }
  std::set<std::pair<std::size_t, int>> queue;
  for (std::size_t j = 0; j < size(); ++j) queue.insert({neighbours[j].size(), static_cast<int>(j)});
  std::vector<std::vector<int>> below(size());
  position_.resize(size());
  while (!queue.empty()) {
    const int joint = queue.begin()->second;
    queue.erase(queue.begin());
    position_[joint] = joint_.size();
    const std::vector<int> around(neighbours[joint].begin(), neighbours[joint].end());
    for (const int n : around) {
      queue.erase({neighbours[n].size(), n});
      neighbours[n].erase(joint);
      for (const int m : around) {
        if (m != n) neighbours[n].insert(m);
      }
      queue.insert({neighbours[n].size(), n});
    }
    below[joint_.size()] = around;
    joint_.push_back(static_cast<std::size_t>(joint));
  }
  for (std::size_t p = 0; p < size(); ++p) {
    first_below_.push_back(static_cast<std::int32_t>(row_below_.size()));
    for (const int joint : below[p]) row_below_.push_back(static_cast<std::int32_t>(position_[joint]));
    std::sort(row_below_.begin() + first_below_.back(), row_below_.end());
  }
  first_below_.push_back(static_cast<std::int32_t>(row_below_.size()));
}

void BlockCholesky::list_products() {
  for (std::size_t p = 0; p < size(); ++p) {
    first_target_.push_back(target_.size());
    for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u) {
      for (std::int32_t l = u; l < first_below_[p + 1]; ++l) {
        const std::int32_t column = row_below_[u], row = row_below_[l];
        target_.push_back(row == column ? ~column
                                        : place(static_cast<int>(joint_[row]), static_cast<int>(joint_[column])).index);
      }
    }
  }
}

BlockCholesky::Place BlockCholesky::place(int first, int second) const {
  std::size_t row = position_[first], column = position_[second];
  const bool transposed = row < column;
  if (transposed) std::swap(row, column);
  const auto begin = row_below_.begin() + first_below_[column], end = row_below_.begin() + first_below_[column + 1];
  const auto found = std::lower_bound(begin, end, static_cast<std::int32_t>(row));
  assert(found != end && *found == static_cast<std::int32_t>(row) &&
         "the joints share a body, or came to by filling in");
  return {static_cast<std::int32_t>(found - row_below_.begin()), transposed};
}

void BlockCholesky::clear() {
  std::fill(diagonal_.begin(), diagonal_.end(), Block6::Zero());
  std::fill(blocks_.begin(), blocks_.end(), Block6::Zero());
}

void BlockCholesky::find_ranks() {
  for (std::size_t p = 0; p < size(); ++p) scale_[p] = diagonal_[p].diagonal();
  for (std::size_t p = 0; p < size(); ++p) eliminate(p, true, true);
}

int BlockCholesky::rank() const { return std::accumulate(rank_.begin(), rank_.end(), 0); }

void BlockCholesky::factorise(bool choose) {
  smallest_pivot_ = 1;
  for (std::size_t p = 0; p < size(); ++p) scale_[p] = diagonal_[p].diagonal();
  for (std::size_t p = 0; p < size(); ++p) eliminate(p, choose, false);
}

void BlockCholesky::eliminate(std::size_t p, bool choose, bool find_rank) {
  const int rows = rows_[joint_[p]];
  if (find_rank || (choose && rank_[p] < rows)) choose_rows(p, find_rank);
  Block6& D = diagonal_[p];
  const bool all = rank_[p] == kMostRows;
  if (!all) {
    for (int k = 0; k < kMostRows; ++k) {
      if (kept_[p][k] == 0) D.row(k).setZero(), D.col(k).setZero(), D(k, k) = 1;
    }
  }
  factorise_diagonal(p, scale_[p]);
  for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u) {
    Block6& B = blocks_[u];
    if (!all) B *= kept_[p].asDiagonal();
    D.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(B);
  }
  std::size_t target = first_target_[p];
  for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u) {
    for (std::int32_t l = u; l < first_below_[p + 1]; ++l, ++target) {
      Block6& to = target_[target] < 0 ? diagonal_[~target_[target]] : blocks_[target_[target]];
      to.noalias() -= blocks_[l].lazyProduct(blocks_[u].transpose());
    }
  }
}

// The Cholesky factor of a small block with the largest remaining pivot first, each relative to its row's own scale:
// which rows are taken is all that is wanted of it.
void BlockCholesky::choose_rows(std::size_t p, bool find_rank) {
  const int rows = rows_[joint_[p]];
  Block6 left = diagonal_[p];
  kept_[p].setZero();
  int taken = 0;
  for (; taken < (find_rank ? rows : rank_[p]); ++taken) {
    int best = -1;
    double most = find_rank ? kZero : -1;
    for (int k = 0; k < rows; ++k) {
      const double pivot = left(k, k) / scale_[p][k];
      if (kept_[p][k] == 0 && pivot > most) most = pivot, best = k;
    }
    if (best < 0) break;
    kept_[p][best] = 1;
    const Vec6 column = left.col(best);
    left -= column * column.transpose() / left(best, best);
  }
  if (find_rank) rank_[p] = taken;
  has_redundant_ |= rank_[p] < rows;
}

void BlockCholesky::factorise_diagonal(std::size_t p, const Vec6& scale) {
  Block6& D = diagonal_[p];
  for (int k = 0; k < kMostRows; ++k) {
    double pivot = D(k, k);
    for (int l = 0; l < k; ++l) pivot -= D(k, l) * D(k, l);
    if (kept_[p][k] != 0 && !(pivot >= smallest_pivot_ * scale[k])) {
      smallest_pivot_ = pivot / scale[k];
      joint_of_smallest_ = joint_[p];
    }
    // What is lost in rounding counts as infinite, which leaves its row out; whoever asks smallest_pivot() knows.
    const double root = pivot > kLost * scale[k] || kept_[p][k] == 0 ? std::sqrt(pivot) : kInfinite;
    D(k, k) = root;
    for (int i = k + 1; i < kMostRows; ++i) {
      double sum = D(i, k);
      for (int l = 0; l < k; ++l) sum -= D(i, l) * D(k, l);
      D(i, k) = sum / root;
    }
  }
}

void BlockCholesky::solve(std::vector<Vec6>& x) const {
  for (std::size_t p = 0; p < size(); ++p) {
    Vec6& at = x[joint_[p]];
    at = at.cwiseProduct(kept_[p]);
    diagonal_[p].triangularView<Eigen::Lower>().solveInPlace(at);
    for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u)
      x[joint_[row_below_[u]]].noalias() -= blocks_[u].lazyProduct(at);
  }
  for (std::size_t p = size(); p-- > 0;) {
    Vec6& at = x[joint_[p]];
    for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u)
      at.noalias() -= blocks_[u].transpose().lazyProduct(x[joint_[row_below_[u]]]);
    diagonal_[p].triangularView<Eigen::Lower>().transpose().solveInPlace(at);
  }
}

}  // namespace rigor
