// The error that each closed form of the suite claims. Verdicts end where it exceeds a tolerance, so it may change only
// on purpose. This is a regression test of the truths, beside the comparisons with other solutions.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cases/case/suite.h"
#include "cases/truth/provenance.h"
#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "generated/tests/places.h"
#include "tests/cases/truth/closed_form/smooth/smooth_scenes.h"
#include "tests/cases/truth/closed_form/spoilt_scenes.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_claimed_errors)

namespace {

const std::filesystem::path kRecorded = RIGOR_SOURCE_DIR "/tests/cases/truth/closed_form/claimed_errors.txt";
const std::filesystem::path kFound = RIGOR_BUILD_DIR "/tests/claimed_errors.txt";

using Claims = std::vector<std::pair<std::string, std::vector<double>>>;  // by scene, in order

// At quarters of each of these durations; a scene that is refused for one claims nothing.
std::vector<double> claims_of(const std::string& truth, const Scene& scene, std::initializer_list<double> durations) {
  std::vector<double> claims;
  for (const double duration : durations) {
    try {
      const auto made = make_truth(truth, scene, duration);
      for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) claims.push_back(made->error(share * duration));
    } catch (const InputError&) {
    }
  }
  return claims;
}

// Over scenes changed in one place after another: the number refused, the number whose end exceeds the form's validity,
// and the sum of the others' decades, which reveals any change.
std::vector<double> spoilt_claims_of(const std::string& truth, const Scene& whole, double duration) {
  double refused = 0, left = 0, decades = 0;
  for (const test::Change& change : test::changes_of(whole)) {
    Scene scene = whole;
    change.make(scene);
    if (!test::is_a_scene(scene)) continue;
    const std::vector<double> claims = claims_of(truth, scene, {duration});
    if (claims.empty()) ++refused;
    for (const double error : claims) std::isfinite(error) ? decades += std::log10(error) : ++left;
  }
  return {refused, left, decades};
}

// Most scenes leave within four times their duration what their closed form holds for.
Claims found_claims() {
  Claims found;
  for (const Case& c : select_cases({}, default_suite_dir(), test::words())) {
    if (!provenance_of(c.truth).starts_with("a closed form")) continue;
    found.emplace_back(fmt::format("{} {}", c.truth, c.id), claims_of(c.truth, c.scene, {c.duration, 4 * c.duration}));
    found.emplace_back(fmt::format("{} {}, changed", c.truth, c.id), spoilt_claims_of(c.truth, c.scene, c.duration));
  }
  for (const test::SmoothScene& row : test::smooth_scenes())
    found.emplace_back(fmt::format("{} {}", row.truth, row.label),
                       claims_of(row.truth, row.scene, {row.duration, 4 * row.duration}));
  return found;
}

void write(const Claims& claims, const std::filesystem::path& file) {
  std::ofstream out(file);
  for (const auto& [name, errors] : claims) {
    out << name << ':';
    for (const double error : errors) out << fmt::format(" {:.8g}", error);
    out << '\n';
  }
}

Claims read(const std::filesystem::path& file) {
  Claims claims;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line.substr(line.rfind(':') + 1));
    claims.emplace_back(line.substr(0, line.rfind(':')), std::vector<double>());
    for (std::string word; words >> word;) claims.back().second.push_back(std::stod(word));
  }
  return claims;
}

// What is below a rounding of a nanometre is the rounding of a rounding.
bool are_same(double a, double b) {
  return a == b || std::abs(a - b) <= 1e-5 * std::max(std::abs(a), std::abs(b)) + 1e-25;
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_closed_form_claims_another_error_than_was_recorded) {
  const Claims recorded = read(kRecorded), found = found_claims();
  write(found, kFound);
  BOOST_TEST_MESSAGE("the errors as they are now: " << kFound.string());
  BOOST_REQUIRE(recorded.size() == found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    BOOST_TEST(found[i].first == recorded[i].first);
    BOOST_TEST_CONTEXT(found[i].first << ", if it is meant: cp " << kFound.string() << ' ' << kRecorded.string()) {
      BOOST_REQUIRE(found[i].second.size() == recorded[i].second.size());
      for (std::size_t n = 0; n < found[i].second.size(); ++n)
        BOOST_TEST(are_same(found[i].second[n], recorded[i].second[n]), "sample " << n << ": " << found[i].second[n]
                                                                                  << " where " << recorded[i].second[n]
                                                                                  << " is recorded");
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
