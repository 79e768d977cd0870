// rigor list: prints the tables of cases, engines, integrators, metrics and truths.
#include <fmt/format.h>

#include <algorithm>

#include "adapters/engines.h"
#include "cases/case/suite.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/vocabulary.h"
#include "cases/metrics/metric.h"
#include "cases/report/layout.h"
#include "cases/truth/provenance.h"
#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "core/base/names_of.h"
#include "core/base/near_match.h"

namespace rigor::inline cli {
namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

Rows case_rows(const std::string& suite, const EngineTable& engines) {
  Rows rows;
  for (const Case& definition : select_cases({}, suite, vocabulary_of(engines.infos())))
    rows.emplace_back(definition.id, definition.title);
  return rows;
}

std::string option_text(const OptionInfo& option) {
  const std::string values = option.choices.empty() ? fmt::format("{}..{}", option.min, option.max)
                                                    : fmt::format("{}", fmt::join(option.choices, "|"));
  const std::string by_default = default_text(option);
  return fmt::format("{}={}{}", option.name, values,
                     by_default.empty() ? "" : fmt::format(" (default {})", by_default));
}

std::string method_text(const MethodInfo& method) {
  std::string text =
      fmt::format("order {}{}; {}", method.order, method.symplectic ? ", symplectic" : "", method.summary);
  for (const OptionInfo& option : method.options) text += fmt::format("; {}", option_text(option));
  return text;
}

Rows engine_rows(const std::string&, const EngineTable& engines) {
  Rows rows;
  for (const EngineInfo& engine : engines.infos()) {
    std::vector<std::string> methods;
    for (const MethodInfo& method : engine.methods) methods.push_back(method.name);
    rows.emplace_back(engine.name,
                      fmt::format("{}, {} precision; methods: {}", engine.version, engine.precision, listed(methods)));
    for (const MethodInfo& method : engine.methods) {
      if (!engine.is_in_house) rows.emplace_back("  " + engine.name + ":" + method.name, method_text(method));
    }
    if (engine.is_in_house) rows.back().second += " (see integrators)";
    for (const EngineOnRequest& row : engines_on_request()) {
      if (row.name == engine.name)
        rows.emplace_back("  " + row.name, fmt::format("runs where it is named, --engine {}: {}", row.name, row.why));
    }
  }
  for (const MissingEngine& engine : missing_engines()) rows.emplace_back(engine.name, engine.how);
  return rows;
}

Rows integrator_rows(const std::string&, const EngineTable& engines) {
  Rows rows;
  for (const EngineInfo& engine : engines.infos()) {
    if (!engine.is_in_house) continue;
    for (const MethodInfo& method : engine.methods)
      rows.emplace_back(engine.name + ":" + method.name, method_text(method));
  }
  return rows;
}

Rows metric_rows(const std::string&, const EngineTable&) {
  Rows rows;
  for (const MetricRow& metric : metrics())
    rows.emplace_back(metric.name, fmt::format("[{}] {}", metric.unit, metric.summary));
  for (const CrossMetricRow& metric : cross_metrics())
    rows.emplace_back(metric.name, fmt::format("[{}] {}", metric.unit, metric.summary));
  return rows;
}

Rows truth_rows(const std::string&, const EngineTable&) {
  Rows rows;
  for (const TruthRow& truth : truths())
    rows.emplace_back(truth.name, fmt::format("{}; {}", truth.summary, provenance_of(truth.name)));
  return rows;
}

struct Kind {
  std::string name;
  Rows (*rows)(const std::string& suite, const EngineTable& engines);
};
const std::vector<Kind> kKinds = {{"cases", case_rows},
                                  {"engines", engine_rows},
                                  {"integrators", integrator_rows},
                                  {"metrics", metric_rows},
                                  {"truths", truth_rows}};

// Lines stay whole in a pipe, where other programs read them. On a narrow terminal a text stands below its name.
std::string table(const Rows& rows) {
  std::size_t width = 0;
  for (const auto& [name, text] : rows) width = std::max(width, name.size());
  const bool is_wrapped = terminal_width().has_value(), is_below = is_wrapped && 2 * (width + 4) > console_width();
  constexpr std::size_t kIndent = 6;
  std::string out;
  for (const auto& [name, text] : rows) {
    const std::string gap = is_below ? "\n" + std::string(kIndent, ' ') : std::string(width + 2 - name.size(), ' ');
    out += "  " + name + gap + (is_wrapped ? wrapped(text, is_below ? kIndent : width + 4) : text) + "\n";
  }
  return out;
}

class ListCommand : public Command {
 public:
  void declare(Options& options) override {
    options.add_words(words_);
    outside_.declare(options), suite_.declare(options);
  }

  int run(const Invocation&) override {
    const std::vector<std::string> names = names_of(kKinds);
    for (const std::string& word : words_) {
      if (std::find(names.begin(), names.end(), word) == names.end()) {
        throw InputError(fmt::format("rigor list: there is no list '{}'{}; there are: {}", word,
                                     did_you_mean(word, names), listed(names)));
      }
    }
    const EngineTable engines = outside_.table(TimeoutOption().seconds);
    std::string text;
    for (const Kind& kind : kKinds) {
      const bool is_wanted = words_.empty() || std::find(words_.begin(), words_.end(), kind.name) != words_.end();
      if (is_wanted)
        text += fmt::format("{}{}:\n{}", text.empty() ? "" : "\n", kind.name, table(kind.rows(suite_.dir, engines)));
    }
    print_table(text);
    return kGood;
  }

 private:
  std::vector<std::string> words_;
  PluginOption outside_;
  SuiteOption suite_;
};

}  // namespace

CommandRow list_row() {
  return {"list",
          "list cases, engines, integrators, metrics and truths",
          "KIND",
          "cases, engines, integrators, metrics or truths; default: all",
          {{"rigor list", "everything"},
           {"rigor list cases engines", "two of the lists"},
           {"rigor list engines --plugin 'python3 my_engine.py'", "with an engine of your own"}},
          make_command<ListCommand>,
          names_of(kKinds)};
}

}  // namespace rigor::inline cli
