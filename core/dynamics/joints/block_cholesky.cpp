#include "core/dynamics/joints/block_cholesky.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/dynamics/joints/small_blocks.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kInfinite = 1e150;  // its square is a number, too

}  // namespace

BlockCholesky::BlockCholesky(std::vector<int> rows, const std::vector<std::pair<int, int>>& coupled)
    : order_(rows.size(), coupled), rows_(std::move(rows)), scale_(rows_.size()), kept_(rows_.size()) {
  for (std::size_t p = 0; p < size(); ++p) {
    in_use_.push_back(rows_at(p));
    rank_.push_back(rows_at(p));
    for (int k = 0; k < kMostRows; ++k) kept_[p][k] = k < rows_at(p) ? 1 : 0;
  }
  lay_out();
}

void BlockCholesky::lay_out() {
  std::size_t end = 0;
  for (std::size_t p = 0; p < size(); ++p) {
    const int columns = rows_at(p);
    diagonal_start_.push_back(end);
    end += static_cast<std::size_t>(columns * columns);
    for (std::int32_t u = order_.first_below[p]; u < order_.first_below[p + 1]; ++u) {
      block_rows_.push_back(rows_at(static_cast<std::size_t>(order_.row_below[u])));
      block_columns_.push_back(columns);
      block_start_.push_back(end);
      end += static_cast<std::size_t>(block_rows_.back() * columns);
    }
  }
  values_.resize(end);
}

void BlockCholesky::clear() { std::fill(values_.begin(), values_.end(), 0.0); }

void BlockCholesky::note_scales() {
  for (std::size_t p = 0; p < size(); ++p) {
    const double* const D = diagonal_of(p);
    for (int k = 0, n = rows_at(p); k < n; ++k) scale_[p][k] = D[k + k * n];
  }
}

void BlockCholesky::find_ranks() {
  has_redundant_ = false;
  note_scales();
  for (std::size_t p = 0; p < size(); ++p) eliminate(p, true, true);
}

int BlockCholesky::rank() const { return std::accumulate(rank_.begin(), rank_.end(), 0); }

void BlockCholesky::factorise(bool choose) {
  smallest_pivot_ = 1;
  note_scales();
  for (std::size_t p = 0; p < size(); ++p) eliminate(p, choose, false);
}

void BlockCholesky::eliminate(std::size_t p, bool choose, bool find_rank) {
  const int n = rows_at(p);
  if (find_rank || (choose && rank_[p] < in_use_[p])) choose_rows(p, find_rank);
  if (rank_[p] < n) leave_out_rows(p);
  with_rows(n, [&](auto R) { factorise_diagonal<R>(p); });
  const double* const D = diagonal_of(p);
  const std::int32_t first = order_.first_below[p], last = order_.first_below[p + 1];
  for (std::int32_t u = first; u < last; ++u)
    with_rows(block_rows_[u], [&](auto R) { solve_on_the_right<R>(block_at(u), D, n); });
  std::size_t target = order_.first_target[p];
  for (std::int32_t u = first; u < last; ++u) {
    for (std::int32_t l = u; l < last; ++l, ++target) {
      double* const to = order_.target[target] < 0 ? diagonal_of(static_cast<std::size_t>(~order_.target[target]))
                                                   : block_at(order_.target[target]);
      with_rows(block_rows_[l], [&](auto R) { add_product<R, -1>(to, block_at(l), block_at(u), block_rows_[u], n); });
    }
  }
}

// The Cholesky factor of a small block, with the largest remaining pivot first, each relative to its row's own scale.
// Only the selection of rows is used.
void BlockCholesky::choose_rows(std::size_t p, bool find_rank) {
  const int rows = in_use_[p];
  Eigen::MatrixXd left = diagonal(order_.joint[p]);
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
    const Eigen::VectorXd column = left.col(best);
    left -= column * column.transpose() / left(best, best);
  }
  if (find_rank) rank_[p] = taken;
  has_redundant_ |= rank_[p] < rows;
}

void BlockCholesky::leave_out_rows(std::size_t p) {
  const int n = rows_at(p);
  Block D = diagonal(order_.joint[p]);
  for (int k = 0; k < n; ++k) {
    if (kept_[p][k] != 0) continue;
    D.row(k).setZero(), D.col(k).setZero(), D(k, k) = 1;
    for (std::int32_t u = order_.first_below[p]; u < order_.first_below[p + 1]; ++u) block(u).col(k).setZero();
  }
}

template <int R>
void BlockCholesky::factorise_diagonal(std::size_t p) {
  double* const D = diagonal_of(p);
  for (int k = 0; k < R; ++k) {
    double pivot = D[k + k * R];
    for (int l = 0; l < k; ++l) pivot -= D[k + l * R] * D[k + l * R];
    const double scale = scale_[p][k];
    const bool kept = kept_[p][k] != 0;
    if (kept && !(pivot >= smallest_pivot_ * scale)) {
      smallest_pivot_ = pivot / scale;
      joint_of_smallest_ = order_.joint[p];
    }
    // A pivot lost in rounding counts as infinite, which leaves its row out. smallest_pivot() reports it.
    const double root = pivot > kLost * scale || !kept ? std::sqrt(pivot) : kInfinite, inverse = 1 / root;
    D[k + k * R] = inverse;
    for (int i = k + 1; i < R; ++i) {
      double sum = D[i + k * R];
      for (int l = 0; l < k; ++l) sum -= D[i + l * R] * D[k + l * R];
      D[i + k * R] = sum * inverse;
    }
  }
}

void BlockCholesky::solve(std::vector<Vec6>& x, std::size_t first, std::size_t last) const {
  for (std::size_t p = first; p < last; ++p) {
    Vec6& at = x[order_.joint[p]];
    const int n = rows_at(p);
    if (rank_[p] < n) at = at.cwiseProduct(kept_[p]);
    with_rows(n, [&](auto R) { solve_lower<R>(diagonal_of(p), at.data()); });
    for (std::int32_t u = order_.first_below[p]; u < order_.first_below[p + 1]; ++u) {
      double* const below = x[order_.joint[order_.row_below[u]]].data();
      with_rows(block_rows_[u], [&](auto R) { subtract_product<R>(below, block_at(u), at.data(), n); });
    }
  }
  for (std::size_t p = last; p-- > first;) {
    Vec6& at = x[order_.joint[p]];
    for (std::int32_t u = order_.first_below[p]; u < order_.first_below[p + 1]; ++u) {
      const double* const below = x[order_.joint[order_.row_below[u]]].data();
      with_rows(block_rows_[u],
                [&](auto R) { subtract_transposed_product<R>(at.data(), block_at(u), below, rows_at(p)); });
    }
    with_rows(rows_at(p), [&](auto R) { solve_lower_transposed<R>(diagonal_of(p), at.data()); });
  }
}

}  // namespace rigor::inline dynamics
