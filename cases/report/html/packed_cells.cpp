#include "cases/report/html/packed_cells.h"

#include <map>
#include <string>

#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// Values in the order in which they first came, each once.
class Distinct {
 public:
  std::size_t index_of(const Json& value) {
    const auto [found, is_new] = indices_.try_emplace(text_of(value, -1), values_.size());
    if (is_new) values_.push_back(value);
    return found->second;
  }
  Json take() { return std::move(values_); }

 private:
  std::map<std::string, std::size_t> indices_;
  Json values_ = Json::array();
};

Json packed_metric(const std::string& name, Json& metric, Distinct& strings) {
  Json row = Json::array({strings.index_of(name), metric["value"]});
  const Json worst = metric.value("worst", Json());
  metric.erase("value"), metric.erase("worst");
  if (worst.is_object()) {
    row.push_back(worst.at("time"));
    row.push_back(strings.index_of(worst.at("body")));
    row.push_back(strings.index_of(worst.at("component")));
    if (worst.contains("found")) row.push_back(worst.at("found")), row.push_back(worst.at("expected"));
  }
  if (!metric.empty()) row.push_back(std::move(metric));
  return row;
}

}  // namespace

void pack_cells(Json& results) {
  Distinct strings, settings;
  for (Json& cell : results["cells"]) {
    Json metrics = Json::array();
    for (auto& [name, metric] : cell["metrics"].items()) metrics.push_back(packed_metric(name, metric, strings));
    cell["metrics"] = std::move(metrics);
    cell["settings"] = settings.index_of(cell["settings"]);
  }
  results["strings"] = strings.take(), results["cell_settings"] = settings.take();
}

}  // namespace rigor::inline report
