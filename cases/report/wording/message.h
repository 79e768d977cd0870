// A message of a report, and the facts that it states as data. Its text is made from these facts, and a test recomputes
// each of them from the results.
#pragma once

#include <string>
#include <vector>

namespace rigor::inline report {

enum class Relation { none, below, at_most, above, at_least, equal };
std::string word_of(Relation relation);  // "", "<", "<=", ">", ">=", "="

// A quantity has one value in the results, or in a case's scene. `quantity` is a metric's name, alone or behind one of
// the words below; or a word that the code which states it explains.
//   signed M           M with the sign of what was found less what was expected
//   first second of M  M within the first second
//   scheme's M         signed M of the run's twin
//   scheme's M without gyroscopic term
//   count of V         cells with this verdict or status; `of_run` set: of this run; at `dt` if set
struct Claim {
  std::string quantity;
  std::string of_case = "";  // empty: all cases
  std::string of_run = "";   // a run's name; empty: a fact of the scene
  std::string dt = "";       // as written
  std::string part = "";     // a joint's or spring's name, or a second run's
  double value = 0;          // SI units
  Relation relation = Relation::none;
  double bound = 0;          // value `relation` bound
  std::string printed = "";  // as it stands in the text; empty: the text states only the relation
};

struct Message {
  std::string topic;
  std::string text;
  std::string more = "";  // what stands behind it: all names, cases, reasons; may be empty
  std::vector<Claim> claims = {};
};

// Collects the claims of a message while its text is made.
class Claims {
 public:
  // Each returns the text that states the claim.
  std::string printed(Claim claim, const std::string& text);
  std::string quantity(Claim claim, const std::string& unit);  // "31 mm", "0.66"
  std::string percent(Claim claim);                            // "3.4 %", of a share
  std::string count(Claim claim);
  // A fact that the text states without its number.
  void state(Claim claim) { claims_.push_back(std::move(claim)); }

  std::vector<Claim> take() { return std::move(claims_); }

 private:
  std::vector<Claim> claims_;
};

}  // namespace rigor::inline report
