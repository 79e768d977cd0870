// rigor conform: whether an engine does what the seam asks, check by check. All checks run in one child process; one
// that dies costs the check it was at, and another goes on with the rest.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "cases/analysis/conformance/conformance.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/json/mistakes_json.h"
#include "cases/report/wording/mistakes.h"
#include "cases/runner/process_pool.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/engine/engine_failure.h"
#include "core/engine/run_name.h"

namespace rigor::inline cli {
namespace {

const char* word_of(CheckResult::Answer answer) {
  return answer == CheckResult::Answer::holds    ? "holds"
         : answer == CheckResult::Answer::broken ? "broken"
                                                 : "not-asked";
}

Json json_of(const ConformanceCheck& check, const CheckResult& result) {
  Json json = {{"name", check.name}, {"asks", check.asks}, {"answer", word_of(result.answer)}};
  if (result.answer == CheckResult::Answer::broken)
    json["sent"] = result.sent, json["came"] = result.came, json["due"] = result.due;
  if (result.answer == CheckResult::Answer::not_asked) json["why"] = result.why;
  return json;
}

// One message a check, from `first` on.
void send_results(const Trial& trial, std::size_t first, const Channel& channel) {
  const auto& checks = conformance_checks();
  for (std::size_t n = first; n < checks.size(); ++n) {
    CheckResult result;
    try {
      result = check_result(checks[n], trial);
    } catch (const EngineFailure& failure) {  // it hangs: nothing else would be answered either
      result = {CheckResult::Answer::broken, checks[n].asks, failure.what(), "an answer", ""};
      channel.send(json_of(checks[n], result).dump(-1, ' ', false, Json::error_handler_t::replace));
      while (++n < checks.size())
        channel.send(json_of(checks[n], {CheckResult::Answer::not_asked, "", "", "", "it no longer answered"}).dump());
      return;
    }
    channel.send(json_of(checks[n], result).dump(-1, ' ', false, Json::error_handler_t::replace));
  }
}

Json results_of(const Trial& trial, const EngineTable& engines, double limit) {
  const auto& checks = conformance_checks();
  Json results = Json::array();
  Progress progress("checks");
  while (results.size() < checks.size()) {
    const auto work = [&](const Channel& channel) {
      send_results(trial, results.size(), channel);
      engines.rest();
    };
    const auto on_message = [&](std::size_t, const std::string& message) {
      results.push_back(parse_json(message));
      progress.show(results.size(), checks.size());
    };
    const auto on_end = [&](std::size_t, const JobEnd& end) {
      if (results.size() == checks.size()) return;
      const ConformanceCheck& check = checks[results.size()];
      results.push_back(
          json_of(check, {CheckResult::Answer::broken, check.asks, sentence_of(end, limit), "an answer", ""}));
    };
    run_jobs({{work, limit}}, 1, on_message, on_end);
  }
  return results;
}

// A scene is a long line; what follows it is worth more.
std::string cut(const std::string& text) {
  constexpr std::size_t kLongest = 600;
  return text.size() <= kLongest ? text
                                 : text.substr(0, kLongest / 2) + " ... " + text.substr(text.size() - kLongest / 2);
}

std::string table_of(const RunName& run, const Json& results, bool holds) {
  std::string text = fmt::format("{}:\n", run.text);
  for (const Json& row : results) {
    const std::string answer = row.at("answer"), name = row.at("name"), asks = row.at("asks");
    const std::string sign = answer == "holds" ? "holds   " : answer == "broken" ? "BROKEN  " : "-       ";
    text += fmt::format("  {}{:<16}{}\n", sign, name, asks);
    if (answer == "not-asked")
      text += fmt::format("          {:<16}not asked: {}\n", "", row.at("why").get<std::string>());
    if (answer != "broken") continue;
    for (const char* key : {"sent", "came", "due"})
      text +=
          fmt::format("          {:<16}{:<5} {}\n", "", std::string(key) + ":", cut(row.at(key).get<std::string>()));
  }
  return text + fmt::format("{} {}\n", run.text, holds ? "conforms" : "does not conform");
}

// Whether it answered whatever it was asked: one that does not has no motion to compare.
bool answers(const Json& results) {
  return std::none_of(results.begin(), results.end(),
                      [](const Json& row) { return row.at("answer") == "broken" && row.at("due") == "an answer"; });
}

}  // namespace

RunName run_asked_for(const EngineOptions& options, const std::string& command, const EngineTable& engines) {
  if (options.engines.size() > 1) throw InputError(fmt::format("rigor {}: takes one --engine", command));
  if (!options.engines.empty()) return run_of_option(options.engines.front(), engines.infos());
  const std::vector<std::string>& plugins = options.outside.plugins;
  std::vector<std::string> outside;
  for (const EngineInfo& info : engines.infos()) {
    const std::string& identity = engines.identity_of(info.name);  // begins with what it was started by
    const bool is_meant = plugins.size() != 1 || identity.starts_with(plugins.front() + " ");
    if (!identity.empty() && is_meant) outside.push_back(info.name);
  }
  if (outside.size() != 1)
    throw InputError(
        fmt::format("rigor {}: which engine? Give one --plugin P, or --engine E; see rigor list engines", command));
  return parse_run_name(outside.front(), engines.infos());
}

namespace {

class ConformCommand : public Command {
 public:
  void declare(Options& options) override {
    engine_.declare(options), jobs_.declare(options), json_.declare(options), timeout_.declare(options);
  }

  int run(const Invocation& invocation) override {
    const EngineTable engines = engine_.outside.table(timeout_.seconds);
    const RunName run = run_asked_for(engine_, invocation.command, engines);
    const Trial trial{engines.find(run.engine), engines.info_of(run.engine), run.settings};
    const Json results = results_of(trial, engines, timeout_.seconds);
    bool holds = true;
    for (const Json& row : results) holds = holds && row.at("answer") != "broken";
    std::optional<MistakeReport> report;
    if (!holds && answers(results)) {
      const Vocabulary vocabulary = vocabulary_of(engines.infos());
      report = diagnosed(engines, run, probes_of_suite(vocabulary), jobs_.count, timeout_.seconds);
    }
    if (json_.is_on) {
      Json json = {{"engine", run.text}, {"version", trial.info.version}, {"conforms", holds}, {"checks", results}};
      if (report) json["diagnosis"] = mistakes_json(*report, run.text);
      print(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    } else {
      print_table(table_of(run, results, holds) + (report ? "\n" + text_of(*report, run.text) : ""));
    }
    return holds ? kGood : kGateFailed;
  }

 private:
  EngineOptions engine_;
  JobsOption jobs_;
  JsonOption json_;
  TimeoutOption timeout_;
};

}  // namespace

CommandRow conform_row() {
  return {"conform",
          "check an engine against the interface; exit 1 if a check fails",
          "",
          "",
          {{"rigor conform --plugin 'python3 my_engine.py'", "an engine of your own"},
           {"rigor conform --engine ode --json", "a built-in engine, as JSON"}},
          make_command<ConformCommand>};
}

}  // namespace rigor::inline cli
