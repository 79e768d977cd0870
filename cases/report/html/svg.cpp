#include "cases/report/html/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace rigor::inline report {
namespace {

constexpr const char* kStyle = R"(<style>
:root { color-scheme: light dark; --ink: #1b1d21; --paper: #fcfcfa; --faint: #63676e; --rule: #d5d5d5;
  --stable: #3b76c4; --drifting: #9cc3ea; --overlapping: #d9c84a; --gaining: #f0a13a; --collapsed: #b5651d; --tunnelled: #7b3fa0; --blown-up: #b3261e;
  --unsupported: #d9d9d9; --invalid: #8a8a8a; --broke-off: #111;
  --run-0: #3b76c4; --run-1: #d1602b; --run-2: #2c8c57; --run-3: #8d4fb0; --run-4: #b3261e; --run-5: #7a6a1f; --run-6: #1c9aa8; --run-7: #c24a86 }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e6e2; --paper: #16181b; --faint: #a0a4ab; --rule: #3a3d42;
  --stable: #4f8fe0; --drifting: #24476e; --blown-up: #d64a3f; --unsupported: #3a3d42; --invalid: #6f747b; --broke-off: #f2f2ee; --tunnelled: #a673c9;
  --run-0: #6aa5ee; --run-1: #ee8a5c; --run-2: #5fbf8a; --run-3: #b98bd8; --run-4: #ee766c; --run-5: #c2b04f; --run-6: #4cc3d1; --run-7: #e57fb1 } }
body { font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper); margin: 0 auto; padding: 20px; max-width: 1240px }
h1 { font-size: 22px; margin: 0 0 4px } h2 { font-size: 18px; margin: 28px 0 4px } h3 { font-size: 15px; margin: 14px 0 0 }
p { margin: 4px 0 } .faint { color: var(--faint) } .row { display: flex; flex-wrap: wrap; gap: 4px 18px }
figure { margin: 0 } figcaption { font-size: 13px; color: var(--faint) }
svg { display: block } svg rect { shape-rendering: crispEdges } svg text { font: 11px system-ui, sans-serif; fill: var(--ink) } .rule { stroke: var(--rule) } .axis { stroke: var(--faint) }
.key { display: inline-flex; align-items: center; gap: 6px; margin-right: 16px } .key i { width: 14px; height: 14px; border-radius: 3px; display: inline-block }
.limit { stroke: var(--ink); stroke-width: 2 } .limit-halo { stroke: var(--paper); stroke-width: 4.5; stroke-linecap: square } .key i.limit-sample { height: 0; border-top: 2px solid var(--ink); border-radius: 0 }
.bar { width: 140px; height: 12px; border-radius: 3px; display: inline-block }
</style></head><body>
)";

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string svg_text(double x, double y, const std::string& text, const char* anchor, double turn) {
  const std::string turned = turn == 0 ? "" : fmt::format(" transform=\"rotate({:g} {:.1f} {:.1f})\"", turn, x, y);
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>", x, y, anchor, turned,
                     escaped(text));
}

std::string svg_line(double x1, double y1, double x2, double y2, const char* css_class) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>", x1, y1, x2, y2,
                     css_class);
}

// Five points of the map "viridis" (van der Walt, Smith, SciPy 2015), from its light end.
std::string shade(double share) {
  constexpr std::array<std::array<double, 3>, 5> stops = {
      {{253, 231, 37}, {94, 201, 98}, {33, 145, 140}, {59, 82, 139}, {68, 1, 84}}};
  const double at = std::clamp(share, 0.0, 1.0) * 4;
  const auto i = static_cast<std::size_t>(std::min(3.0, std::floor(at)));
  const double rest = at - static_cast<double>(i);
  std::array<int, 3> mixed{};
  for (std::size_t c = 0; c < 3; ++c) mixed[c] = static_cast<int>(stops[i][c] + rest * (stops[i + 1][c] - stops[i][c]));
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

std::string page_head(const std::string& title) {
  return fmt::format(
             R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{}</title>)",
             escaped(title)) +
         kStyle;
}

std::string tick(double value) {
  if (!std::isfinite(value) || value == 0) return fmt::format("{:g}", value);
  const std::string scientific = fmt::format("{:.1e}", value);  // two digits
  const double rounded = std::strtod(scientific.c_str(), nullptr);
  if (std::abs(rounded) >= 1e-3 && std::abs(rounded) < 1e5) return fmt::format("{:.15g}", rounded);
  const std::size_t e = scientific.find('e');
  std::string mantissa = scientific.substr(0, e), raised;
  if (mantissa.ends_with(".0")) mantissa.resize(mantissa.size() - 2);
  static constexpr const char* kRaised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  for (const char c : fmt::format("{}", std::atoi(scientific.c_str() + e + 1)))
    raised += c == '-' ? "⁻" : kRaised[c - '0'];
  return mantissa + "·10" + raised;
}

}  // namespace rigor::inline report
