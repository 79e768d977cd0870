// The joints of worldstep of ODE 0.16, for its twin: rows as its manual derives them ("Joint error and the error
// reduction parameter", "Constraint equations"), confirmed by its motion, and the common solution of all direct solvers
// (twin_joint_solver.h).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/common/twin_joint_solver.h"

namespace rigor::inline adapters {

// The place of one end of a joint; the world and fixed bodies are at W itself.
struct OdeEnd {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Mat3 R = Mat3::Identity();
  bool moves = false;
};

struct OdeRows {
  using Block = Eigen::Matrix<double, kMostRows, 6>;
  Block on_first = Block::Zero(), on_second = Block::Zero();  // of (v, w)
  Vec6 missing = Vec6::Zero();                                // m, rad
};

class OdeJointRows {
 public:
  virtual ~OdeJointRows() = default;
  virtual int count() const = 0;
  virtual void fill(const OdeEnd& first, const OdeEnd& second, OdeRows& rows) const = 0;  // rows are zero before
};

class OdeTwinJoints {
 public:
  // No cfm: the matched track's. The system must outlive it.
  OdeTwinJoints(const Scene& scene, const System& system, double erp, std::optional<double> cfm);

  // Pushes the velocities of a state whose poses are those of the step's start.
  void push(MutableBodyColumns state, double dt);
  std::string warning() const { return solver_.warning(); }  // of the last push

 private:
  struct JointWithRows {
    std::unique_ptr<OdeJointRows> rows;
    int first, second;  // bodies; the second kWorld where it stays
  };

  TwinJointSolver solver_;
  std::vector<JointWithRows> joints_;
};

}  // namespace rigor::inline adapters
