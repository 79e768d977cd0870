// rigor conform: whether an engine does what the seam asks, check by check. All checks run in one child process; one
// that dies costs the check it was at, and another goes on with the rest.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "cases/analysis/conformance/conformance.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/report/json/mistakes_json.h"
#include "cases/report/wording/mistakes.h"
#include "cases/runner/process_pool.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"
#include "core/engine/run_name.h"

namespace rigor {
namespace {

using Json = nlohmann::ordered_json;

const char* word_of(Outcome::Answer answer) {
  return answer == Outcome::Answer::holds ? "holds" : answer == Outcome::Answer::broken ? "broken" : "not-asked";
}

Json json_of(const ConformanceCheck& check, const Outcome& outcome) {
  Json json = {{"name", check.name}, {"asks", check.asks}, {"answer", word_of(outcome.answer)}};
  if (outcome.answer == Outcome::Answer::broken)
    json["sent"] = outcome.sent, json["came"] = outcome.came, json["due"] = outcome.due;
  if (outcome.answer == Outcome::Answer::not_asked) json["why"] = outcome.why;
  return json;
}

// One message a check, from `first` on.
void send_outcomes(const Trial& trial, std::size_t first, const Channel& channel) {
  const auto& checks = conformance_checks();
  for (std::size_t n = first; n < checks.size(); ++n) {
    Outcome outcome;
    try {
      outcome = outcome_of(checks[n], trial);
    } catch (const EngineFailure& failure) {  // it hangs: nothing else would be answered either
      outcome = {Outcome::Answer::broken, checks[n].asks, failure.what(), "an answer", ""};
      channel.send(json_of(checks[n], outcome).dump(-1, ' ', false, Json::error_handler_t::replace));
      while (++n < checks.size())
        channel.send(json_of(checks[n], {Outcome::Answer::not_asked, "", "", "", "it no longer answered"}).dump());
      return;
    }
    channel.send(json_of(checks[n], outcome).dump(-1, ' ', false, Json::error_handler_t::replace));
  }
}

Json outcomes_of(const Trial& trial, const EngineTable& engines, double limit) {
  const auto& checks = conformance_checks();
  Json outcomes = Json::array();
  while (outcomes.size() < checks.size()) {
    const auto work = [&](const Channel& channel) {
      send_outcomes(trial, outcomes.size(), channel);
      engines.rest();
    };
    const auto on_message = [&](std::size_t, const std::string& message) { outcomes.push_back(Json::parse(message)); };
    const auto on_end = [&](std::size_t, const JobEnd& end) {
      if (outcomes.size() == checks.size()) return;
      const ConformanceCheck& check = checks[outcomes.size()];
      outcomes.push_back(
          json_of(check, {Outcome::Answer::broken, check.asks, sentence_of(end, limit), "an answer", ""}));
    };
    run_jobs({{work, limit}}, 1, on_message, on_end);
  }
  return outcomes;
}

// A scene is a long line; what follows it is worth more.
std::string cut(const std::string& text) {
  constexpr std::size_t kLongest = 600;
  return text.size() <= kLongest ? text
                                 : text.substr(0, kLongest / 2) + " ... " + text.substr(text.size() - kLongest / 2);
}

std::string table_of(const RunName& run, const Json& outcomes, bool holds) {
  std::string text = fmt::format("{}:\n", run.text);
  for (const Json& row : outcomes) {
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
bool answers(const Json& outcomes) {
  return std::none_of(outcomes.begin(), outcomes.end(),
                      [](const Json& row) { return row.at("answer") == "broken" && row.at("due") == "an answer"; });
}

}  // namespace

RunName run_asked_for(const CommandLine& line, const EngineTable& engines) {
  if (line.engines.size() > 1) throw InputError(fmt::format("rigor {}: takes one --engine", line.command));
  if (!line.engines.empty()) return parse_run_name(line.engines.front(), engines.infos());
  std::vector<std::string> outside;
  for (const EngineInfo& info : engines.infos()) {
    const std::string& identity = engines.identity_of(info.name);  // begins with what it was started by
    const bool is_meant = line.plugins.size() != 1 || identity.starts_with(line.plugins.front() + " ");
    if (!identity.empty() && is_meant) outside.push_back(info.name);
  }
  if (outside.size() != 1)
    throw InputError(fmt::format("rigor {}: which engine? Give one --plugin P, or --engine E; see rigor list engines",
                                 line.command));
  return parse_run_name(outside.front(), engines.infos());
}

int conform_command(const CommandLine& line, const EngineTable& engines) {
  const RunName run = run_asked_for(line, engines);
  const Trial trial{engines.find(run.engine), engines.info_of(run.engine), run.settings};
  const Json outcomes = outcomes_of(trial, engines, line.limit);
  bool holds = true;
  for (const Json& row : outcomes) holds = holds && row.at("answer") != "broken";
  std::optional<MistakeReport> report;
  if (!holds && answers(outcomes)) report = diagnosed(line, engines, run);
  if (line.json) {
    Json json = {{"engine", run.text}, {"version", trial.info.version}, {"conforms", holds}, {"checks", outcomes}};
    if (report) json["diagnosis"] = mistakes_json(*report, run.text);
    print(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  } else {
    print_table(table_of(run, outcomes, holds) + (report ? "\n" + text_of(*report, run.text) : ""));
  }
  return holds ? kGood : kGateFailed;
}

}  // namespace rigor
