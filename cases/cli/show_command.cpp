// rigor show: prints cases as JSON, with each default written out and arrays expanded. For programs, as the package for
// Python.
#include "cases/cli/chosen_cases.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/vocabulary.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor::inline cli {
namespace {

Json texts_of(const std::vector<StepSize>& steps) {
  Json texts = Json::array();
  for (const StepSize& step : steps) texts.push_back(step.text);
  return texts;
}

// In the words of the case file. Keys that a gate does not have are left out.
Json json_of(const Gate& gate) {
  Json json = {{"metric", gate.metric}, {"because", gate.because}, {"where", gate.where}};
  json["of_family"] = gate.is_of_family;
  if (!gate.engines.empty()) json["engines"] = gate.engines;
  if (!gate.dt.empty()) json["dt"] = texts_of(gate.dt);
  const auto [max, min, equals] = gate.bound();
  if (max) json["max"] = *max;
  if (min) json["min"] = *min;
  if (equals) json["equals"] = *equals;
  if (const OrderLimit* order = gate.order()) {
    json["at_least_order"] = order->is_declared ? Json("declared") : Json(order->at_least);
    if (order->is_declared) json["tolerance"] = order->at_least;
  }
  if (const RankingLimit* ranking = gate.ranking()) json["better_than"] = ranking->better_than;
  if (const RegressionLimit* regression = gate.regression()) json["regression"] = regression->factor;
  return json;
}

Json json_of(const Case& definition) {
  Json gates = Json::array(), losses = Json::array();
  for (const Gate& gate : definition.gates) gates.push_back(json_of(gate));
  for (const Loss& loss : definition.losses)
    losses.push_back({{"kind", word_of(loss.kind)}, {"sentence", sentence_of(loss)}});
  return {{"id", definition.id},
          {"title", definition.title},
          {"source", definition.source},
          {"scene", parse_json(scene_json(definition.scene))},
          {"duration", definition.duration},
          {"dt", texts_of(definition.dt)},
          {"ensemble", definition.ensemble},
          {"truth", definition.truth},
          {"gates", gates},
          {"losses", losses},
          {"text", definition.text}};
}

class ShowCommand : public Command {
 public:
  void declare(Options& options) override { cases_.declare(options), outside_.declare(options); }

  int run(const Invocation& invocation) override {
    constexpr double kLimit = 120;  // s, in which a plug-in says what it is
    if (cases_.words.empty()) throw InputError("rigor show: takes at least one case; rigor list cases names them");
    const EngineTable engines = outside_.table(kLimit);
    Json cases = Json::array();
    for (const Case& definition : chosen_cases(cases_, invocation, vocabulary_of(engines.infos())))
      cases.push_back(json_of(definition));
    print(Json{{"cases", cases}}.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
    return kGood;
  }

 private:
  CaseWords cases_;
  PluginOption outside_;
};

}  // namespace

CommandRow show_row() {
  return {"show",
          "print cases as JSON, with each default written out",
          "CASE",
          kCases,
          {{"rigor show springs/fixed-spring", "a scene, its run, truth and gates as one line of JSON"},
           {"rigor show robot.urdf", "what a robot's file becomes"}},
          make_command<ShowCommand>};
}

}  // namespace rigor::inline cli
