// [[scene.joint]] and [[scene.motor]].
#pragma once

#include "core/scene/scene.h"
#include "core/scene/toml/body_index.h"
#include "core/scene/toml/row_fault.h"

namespace rigor {

const Keys& joint_keys();
const Keys& motor_keys();

// Throws InputError for values that no joint can have, given its ends, which the scene has checked. `check_velocities`:
// also for initial velocities that violate it.
Joint read_joint(TableReader row, const Scene& scene, const Ends& ends, bool check_velocities);

// The joint is one of the scene's, by name.
Motor read_motor(const TableReader& row, const Scene& scene);

// The Coulomb friction of the joint that was read last, from its row; empty without.
std::optional<Motor> read_friction(const TableReader& row, const Scene& scene);

// [from, until) of a force or motor [s].
void read_times(const TableReader& row, double& from, double& until);

}  // namespace rigor
