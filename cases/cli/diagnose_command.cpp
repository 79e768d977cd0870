// rigor diagnose: finds the known mistake that an engine's error looks like.
#include <algorithm>

#include "cases/analysis/mistakes/finder.h"
#include "cases/cli/commands.h"
#include "cases/cli/options.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/json/mistakes_json.h"
#include "cases/report/wording/mistakes.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor {

MistakeReport diagnosed(const CommandLine& line, const EngineTable& engines, const RunName& run) {
  const Vocabulary vocabulary = vocabulary_of(engines.infos());
  std::vector<ProbeScene> probes = line.words.empty()
                                       ? probes_of_suite(vocabulary)
                                       : probes_of(select_cases(line.words, line.suite_dir, vocabulary, line.import));
  constexpr double kMost = 10;  // s of CPU time for a run that takes milliseconds
  Progress progress("motions");
  const auto show = [&](std::size_t motions) { progress.show(motions, 0); };
  MistakeFinder finder(engines, run, std::move(probes), {line.jobs, std::min(line.limit, kMost), show});
  return finder.report(engines.find(run.engine));
}

int diagnose_command(const CommandLine& line, const EngineTable& engines) {
  const RunName run = run_asked_for(line, engines);
  const MistakeReport report = diagnosed(line, engines, run);
  if (line.json) {
    print(mistakes_json(report, run.text).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  } else {
    print_table(text_of(report, run.text));
  }
  return kGood;
}

CommandRow diagnose_row() {
  return {"diagnose",
          "name the known mistake that explains an engine's error",
          "CASE",
          "case ids, families, files or folders; default: cases that tell mistakes apart",
          with_import_options({"--engine", "--jobs", "--json", "--plugin", "--suite", "--timeout"}),
          {{"rigor diagnose --plugin ./my_engine.so", "an engine of your own"},
           {"rigor diagnose springs/fixed-spring --engine ode", "on one case"}},
          diagnose_command};
}

}  // namespace rigor
