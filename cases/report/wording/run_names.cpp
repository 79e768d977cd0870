#include "cases/report/wording/run_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

namespace rigor::inline report {

bool RunNames::is_common(std::size_t run) const {
  const auto is_its = [run](const Cell& cell) { return cell.run == run; };
  const auto has_it = [&](const CaseResult& result) {
    return std::any_of(result.cells.begin(), result.cells.end(), is_its);
  };
  return 2 * std::count_if(results_.cases.begin(), results_.cases.end(), has_it) >= std::ssize(results_.cases);
}

std::vector<std::size_t> RunNames::order() const {
  std::vector<std::size_t> order(results_.runs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [&](std::size_t run) { return !is_ours(run); });
  return order;
}

std::size_t RunNames::ours_among(const std::vector<std::size_t>& runs) const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [&](std::size_t run) { return is_ours(run); }));
}

std::string RunNames::all(const std::vector<std::size_t>& runs) const {
  std::vector<std::string> names;
  for (const std::size_t run : runs) names.push_back(of(run));
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::string RunNames::brief(const std::vector<std::size_t>& runs, std::size_t all_ours, const std::string& what,
                            Claims& claims) const {
  std::vector<std::size_t> named;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(named), [&](std::size_t run) { return !is_ours(run); });
  const std::size_t ours = runs.size() - named.size();
  if (ours <= kFewOfOurs) return all(runs);
  const auto counted = [&](const std::string& of, std::size_t count) {
    return claims.count({of + what, "", "", "", "", static_cast<double>(count)});
  };
  const std::string total = counted("core methods in all: ", all_ours);
  const std::string count = ours == all_ours
                                ? fmt::format("all {} core methods", total)
                                : fmt::format("{} of {} core methods", counted("core methods: ", ours), total);
  return named.empty() ? count : all(named) + ", " + count;
}

}  // namespace rigor::inline report
