// Chooses the settings of a method that a tuning tries: combinations of option values that change the motion.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cases/analysis/tuning/tuning_probe.h"
#include "cases/analysis/tuning/tuning_space.h"

namespace rigor::inline analysis {

// A probe may take kFarDearer times as long as others of its kind, because a dearer setting cannot win. The limit is at
// least kLeastLimit [s of CPU time]. The overhead of a probe, some tens of milliseconds, is then negligible, and the
// pool, which allows ten times as much by the clock, does not end a probe that waits on a busy machine.
inline constexpr double kFarDearer = 20, kLeastLimit = 3;

class SettingChooser {
 public:
  SettingChooser(Prober& prober, const TuneOptions& options) : prober_(prober), options_(options) {}

  // The names of runs, with the unchanged method first. All combinations if they fit into `most`. Otherwise each value
  // alone, and then drawn combinations.
  std::vector<std::string> settings_of(const MethodSpace& space, std::size_t most);
  const std::vector<std::string>& without_effect() const { return without_effect_; }  // "worldstep: erp"

 private:
  using Choices = std::vector<std::pair<std::string, std::vector<std::string>>>;  // option, values
  struct Effect {
    std::vector<double> values;  // of runs at two steps, for all bounds and cases
    double seconds = 0;          // its duration
    bool is_late = false;
  };

  struct Runnable {
    MethodSpace space;
    std::string needed;  // the option that its base names, so that it runs; else empty
  };
  using Effects = std::map<std::string, Effect>;  // by run

  void screen(const std::vector<std::string>& runs, double limit, double share, Effects& effects);
  bool screen_option(const MethodSpace& space, const OptionInfo& option, double limit, double share, Effects& effects);
  Runnable runnable(const MethodSpace& space);
  Choices options_with_effect(const MethodSpace& space);
  static std::vector<std::string> values_with_effect(const MethodSpace& space, const OptionInfo& option,
                                                     const Effects& effects);

  Prober& prober_;
  const TuneOptions& options_;
  Effects short_, whole_;  // of a share of the run, and of all of it
  std::vector<std::string> without_effect_;
};

}  // namespace rigor::inline analysis
