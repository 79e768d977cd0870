#include "cases/case/run_selector.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline cases {
namespace {

const std::vector<std::string> kWords = {"@matched",  "@stock",     "adaptive", "order>=1",
                                         "symmetric", "symplectic", "twin"};

bool is_word(const std::string& text) {
  return std::find(kWords.begin(), kWords.end(), text) != kWords.end() || text.starts_with("@") ||
         text.find_first_of("*!") != std::string::npos || text.starts_with("order");
}

// `*` matches any letters, or none. The text between two stars is matched at its first occurrence, which leaves the
// most room for the rest. The time is therefore linear, even with many stars.
bool matches(std::string_view pattern, std::string_view text) {
  std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  text.remove_prefix(star);
  while (true) {
    pattern.remove_prefix(star + 1);
    star = pattern.find('*');
    if (star == std::string_view::npos) return text.ends_with(pattern);
    const std::size_t at = text.find(pattern.substr(0, star));
    if (at == std::string_view::npos) return false;
    text.remove_prefix(at + star);
  }
}

// A name with *, split as a run's is.
struct Pattern {
  std::string head, options, track;
  explicit Pattern(const std::string& text) : head(text.substr(0, text.find_first_of(",@"))) {
    const std::size_t comma = text.find(','), at = text.find('@');
    if (at != std::string::npos) track = text.substr(at + 1);
    if (comma < at) options = text.substr(comma, at == std::string::npos ? at : at - comma);
  }
};

struct Comparison {
  const char* sign;
  bool (*holds)(int order, int limit);
};
// The longer signs first.
constexpr std::array<Comparison, 5> kComparisons = {{{">=", [](int a, int b) { return a >= b; }},
                                                     {"<=", [](int a, int b) { return a <= b; }},
                                                     {">", [](int a, int b) { return a > b; }},
                                                     {"<", [](int a, int b) { return a < b; }},
                                                     {"=", [](int a, int b) { return a == b; }}}};

// What is selected from, one run of it, and the words that it has to meet.
class Selector {
 public:
  Selector(const std::string& text, const std::vector<EngineInfo>& engines) : text_(text), engines_(engines) {
    std::istringstream words(text);
    for (std::string word; words >> word;) words_.push_back(word);
  }

  bool meets(const RunName& run) const {
    return std::all_of(words_.begin(), words_.end(), [&](const std::string& word) {
      return word.starts_with("!") ? !meets(run, word.substr(1)) : meets(run, word);
    });
  }

  // The options that the selector spells, ",contact=event".
  std::string options() const {
    std::string options;
    for (const std::string& word : words_) {
      if (!word.starts_with("!")) options += Pattern(word).options;
    }
    return options;
  }

 private:
  bool meets(const RunName& run, const std::string& word) const {
    const MethodInfo& method = method_of(engine_of(run), run.settings);
    if (word == "symplectic") return method.symplectic;
    if (word == "symmetric") return method.symmetric;
    if (word == "adaptive") return method.adaptive;
    if (word == "twin") return has_twin(run);
    if (word == "@stock") return run.settings.track == Track::stock;
    if (word == "@matched") return run.settings.track == Track::matched;
    if (word.starts_with("order")) return meets_order(method.order, word);
    return meets_name(run, word);
  }

  bool meets_name(const RunName& run, const std::string& word) const {
    const Pattern pattern(word);
    const bool is_name = word.find('*') != std::string::npos ||
                         std::any_of(engines_.begin(), engines_.end(),
                                     [&](const EngineInfo& e) { return pattern.head.starts_with(e.name); });
    if (!is_name || (!pattern.track.empty() && pattern.track != "stock" && pattern.track != "matched")) refuse(word);
    if (!pattern.track.empty() && (pattern.track == "stock") != (run.settings.track == Track::stock)) return false;
    return matches(pattern.head, run.engine) || matches(pattern.head, run.engine + ":" + run.settings.method);
  }

  bool meets_order(int order, const std::string& word) const {
    for (const Comparison& comparison : kComparisons) {
      const std::string head = std::string("order") + comparison.sign;
      if (!word.starts_with(head)) continue;
      int limit = 0;
      const char *first = word.data() + head.size(), *last = word.data() + word.size();
      const auto [end, error] = std::from_chars(first, last, limit);
      if (error == std::errc() && end == last) return comparison.holds(order, limit);
    }
    refuse(word);
  }

  const EngineInfo& engine_of(const RunName& run) const {
    return *std::find_if(engines_.begin(), engines_.end(), [&](const EngineInfo& e) { return e.name == run.engine; });
  }

  bool has_twin(const RunName& run) const {
    return std::any_of(engines_.begin(), engines_.end(), [&](const EngineInfo& engine) {
      return std::any_of(engine.methods.begin(), engine.methods.end(),
                         [&](const MethodInfo& method) { return method.twin_of == run.engine; });
    });
  }

  [[noreturn]] void refuse(const std::string& word) const {
    throw InputError(fmt::format("'{}': '{}' says nothing about a run{}; allowed: names with *, {}", text_, word,
                                 did_you_mean(word, kWords), listed(kWords)));
  }

  std::string text_;
  const std::vector<EngineInfo>& engines_;
  std::vector<std::string> words_;
};

// "ode@stock" with ",iterations=50" in its place before the track.
std::string with_options(const std::string& name, const std::string& options) {
  const std::size_t at = std::min(name.find('@'), name.size());
  return name.substr(0, at) + options + name.substr(at);
}

}  // namespace

std::vector<RunName> default_runs(const std::vector<EngineInfo>& engines) {
  std::vector<RunName> runs;
  for (const EngineInfo& engine : engines) {
    if (engine.is_in_house) {
      for (const MethodInfo& method : engine.methods) {
        if (method.twin_of.empty()) runs.push_back(parse_run_name(engine.name + ":" + method.name, engines));
      }
    } else {
      runs.push_back(parse_run_name(engine.name, engines));
      runs.push_back(parse_run_name(engine.name + "@stock", engines));
    }
  }
  return runs;
}

bool is_run_selector(const std::string& text) { return text.find(' ') != std::string::npos || is_word(text); }

std::vector<std::string> selected_runs(const std::string& selector, const std::vector<EngineInfo>& engines) {
  const Selector selects(selector, engines);
  std::vector<std::string> names;
  std::string why = fmt::format("'{}' selects no run; see 'rigor list engines'", selector);
  for (const RunName& run : default_runs(engines)) {
    if (!selects.meets(run)) continue;
    try {
      names.push_back(parse_run_name(with_options(run.text, selects.options()), engines).text);
    } catch (const InputError& error) {  // a method without such an option, which others may have
      why = error.what();
    }
  }
  if (names.empty()) throw InputError(why);
  return names;
}

}  // namespace rigor::inline cases
