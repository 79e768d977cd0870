#include "cases/report/json/claims_json.h"

#include "core/base/json.h"

namespace rigor::inline report {

Json claims_json(const std::vector<Claim>& claims) {
  Json rows = Json::array();
  for (const Claim& claim : claims) {
    Json row = {{"quantity", claim.quantity}, {"value", claim.value}};
    for (const auto& [key, word] : {std::pair("case", &claim.of_case),
                                    {"engine", &claim.of_run},
                                    {"dt", &claim.dt},
                                    {"part", &claim.part},
                                    {"printed", &claim.printed}}) {
      if (!word->empty()) row[key] = *word;
    }
    if (claim.relation != Relation::none) row["relation"] = word_of(claim.relation), row["bound"] = claim.bound;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace rigor::inline report
