// Siconos in a separate process (README.md of this folder): the program rigor-siconos, which stands beside this one or,
// when installed, in ../libexec/rigor.
#pragma once

#include "adapters/plugin/process_engine.h"

namespace rigor::inline adapters {

class SiconosEngine : public ProcessEngine {
 public:
  SiconosEngine();
  std::string twin(const Settings& settings) const override;
};

}  // namespace rigor::inline adapters
