// The settings of a method that a tuning tries: combinations of those values of its options that change something.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cases/analysis/tuning/tuning_probe.h"
#include "cases/analysis/tuning/tuning_space.h"

namespace rigor {

// How much longer than its like [s of CPU time] a probe may take: what is so much dearer is no winner. At least so long
// that the rest of a probe, some tens of milliseconds, is nothing beside it, and that on a busy machine the pool, which
// allows ten times as much by the clock, ends none for its waiting.
inline constexpr double kFarDearer = 20, kLeastLimit = 3;

class SettingChooser {
 public:
  SettingChooser(Prober& prober, const TuneOptions& options) : prober_(prober), options_(options) {}

  // The names of runs, the method as it is first. All combinations, or as many as there may be: each value by itself
  // first, the rest drawn.
  std::vector<std::string> settings_of(const MethodSpace& space, std::size_t most);
  const std::vector<std::string>& without_effect() const { return without_effect_; }  // "worldstep: erp"

 private:
  using Choices = std::vector<std::pair<std::string, std::vector<std::string>>>;  // option, values
  struct Effect {
    std::vector<double> values;  // of a short run at two steps, of all bounds and cases
    double seconds = 0;          // that took
    bool is_late = false;
  };

  void screen(const std::vector<std::string>& runs, double limit);
  bool has_effect(const MethodSpace& space, const OptionInfo& option) const;
  Choices options_with_effect(const MethodSpace& space);

  Prober& prober_;
  const TuneOptions& options_;
  std::map<std::string, Effect> effects_;  // by run
  std::vector<std::string> without_effect_;
};

}  // namespace rigor
