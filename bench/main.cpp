// Times what the table of ratio_table.h needs, prints it and writes Google Benchmark's JSON; with --all every engine
// and method on every scene. --plugin P adds an engine from outside. Takes Google Benchmark's own arguments; a
// --benchmark_filter replaces the table's selection.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "adapters/plugin/plugins.h"
#include "bench/benchmarks.h"
#include "bench/ratio_table.h"
#include "core/base/error.h"

using namespace rigor;

int main(int argc, char** argv) {
  std::vector<char*> arguments;
  std::vector<std::string> plugins = plugins_of_environment();
  bool all = false, filtered = false;
  for (int k = 0; k < argc; ++k) {
    if (std::strcmp(argv[k], "--all") == 0) {
      all = true;
      continue;
    }
    if (std::strcmp(argv[k], "--plugin") == 0 && k + 1 < argc) {
      plugins.push_back(argv[++k]);
      continue;
    }
    filtered |= std::strncmp(argv[k], "--benchmark_filter=", 19) == 0;
    arguments.push_back(argv[k]);
  }
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  bench::register_steps();
  bench::register_limits();
  bench::register_harness();
  try {
    bench::register_plugins(plugins);
  } catch (const InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
  bench::RatioTable table;
  const std::string filter = all ? "." : filtered ? benchmark::GetBenchmarkFilter() : bench::filter_of_table();
  const std::size_t matched = benchmark::RunSpecifiedBenchmarks(&table, filter);
  benchmark::Shutdown();
  return matched > 0 ? 0 : 2;
}
