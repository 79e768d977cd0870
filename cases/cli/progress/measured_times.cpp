#include "cases/cli/progress/measured_times.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "cases/report/json/machine.h"
#include "core/base/json.h"

namespace rigor::inline cli {

MeasuredTimes measured_times(const std::string& folder) {
  constexpr std::uintmax_t kLargest = 64 << 20;  // bytes: a larger file takes longer to read than the plan is worth
  const std::filesystem::path file = std::filesystem::path(folder) / "results.json";
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kLargest) return {};
  MeasuredTimes times;
  try {
    std::ifstream stream(file, std::ios::binary);
    const Json results = parse_json(std::string{std::istreambuf_iterator<char>(stream), {}});
    const Machine here = this_machine();
    const Json& machine = results.at("machine");
    if (machine.at("cpu") != here.cpu || machine.at("cores") != here.cores) return {};
    for (const Json& cell : results.at("cells")) {
      if (cell.at("status") != "pass" && cell.at("status") != "diverged") continue;
      times[{cell.at("case").get<std::string>(), cell.at("engine").get<std::string>(),
             cell.at("dt").get<std::string>()}] = cell.at("wall_seconds").get<double>();
    }
  } catch (const std::exception&) {  // an older or damaged file only makes the estimate coarser
    return {};
  }
  return times;
}

}  // namespace rigor::inline cli
