#include "cases/laboratory/robot_file.h"

#include "cases/import/import.h"

namespace rigor::inline laboratory {

RobotCase robot_case(const std::string& path, bool with_ground) {
  ImportOptions options;
  options.lossy = true, options.ground = with_ground;
  const Import import = import_model(path, options);
  return {case_text_of(import), lines_of(import.losses), falls_freely(import.scene)};
}

}  // namespace rigor::inline laboratory
