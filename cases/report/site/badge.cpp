// badge/RUN.svg: how many cases a run keeps within the tolerance at the headline's step. Grey if nothing was compared.
#include <fmt/format.h>

#include "cases/report/html/svg.h"
#include "cases/report/site/site_pages.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

// White text on each has a contrast of 4.5 or more.
const char* colour_of(const Score& score) {
  if (score.compared == 0) return "#5f6368";
  const double share = static_cast<double>(score.within) / static_cast<double>(score.compared);
  return share >= 0.9 ? "#1d6332" : share >= 0.5 ? "#755100" : "#a1241b";
}

}  // namespace

std::string badge_of(const SiteData& data, std::size_t run) {
  const Score score = score_of(data.results, run, "", data.headline);
  const std::string dt = data.headline.text + " s";
  const std::string shown = score.compared == 0 ? "nothing compared"
                                                : fmt::format("{} of {} within {} at {}", score.within, score.compared,
                                                              quantity_text(kSiteTolerance, "m"), dt);
  const std::string title = fmt::format(
      "{}: {} of {} cases with an independent truth have an error of at most {} at dt = {}; {} failed, {} "
      "are unsupported",
      data.results.runs[run].text, score.within, score.compared, tolerance_text(), dt, score.failed, score.unsupported);
  constexpr double kLetter = 6.6, kLeftPart = 44;  // px, of DejaVu Sans at 11 px; textLength fits any other font
  const double width = kLetter * static_cast<double>(shown.size()) + 12;
  return fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="20" role="img" aria-label="rigor: {1}">
<title>{2}</title>
<rect width="{0:.0f}" height="20" rx="3" fill="#3b3f45"/>
<path d="M{3:.0f} 0h{4:.0f}a3 3 0 0 1 3 3v14a3 3 0 0 1-3 3h-{4:.0f}z" fill="{5}"/>
<g fill="#fff" text-anchor="middle" font-family="DejaVu Sans,Verdana,sans-serif" font-size="11">
<text x="{6:.0f}" y="14" textLength="{7:.0f}">rigor</text>
<text x="{8:.0f}" y="14" textLength="{9:.0f}">{1}</text>
</g>
</svg>
)",
      kLeftPart + width, escaped(shown), escaped(title), kLeftPart, width - 3, colour_of(score), kLeftPart / 2,
      kLeftPart - 14, kLeftPart + width / 2, width - 12);
}

}  // namespace rigor::inline report
