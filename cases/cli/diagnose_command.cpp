// rigor diagnose: finds the known mistake that an engine's error looks like.
#include <algorithm>

#include "cases/analysis/mistakes/finder.h"
#include "cases/case/suite.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/json/mistakes_json.h"
#include "cases/report/wording/mistakes.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline cli {

MistakeReport diagnosed(const EngineTable& engines, const RunName& run, std::vector<ProbeScene> probes, int jobs,
                        double limit) {
  constexpr double kMost = 10;  // s of CPU time for a run that takes milliseconds
  Progress progress("motions");
  const auto show = [&](std::size_t motions) { progress.show(motions, 0); };
  MistakeFinder finder(engines, run, std::move(probes), {jobs, std::min(limit, kMost), show});
  return finder.report(engines.find(run.engine));
}

namespace {

class DiagnoseCommand : public Command {
 public:
  void declare(Options& options) override {
    cases_.declare(options), engine_.declare(options), jobs_.declare(options), json_.declare(options);
    timeout_.declare(options);
  }

  int run(const Invocation& invocation) override {
    const EngineTable engines = engine_.outside.table(timeout_.seconds);
    const RunName run = run_asked_for(engine_, invocation.command, engines);
    const MistakeReport report =
        diagnosed(engines, run, probes(vocabulary_of(engines.infos())), jobs_.count, timeout_.seconds);
    if (json_.is_on) {
      print(mistakes_json(report, run.text).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    } else {
      print_table(text_of(report, run.text));
    }
    return kGood;
  }

 private:
  std::vector<ProbeScene> probes(const Vocabulary& vocabulary) const {
    if (cases_.words.empty()) return probes_of_suite(vocabulary);
    return probes_of(select_cases(cases_.words, cases_.suite.dir, vocabulary, cases_.imports.chosen));
  }

  CaseWords cases_;
  EngineOptions engine_;
  JobsOption jobs_;
  JsonOption json_;
  TimeoutOption timeout_;
};

}  // namespace

CommandRow diagnose_row() {
  return {"diagnose",
          "name the known mistake that explains an engine's error",
          "CASE",
          "case ids, families, files or folders; default: cases that tell mistakes apart",
          {{"rigor diagnose --plugin ./my_engine.so", "an engine of your own"},
           {"rigor diagnose springs/fixed-spring --engine ode", "on one case"}},
          make_command<DiagnoseCommand>};
}

}  // namespace rigor::inline cli
