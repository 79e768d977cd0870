// MuJoCo 3, double precision, from the npm registry: WebAssembly in a process of Node. It gets the scene as the text
// and the numbers that the adapter of MuJoCo 2.2 makes of it.
#pragma once

#include <string>

#include "adapters/plugin/process_engine.h"

namespace rigor::inline adapters {

class Mujoco3Engine : public ProcessEngine {
 public:
  // The folder must be there, see mujoco3_package.h.
  explicit Mujoco3Engine(const std::string& folder);

  std::string twin(const Settings& settings) const override;

 private:
  WorldTerms terms_of(const Scene& scene, const Settings& settings) const override;
};

}  // namespace rigor::inline adapters
