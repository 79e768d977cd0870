#include "cases/report/wording/divergence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cases/report/layout.h"

namespace rigor::inline report {
namespace {

constexpr std::size_t kTitleWidth = 10;
// A share of a bound that roundings alone reach: no difference is seen below it.
constexpr double kUnseen = 1e-9;

std::string titled_line(const std::string& head, const std::string& text) {
  return fmt::format("  {:<8}{}\n", head, wrapped(text, kTitleWidth));
}

std::string name_of_run(const DivergingRun& run) { return fmt::format("{} at {} s", run.name.text, run.dt.text); }

// With the step only where that alone tells the two apart.
std::string short_name(const Divergence& found, const DivergingRun& run) {
  return found.a.name.text == found.b.name.text ? name_of_run(run) : run.name.text;
}

// "1.2 mm": three digits, in the unit that fits.
std::string in_unit(double value, const std::string& unit) {
  const double size = std::abs(value);
  const char* prefix = size >= 1 || size == 0 ? "" : size >= 1e-3 ? "m" : size >= 1e-6 ? "u" : size >= 1e-9 ? "n" : "";
  const double factor = prefix[0] == 'm' ? 1e3 : prefix[0] == 'u' ? 1e6 : prefix[0] == 'n' ? 1e9 : 1;
  return fmt::format("{:.3g} {}{}", factor * value, prefix, unit);
}

std::string bounds_text(const PartingBounds& bounds) {
  std::vector<std::string> parts;
  const auto add = [&](double bound, const char* unit) {
    if (std::isfinite(bound)) parts.push_back(in_unit(bound, unit));
  };
  add(bounds.position, "m"), add(bounds.orientation, "rad"), add(bounds.velocity, "m/s");
  add(bounds.angular_velocity, "rad/s");
  const std::string of_size = bounds.size > 0 ? fmt::format(", for a scene of {}", in_unit(bounds.size, "m")) : "";
  return fmt::format("{}{}", fmt::join(parts, " and "), of_size);
}

std::string parting_line(const Divergence& found) {
  if (!found.parting) {
    return titled_line("part",
                       fmt::format("never in {:g} s: at most {:.2g} of the bound at {:.4g} s ({})", found.compared,
                                   found.largest.share, found.steps.seconds * static_cast<double>(found.largest.sample),
                                   bounds_text(found.bounds)));
  }
  const Parting& parting = *found.parting;
  const std::string values = parting.in_a ? fmt::format(" ({:.6g} against {:.6g})", *parting.in_a, *parting.in_b) : "";
  return titled_line(
      "part", fmt::format("at {:.4g} s: '{}' is {} apart, most in {}{}; bound {}", parting.time,
                          found.names[static_cast<std::size_t>(parting.body)], in_unit(parting.gap, parting.unit),
                          parting.component, values, bounds_text(found.bounds)));
}

std::string spread_line(const Divergence& found) {
  std::string text;
  for (const auto& [run, spread] : {std::pair(&found.a, found.spread_a), std::pair(&found.b, found.spread_b)}) {
    if (spread > 0)
      text += fmt::format("{}{} is not deterministic: its own repeats differ by {:.2g} of the bound",
                          text.empty() ? "" : "; ", short_name(found, *run), spread);
  }
  return text.empty() ? "" : titled_line("spread", text);
}

std::string entering_line(const Divergence& found) {
  const Injections& injections = found.injections;
  if (injections.steps.empty()) return titled_line("enters", "not measured: " + injections.why);
  constexpr double kNoGrowth = 0.005;  // what three digits show as 1
  const bool grows = std::abs(injections.growth_factor - 1) > kNoGrowth;
  const std::string growth = grows ? fmt::format("a nudge is multiplied by {:.3g} until then (exponent {:.2g}/s)",
                                                 injections.growth_factor, injections.growth)
                                   : std::string("a nudge does not grow until then");
  constexpr double kMore = 1.5;  // beyond what ends of a step may add
  const char* taken =
      injections.injected < 0 || injections.injected > kMore ? ", so later steps take differences back" : "";
  return titled_line(
      "enters",
      fmt::format("differences of single steps, carried on by free motion, add up to {:.3g} % of the gap{}; {}{}",
                  100 * injections.injected, taken, growth,
                  injections.has_all_steps
                      ? ""
                      : fmt::format("; {} of {} steps looked at", injections.steps.size(), found.parting->sample)));
}

// The largest hidden share of one run.
std::string hidden_of(const Divergence& found, const DivergingRun& run, double Injection::*share) {
  const auto most = std::max_element(found.injections.steps.begin(), found.injections.steps.end(),
                                     [&](const Injection& x, const Injection& y) { return x.*share < y.*share; });
  if ((*most).*share < kUnseen) return short_name(found, run) + " hides nothing";
  return fmt::format("{} hides up to {:.2g} of the bound in one step, at {:.4g} s", short_name(found, run),
                     (*most).*share, most->time);
}

std::string hidden_line(const Divergence& found) {
  if (found.injections.steps.empty()) return "";
  return titled_line("hidden", fmt::format("a world that runs against a fresh one: {}; {}",
                                           hidden_of(found, found.a, &Injection::hidden_a),
                                           hidden_of(found, found.b, &Injection::hidden_b)));
}

std::string order_text(const Cause& cause) {
  if (!cause.is_measured_at_half_step) return "";
  return fmt::format("; it {} with dt ({:.2g} of it at half the step)",
                     cause.falls_with_dt() ? "falls" : "does not fall", cause.at_half_step);
}

std::string reason_text(const Cause& cause) {
  if (!cause.why.empty()) return cause.why;
  if (cause.is_rounding) return fmt::format("rounding, {:.2g} units in the last place", cause.roundings);
  if (cause.what.empty()) return "no single part of the scene" + order_text(cause);
  return fmt::format("{}{}; {:.3g} % of it vanishes without that{}", cause.what,
                     cause.detail.empty() ? "" : " (" + cause.detail + ")", 100 * cause.share, order_text(cause));
}

// "'foot' gains", "'foot' and 3 others gain".
std::string gaining(const Divergence& found, const Injection& at) {
  const std::string& name = found.names[static_cast<std::size_t>(at.body)];
  if (at.alike == 0) return fmt::format("'{}' gains", name);
  return fmt::format("'{}' and {} other{} gain", name, at.alike, at.alike == 1 ? "" : "s");
}

// One line for all instants with the same reason.
std::string cause_lines(const Divergence& found) {
  std::string text;
  for (std::size_t n = 0; n < found.causes.size(); ++n) {
    const Cause& cause = found.causes[n];
    const auto is_like = [&](const Cause& other) {
      const bool is_of_body =
          other.at.body == cause.at.body || (other.at.alike > 0 && other.at.alike == cause.at.alike);
      return other.what == cause.what && is_of_body && other.why == cause.why &&
             other.is_rounding == cause.is_rounding && other.falls_with_dt() == cause.falls_with_dt();
    };
    const auto here = found.causes.begin() + static_cast<long>(n);
    if (std::any_of(found.causes.begin(), here, is_like)) continue;
    std::vector<std::string> also;
    for (auto other = here + 1; other != found.causes.end(); ++other) {
      if (is_like(*other)) also.push_back(fmt::format("{:.4g} s", other->at.time));
    }
    text += titled_line("why", fmt::format("at {:.4g} s, {} {:.2g} of the bound in one step: {}{}", cause.at.time,
                                           gaining(found, cause.at), cause.at.share, reason_text(cause),
                                           also.empty() ? "" : fmt::format("; also at {}", fmt::join(also, ", "))));
  }
  return text;
}

std::string truth_line(const Divergence& found) {
  const DivergenceTruth& truth = found.truth;
  if (!truth.why.empty()) return titled_line("truth", "no truth here: " + truth.why);
  const std::string unit = found.parting->unit;
  const auto mark = [](bool is_made_like) { return is_made_like ? " [the truth's own code]" : ""; };
  const std::optional<RunPair::Side> side = truth.nearer();
  const std::string nearer = !side ? "too coarse to say which is nearer"
                                   : short_name(found, *side == RunPair::Side::a ? found.a : found.b) + " is nearer";
  return titled_line(
      "truth", fmt::format("{} is {} away{}, {} is {} away{}; the truth knows {}: {}", short_name(found, found.a),
                           in_unit(truth.a, unit), mark(truth.is_made_like_a), short_name(found, found.b),
                           in_unit(truth.b, unit), mark(truth.is_made_like_b), in_unit(truth.error, unit), nearer));
}

std::string swap_text(const Divergence& found, const TriedSwap& swap) {
  std::vector<std::string> parts;
  for (const SettingSwap& one : swap.swaps)
    parts.push_back(
        fmt::format("{} of {}", name_of(one), short_name(found, one.side == RunPair::Side::a ? found.a : found.b)));
  return fmt::format("{}", fmt::join(parts, " and "));
}

std::string setting_line(const Divergence& found) {
  const SwapSearch& search = found.swaps;
  if (!search.has_differing_setting) return titled_line("setting", "none differs");
  if (search.best) {
    const std::string at_half = search.best->is_checked
                                    ? fmt::format("{:.3g} % at half the step", 100 * search.best->closes_at_half_step)
                                    : std::string("and at half the step there is no gap");
    return titled_line("setting", fmt::format("{} closes {:.3g} % of the gap, {}", swap_text(found, *search.best),
                                              100 * search.best->closes, at_half));
  }
  if (search.tried.empty()) return titled_line("setting", "none that can be changed runs here");
  const TriedSwap& most = search.tried.front();
  return titled_line("setting", fmt::format("none of {} closes half of the gap at dt and dt/2; the most: {}, {:.3g} %",
                                            search.tried.size(), swap_text(found, most), 100 * most.closes));
}

}  // namespace

std::string text_of(const Divergence& found, const std::string& run_command, const std::vector<std::string>& calls) {
  std::string text = fmt::format("{}: {} against {}\n", found.case_id, name_of_run(found.a), name_of_run(found.b));
  text += parting_line(found) + spread_line(found);
  if (!found.ended.empty()) text += titled_line("ends", found.ended);
  if (!found.parting) return text;
  text += truth_line(found);
  if (found.parting->sample == 0) return text + titled_line("why", "the engines start in different states");
  text += entering_line(found) + hidden_line(found);
  text += cause_lines(found);
  text += setting_line(found);
  if (!run_command.empty()) text += "          " + run_command + "\n";
  if (!calls.empty()) text += fmt::format("          {}\n", fmt::join(calls, "\n          "));
  return text;
}

}  // namespace rigor::inline report
