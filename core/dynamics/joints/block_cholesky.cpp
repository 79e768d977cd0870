#include "core/dynamics/joints/block_cholesky.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "core/dynamics/joints/small_blocks.h"

namespace rigor {
namespace {

constexpr double kInfinite = 1e150;  // its square is a number, too

}  // namespace

BlockCholesky::BlockCholesky(std::vector<int> rows, const std::vector<std::pair<int, int>>& coupled)
    : rows_(std::move(rows)), scale_(rows_.size()), kept_(rows_.size()) {
  find_components(coupled);
  order(coupled);
  list_products();
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
    for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u) {
      block_rows_.push_back(rows_at(static_cast<std::size_t>(row_below_[u])));
      block_columns_.push_back(columns);
      block_start_.push_back(end);
      end += static_cast<std::size_t>(block_rows_.back() * columns);
    }
  }
  values_.resize(end);
}

void BlockCholesky::find_components(const std::vector<std::pair<int, int>>& coupled) {
  std::vector<std::vector<int>> neighbours(size());
  for (const auto& [a, b] : coupled) neighbours[a].push_back(b), neighbours[b].push_back(a);
  component_.assign(size(), -1);
  for (std::size_t joint = 0; joint < size(); ++joint) {
    if (component_[joint] >= 0) continue;
    component_[joint] = components_;
    for (std::vector<int> todo = {static_cast<int>(joint)}; !todo.empty();) {
      const int at = todo.back();
      todo.pop_back();
      for (const int next : neighbours[at]) {
        if (component_[next] < 0) component_[next] = components_, todo.push_back(next);
      }
    }
    ++components_;
  }
  first_of_component_.assign(static_cast<std::size_t>(components_) + 1, 0);
  for (const int component : component_) ++first_of_component_[static_cast<std::size_t>(component) + 1];
  std::partial_sum(first_of_component_.begin(), first_of_component_.end(), first_of_component_.begin());
}

// Component by component eliminates the joint with the fewest neighbours, which then all become each other's; the first
// of equals. So a chain is eliminated from one end to the other, and each joint has a body beside it that carries
// nothing yet: from both ends at once, the last joint would be between two halves, of which each is so heavy against
// its own two bodies that of a thousand hinges its pivot would pass for zero.
void BlockCholesky::order(const std::vector<std::pair<int, int>>& coupled) {
  std::vector<std::set<int>> neighbours(size());
  for (const auto& [a, b] : coupled) {
    if (a != b) neighbours[a].insert(b), neighbours[b].insert(a);
  }
  std::set<std::tuple<int, std::size_t, int>> queue;
  const auto entry = [&](int joint) { return std::tuple(component_[joint], neighbours[joint].size(), joint); };
  for (std::size_t j = 0; j < size(); ++j) queue.insert(entry(static_cast<int>(j)));
  std::vector<std::vector<int>> below(size());
  position_.resize(size());
  while (!queue.empty()) {
    const int joint = std::get<2>(*queue.begin());
    queue.erase(queue.begin());
    position_[joint] = joint_.size();
    const std::vector<int> around(neighbours[joint].begin(), neighbours[joint].end());
    for (const int n : around) {
      queue.erase(entry(n));
      neighbours[n].erase(joint);
      for (const int m : around) {
        if (m != n) neighbours[n].insert(m);
      }
      queue.insert(entry(n));
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
  const std::int32_t first = first_below_[p], last = first_below_[p + 1];
  for (std::int32_t u = first; u < last; ++u)
    with_rows(block_rows_[u], [&](auto R) { solve_on_the_right<R>(block_at(u), D, n); });
  std::size_t target = first_target_[p];
  for (std::int32_t u = first; u < last; ++u) {
    for (std::int32_t l = u; l < last; ++l, ++target) {
      double* const to =
          target_[target] < 0 ? diagonal_of(static_cast<std::size_t>(~target_[target])) : block_at(target_[target]);
      with_rows(block_rows_[l], [&](auto R) { add_product<R, -1>(to, block_at(l), block_at(u), block_rows_[u], n); });
    }
  }
}

// The Cholesky factor of a small block with the largest remaining pivot first, each relative to its row's own scale:
// which rows are taken is all that is wanted of it.
void BlockCholesky::choose_rows(std::size_t p, bool find_rank) {
  const int rows = in_use_[p];
  Eigen::MatrixXd left = diagonal(joint_[p]);
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
  Block D = diagonal(joint_[p]);
  for (int k = 0; k < n; ++k) {
    if (kept_[p][k] != 0) continue;
    D.row(k).setZero(), D.col(k).setZero(), D(k, k) = 1;
    for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u) block(u).col(k).setZero();
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
      joint_of_smallest_ = joint_[p];
    }
    // What is lost in rounding counts as infinite, which leaves its row out; whoever asks smallest_pivot() knows.
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
    Vec6& at = x[joint_[p]];
    const int n = rows_at(p);
    if (rank_[p] < n) at = at.cwiseProduct(kept_[p]);
    with_rows(n, [&](auto R) { solve_lower<R>(diagonal_of(p), at.data()); });
    for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u) {
      double* const below = x[joint_[row_below_[u]]].data();
      with_rows(block_rows_[u], [&](auto R) { subtract_product<R>(below, block_at(u), at.data(), n); });
    }
  }
  for (std::size_t p = last; p-- > first;) {
    Vec6& at = x[joint_[p]];
    for (std::int32_t u = first_below_[p]; u < first_below_[p + 1]; ++u) {
      const double* const below = x[joint_[row_below_[u]]].data();
      with_rows(block_rows_[u],
                [&](auto R) { subtract_transposed_product<R>(at.data(), block_at(u), below, rows_at(p)); });
    }
    with_rows(rows_at(p), [&](auto R) { solve_lower_transposed<R>(diagonal_of(p), at.data()); });
  }
}

}  // namespace rigor
