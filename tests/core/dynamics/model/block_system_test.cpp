#include "core/dynamics/model/block_system.h"

#include <boost/test/unit_test.hpp>
#include <vector>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_dynamics_model_block_system)

namespace {

struct Block {
  std::size_t row, column;
  Mat6 values;
};

Eigen::VectorXd times(const std::vector<Block>& blocks, const Eigen::VectorXd& x) {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
  for (const Block& b : blocks) {
    product.segment<6>(6 * static_cast<Eigen::Index>(b.row)) +=
        b.values * x.segment<6>(6 * static_cast<Eigen::Index>(b.column));
  }
  return product;
}

// A chain of bodies, each joined to the one `reach` further on.
std::vector<Block> chain(std::size_t bodies, std::size_t reach, double coupling) {
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < bodies; ++i) {
    blocks.push_back({i, i, (3.0 + static_cast<double>(i)) * Mat6::Identity()});
    if (i + reach < bodies) {
      blocks.push_back({i, i + reach, Mat6::Constant(coupling)});
      blocks.push_back({i + reach, i, Mat6::Constant(-2 * coupling)});
    }
  }
  return blocks;
}

}  // namespace

BOOST_AUTO_TEST_CASE(one_system_is_solved_again_and_again_with_other_numbers_and_other_blocks) {
  for (const std::size_t bodies : {2, 10, 11, 30}) {  // dense up to ten, sparse beyond
    BlockSystem system(bodies);
    for (const auto& [reach, coupling] : {std::pair(1, 0.1), std::pair(1, 0.3), std::pair(5, 0.2), std::pair(1, 0.1)}) {
      const std::vector<Block> blocks = chain(bodies, reach, coupling);
      const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(6 * static_cast<Eigen::Index>(bodies), -1, 2);
      Eigen::VectorXd solution;
      system.clear();
      for (const Block& b : blocks) system.add(b.row, b.column, b.values);
      BOOST_TEST(system.solve(right, solution));
      BOOST_TEST((times(blocks, solution) - right).norm() < 1e-12);  // some hundred roundings of numbers up to 30
    }
  }
}

// Positive definite or, with every other sign of its diagonal turned, not; the last one singular.
BOOST_AUTO_TEST_CASE(a_symmetric_system_is_solved_whatever_its_signs) {
  for (const std::size_t bodies : {2, 11, 30}) {
    BlockSystem system(bodies, BlockSystem::Kind::symmetric);
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(6 * static_cast<Eigen::Index>(bodies), -1, 2);
    for (const double sign : {1.0, -1.0, 0.0}) {
      std::vector<Block> blocks;
      for (std::size_t i = 0; i < bodies; ++i) {
        const double size = (i % 2 == 0 ? sign : 1) * (3.0 + static_cast<double>(i));
        blocks.push_back({i, i, size * Mat6::Identity()});
        if (i == 0 || sign == 0) continue;
        blocks.push_back({i, i - 1, Mat6::Constant(0.1)}), blocks.push_back({i - 1, i, Mat6::Constant(0.1)});
      }
      Eigen::VectorXd solution;
      system.clear();
      for (const Block& b : blocks) system.add(b.row, b.column, b.values);
      BOOST_TEST(system.solve(right, solution) == (sign != 0));
      if (sign != 0) BOOST_TEST((times(blocks, solution) - right).norm() < 1e-12);  // as above
    }
  }
}

BOOST_AUTO_TEST_CASE(a_singular_system_is_said_to_be_so) {
  for (const std::size_t bodies : {2, 30}) {
    BlockSystem system(bodies);
    system.clear();
    for (std::size_t i = 1; i < bodies; ++i) system.add(i, i, Mat6::Identity());
    system.add(0, 0, Mat6::Zero());
    Eigen::VectorXd solution;
    BOOST_TEST(!system.solve(Eigen::VectorXd::Ones(6 * static_cast<Eigen::Index>(bodies)), solution));
  }
}

// A free body's own equations and its pull on the next, as in a chain of springs: rows that add up to zero.
BOOST_AUTO_TEST_CASE(a_system_that_is_singular_but_for_roundings_is_said_to_be_so) {
  Mat6 pull = Mat6::Identity() / 3;
  pull(0, 1) = 0.1, pull(4, 2) = 0.7, pull(5, 0) = -0.3;
  for (const std::size_t bodies : {2, 10, 30}) {
    BlockSystem system(bodies);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(bodies)), solution;
    right.head<6>().setOnes(), right.tail<6>().setConstant(-1);  // what a singular system could still answer
    const auto solves = [&](double held, double unit) {
      system.clear();
      for (std::size_t i = 0; i + 1 < bodies; ++i) {
        const Mat6 k = unit * (1 + 0.1 * static_cast<double>(i)) * pull;
        system.add(i, i, k), system.add(i + 1, i + 1, k), system.add(i, i + 1, -k), system.add(i + 1, i, -k);
      }
      system.add(0, 0, held * unit * Mat6::Identity());
      return system.solve(right, solution);
    };
    for (const double unit : {1e-200, 1.0, 1e200}) {
      BOOST_TEST(!solves(0, unit), bodies << " bodies, in units of " << unit);
      BOOST_TEST(!solves(1e-17, unit), bodies << " bodies, in units of " << unit);
      BOOST_TEST(solves(1e-8, unit), bodies << " bodies, in units of " << unit);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
