// The motion and the metric series of one run that the page plays and plots, thinned. The room for a run is known only
// after all runs are made. Each is therefore packed several times, from fine to coarse, and the page takes the finest
// that fits. Full precision stays in the CSV files. page/src/playback_data.js reads the format; playback.cpp describes
// its layout.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"
#include "cases/runner/recorder.h"

namespace rigor::inline report {

// A series beside the metrics': (E - E at the start) / the truth's largest kinetic energy, with its sign, as read.
inline constexpr const char* kEnergyChange = "energy_change";

// The names that a packed series' number stands for.
const std::vector<std::string>& series_names();

// Texts in base64, the finest first, each shorter than the one before. All but the finest leave out the series that the
// page shows only on request. The coarsest may have no motion.
using Packings = Recording;

// The packings of one run, each at most `limit` characters. `truth` may be null. A run that looks the same as the truth
// keeps no motion of its own.
Packings packed_run(const JudgedRun& run, const std::vector<NamedSeries>& series, double largest_kinetic_energy,
                    std::size_t limit);

// Likewise of the truth itself.
Packings packed_truth(const Scene& scene, const Truth& truth, double duration, double largest_kinetic_energy,
                      std::size_t limit);

// The largest number of characters for a trial of a cell, or, without dt, of the truth: some times its even share. No
// longer packing need be kept.
class PlaybackLimit {
 public:
  explicit PlaybackLimit(const Results& grid);
  std::size_t of(const Case& definition, const StepSize* dt) const;

 private:
  double weights_ = 0;  // of the whole grid
};

class PlaybackRecorder : public Recorder {
 public:
  explicit PlaybackRecorder(const Results& grid) : limit_(grid) {}  // as planned
  static constexpr const char* kName = "playback";
  std::string name() const override { return kName; }
  Recording of_truth(const Case& definition, const Truth& truth, const TruthFacts& facts) const override;
  Recording of_run(const Case& definition, const Cell& cell, const JudgedRun& run,
                   const std::vector<NamedSeries>& series, const TruthFacts& facts) const override;
  bool keeps_each_trial() const override { return true; }
  void discard(const Cell&) const override {}
  bool still_has(const Cell&) const override { return true; }

 private:
  PlaybackLimit limit_;
};

// The motions of a case without trials: one. Else one for each trial; empty where none is kept.
using Motions = std::vector<std::string>;

// How fine each can be for all to be of at most `budget` characters.
class PlaybackChoice {
 public:
  PlaybackChoice(const Results& results, std::size_t budget);
  Motions of(const CaseResult& result, const Cell& cell) const;
  Motions of_truth(const CaseResult& result) const;

 private:
  Motions chosen(const CaseResult& result, const Recordings& recordings, double seconds) const;
  double scale_ = 0;  // characters for each unit of weight
};

}  // namespace rigor::inline report
