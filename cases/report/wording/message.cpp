#include "cases/report/wording/message.h"

#include <fmt/format.h>

#include "cases/report/wording/wording.h"

namespace rigor::inline report {

std::string word_of(Relation relation) {
  switch (relation) {
    case Relation::none:
      return "";
    case Relation::below:
      return "<";
    case Relation::at_most:
      return "<=";
    case Relation::above:
      return ">";
    case Relation::at_least:
      return ">=";
    case Relation::equal:
      return "=";
  }
  return "";
}

std::string Claims::printed(Claim claim, const std::string& text) {
  claim.printed = text;
  claims_.push_back(std::move(claim));
  return text;
}

std::string Claims::quantity(Claim claim, const std::string& unit) {
  const std::string text = quantity_text(claim.value, unit);
  return printed(std::move(claim), text);
}

std::string Claims::percent(Claim claim) {
  const std::string text = percent_text(claim.value);
  return printed(std::move(claim), text);
}

std::string Claims::count(Claim claim) {
  const std::string text = fmt::format("{:.0f}", claim.value);
  return printed(std::move(claim), text);
}

}  // namespace rigor::inline report
