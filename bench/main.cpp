// Times what the table of ratio_table.h needs, prints it and writes Google Benchmark's JSON; with --all every engine
// and method on every scene. Takes Google Benchmark's own arguments; a --benchmark_filter replaces the table's
// selection.
#include <benchmark/benchmark.h>

#include <cstring>
#include <string>
#include <vector>

#include "bench/benchmarks.h"
#include "bench/ratio_table.h"

using namespace rigor;

int main(int argc, char** argv) {
  std::vector<char*> arguments;
  bool all = false, filtered = false;
  for (int k = 0; k < argc; ++k) {
    if (std::strcmp(argv[k], "--all") == 0) {
      all = true;
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
  bench::register_plugins();
  bench::RatioTable table;
  const std::string filter = all ? "." : filtered ? benchmark::GetBenchmarkFilter() : bench::filter_of_table();
  const std::size_t matched = benchmark::RunSpecifiedBenchmarks(&table, filter);
  benchmark::Shutdown();
  return matched > 0 ? 0 : 2;
}
