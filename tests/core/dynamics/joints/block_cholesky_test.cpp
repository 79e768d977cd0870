#include "core/dynamics/joints/block_cholesky.h"

#include <Eigen/Cholesky>
#include <boost/test/unit_test.hpp>
#include <random>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_joints_block_cholesky)

namespace {

// S = B Bᵀ for joints of 3 rows, coupled by the pairs: each joint has random rows on its two bodies.
struct Example {
  std::vector<std::pair<int, int>> joints;  // bodies, -1 the world
  int rows = 3;
  Eigen::MatrixXd J;

  Example(std::vector<std::pair<int, int>> ends, int bodies) : joints(std::move(ends)) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> draw(-1, 1);
    J = Eigen::MatrixXd::Zero(rows * size(), 6 * bodies);
    for (int k = 0; k < size(); ++k) {
      for (const int body : {joints[k].first, joints[k].second}) {
        if (body < 0) continue;
        for (int r = 0; r < rows; ++r) {
          for (int c = 0; c < 6; ++c) J(rows * k + r, 6 * body + c) = draw(engine);
        }
      }
    }
  }

  int size() const { return static_cast<int>(joints.size()); }
  bool share(int i, int j) const {
    const auto on = [&](int k, int body) { return body >= 0 && (joints[k].first == body || joints[k].second == body); };
    return on(j, joints[i].first) || on(j, joints[i].second);
  }
  std::vector<std::pair<int, int>> coupled() const {
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < size(); ++i) {
      for (int j = i + 1; j < size(); ++j) {
        if (share(i, j)) pairs.emplace_back(i, j);
      }
    }
    return pairs;
  }
  void fill(BlockCholesky& factor) const {
    const Eigen::MatrixXd S = J * J.transpose();
    factor.clear();
    for (int i = 0; i < size(); ++i)
      factor.diagonal(i).topLeftCorner(rows, rows) = S.block(rows * i, rows * i, rows, rows);
    for (const auto& [i, j] : coupled()) {
      const auto place = factor.place(i, j);
      const Eigen::MatrixXd block = S.block(rows * i, rows * j, rows, rows);
      factor.block(place.index).topLeftCorner(rows, rows) =
          place.transposed ? Eigen::MatrixXd(block.transpose()) : block;
    }
  }
  // |S x - b| of a right side in S's range.
  double residual(BlockCholesky& factor) const {
    const Eigen::VectorXd b = J * Eigen::VectorXd::LinSpaced(J.cols(), -1, 2);
    std::vector<Vec6> x(joints.size(), Vec6::Zero());
    for (int k = 0; k < size(); ++k) x[k].head(rows) = b.segment(rows * k, rows);
    factor.solve(x);
    Eigen::VectorXd all(b.size());
    for (int k = 0; k < size(); ++k) all.segment(rows * k, rows) = x[k].head(rows);
    return (J * (J.transpose() * all) - b).norm();
  }
};

}  // namespace

// A chain, a star, a tree and a loop, of full rank. Condition numbers are some thousand: 1e-16 times that.
BOOST_AUTO_TEST_CASE(it_solves_chains_stars_trees_and_loops) {
  const std::vector<Example> examples = {{{{-1, 0}, {0, 1}, {1, 2}, {2, 3}, {3, 4}}, 5},
                                         {{{-1, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}}, 5},
                                         {{{4, 2}, {0, 1}, {1, 4}, {1, 3}, {-1, 0}}, 5},
                                         {{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {1, 3}}, 4}};
  for (const Example& example : examples) {
    BlockCholesky factor(std::vector<int>(example.joints.size(), example.rows), example.coupled());
    example.fill(factor);
    factor.find_ranks();
    BOOST_TEST(factor.rank() == example.rows * example.size());
    BOOST_TEST(!factor.has_redundant_rows());
    example.fill(factor);
    factor.factorise(true);
    BOOST_TEST(factor.smallest_pivot() > 1e-6);
    BOOST_TEST(example.residual(factor) < 1e-11);
  }
}

// Two joints are there twice, and one row is the sum of two others.
BOOST_AUTO_TEST_CASE(rows_that_repeat_others_are_left_out_and_the_rest_is_solved) {
  Example example({{-1, 0}, {0, 1}, {-1, 0}, {1, 2}, {0, 1}}, 3);
  example.J.middleRows(6, 3) = example.J.middleRows(0, 3);
  example.J.middleRows(12, 3) = example.J.middleRows(3, 3);
  example.J.row(11) = example.J.row(9) + example.J.row(10);
  BlockCholesky factor(std::vector<int>(5, 3), example.coupled());
  example.fill(factor);
  factor.find_ranks();
  BOOST_TEST(factor.rank() == 8);
  BOOST_TEST(factor.has_redundant_rows());
  for (const bool choose : {true, false}) {
    example.fill(factor);
    factor.factorise(choose);
    BOOST_TEST(example.residual(factor) < 1e-11);
  }
}

BOOST_AUTO_TEST_SUITE_END()
