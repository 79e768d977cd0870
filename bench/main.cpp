// Times the benchmarks of the table in ratio_table.h, prints it and writes Google Benchmark's JSON. Options:
// --all              times every engine and method on every scene.
// --plugin P         adds an engine from outside.
// --lanes L          makes the core use the instruction set plain, AVX2 or AVX-512 instead of the widest one.
// --scene-files DIR  times nothing. It writes the scenes of `bench/run --wasm` and what the plug-ins reach in them.
// Google Benchmark's own arguments work, too. Its --benchmark_filter replaces the table's selection.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "adapters/plugin/plugins.h"
#include "bench/benchmarks.h"
#include "bench/ratio_table.h"
#include "bench/wasm/scene_files.h"
#include "core/base/error.h"
#include "core/dynamics/kernels/kernels.h"

using namespace rigor;

namespace {

struct Arguments {
  std::vector<char*> left;  // for Google Benchmark
  std::vector<std::string> plugins = plugins_of_environment();
  std::string lanes, scene_files;
  bool all = false, filtered = false;
};

Arguments read_arguments(int argc, char** argv) {
  Arguments found;
  for (int k = 0; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--all") {
      found.all = true;
    } else if (word == "--plugin" && k + 1 < argc) {
      found.plugins.push_back(argv[++k]);
    } else if (word == "--lanes" && k + 1 < argc) {
      found.lanes = argv[++k];
    } else if (word == "--scene-files" && k + 1 < argc) {
      found.scene_files = argv[++k];
    } else {
      found.filtered |= word.starts_with("--benchmark_filter=");
      found.left.push_back(argv[k]);
    }
  }
  return found;
}

// Kernels of this name, or null: what this processor cannot run is not among them.
const Kernels* kernels_named(const std::string& name, std::string& allowed) {
  const Kernels* all[kMostKernelTables];
  const std::size_t count = available_kernels(all);
  for (std::size_t k = 0; k < count; ++k) {
    if (name == all[k]->name) return all[k];
    allowed += (k > 0 ? ", " : "") + std::string(all[k]->name);
  }
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments = read_arguments(argc, argv);
  std::optional<KernelsInPlace> forced;
  if (!arguments.lanes.empty()) {
    std::string allowed;
    const Kernels* table = kernels_named(arguments.lanes, allowed);
    if (!table)
      return std::fprintf(stderr, "--lanes %s: this processor has %s\n", arguments.lanes.c_str(), allowed.c_str()), 2;
    forced.emplace(*table);
  }
  int count = static_cast<int>(arguments.left.size());
  benchmark::Initialize(&count, arguments.left.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.left.data())) return 2;
  const std::string filter = arguments.all        ? "."
                             : arguments.filtered ? benchmark::GetBenchmarkFilter()
                                                  : bench::filter_of_table();
  bench::register_steps(filter);
  bench::register_limits();
  bench::register_harness();
  try {
    if (!arguments.scene_files.empty()) return bench::write_scene_files(arguments.scene_files, arguments.plugins), 0;
    bench::register_plugins(arguments.plugins);
  } catch (const InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
  bench::RatioTable table;
  const std::size_t matched = benchmark::RunSpecifiedBenchmarks(&table, filter);
  benchmark::Shutdown();
  return matched > 0 ? 0 : 2;
}
