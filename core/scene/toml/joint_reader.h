// [[scene.joint]], [[scene.coupling]] and [[scene.motor]].
#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "core/scene/toml/body_index.h"
#include "core/scene/toml/row_fault.h"

namespace rigor::inline scene {

const Keys& joint_keys();
const Keys& motor_keys();
const Keys& coupling_keys();

struct JointOfFile {
  Joint joint;
  TableReader row;  // of a compound joint's axis, its own
};

// Throws InputError for values that no joint can have, given its ends, which the scene has checked. `check_velocities`:
// also for initial velocities that violate it. One joint, or a compound joint and its axes.
std::vector<JointOfFile> read_joint(TableReader row, const Scene& scene, const Ends& ends, bool check_velocities);

// Its two joints are the scene's, by name.
Coupling read_coupling(const TableReader& row, const Scene& scene);

// The joint is one of the scene's, by name.
Motor read_motor(const TableReader& row, const Scene& scene);

// The Coulomb friction of the joint that was read last, from its row; empty without.
std::optional<Motor> read_friction(const TableReader& row, const Scene& scene);

// [from, until) of a force or motor [s].
void read_times(const TableReader& row, double& from, double& until);

}  // namespace rigor::inline scene
