#include "adapters/siconos/siconos_engine.h"

#include <fmt/format.h>

#include <filesystem>

#include "adapters/common/engine_row.h"
#include "adapters/siconos/siconos_calls.h"
#include "adapters/siconos/siconos_info.h"
#include "adapters/siconos/siconos_twin.h"

namespace rigor::inline adapters {
namespace {

std::string path_of_process() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path beside = here / "rigor-siconos",
                 installed = here.parent_path() / "libexec" / "rigor" / "rigor-siconos";
  return fs::exists(beside, error) ? beside.string() : installed.string();
}

// One thread: OpenBLAS, which Siconos brings, would start one for each core, for matrices of a few rows.
PluginStart start_of_process() {
  constexpr double kLimit = 60;  // s; a cell has its own limit
  return {fmt::format("env OPENBLAS_NUM_THREADS=1 '{}'", path_of_process()), kLimit, -1};
}

}  // namespace

SiconosEngine::SiconosEngine() : ProcessEngine(start_of_process(), read_plugin_info(siconos_info(), "rigor-siconos")) {}

// The stock iteration stops at a residual momentum of 1e-6, far above rounding.
std::string SiconosEngine::twin(const Settings& settings) const {
  if (settings.track == Track::stock) return "";
  const auto theta = settings.options.find("theta");
  return "core:siconos-twin" + (theta == settings.options.end() ? "" : ",theta=" + theta->second);
}

EngineRow siconos_row() {
  return {make_engine<SiconosEngine>, [] { return std::vector<Integrator>{kSiconosTwin}; }, siconos_calls};
}

}  // namespace rigor::inline adapters
