// Where MuJoCo 3 is: its package of the npm registry, and the program that runs it.
#pragma once

#include <string>

namespace rigor::inline adapters {

// The folder whose node_modules has @mujoco/mujoco: RIGOR_MUJOCO3, or the one beside this program, which a build with
// that package has. Empty if there is none, or no Node to run it.
std::string mujoco3_package_folder();

// The package's version, from its package.json.
std::string mujoco3_version(const std::string& folder);

// The script that serves it: in a build beside this program, else in libexec/rigor.
std::string mujoco3_script();

}  // namespace rigor::inline adapters
