// What the page plays and plots of one run: its motion and the series of its metrics, thinned. How much room there is
// for a run only shows when all have been made, so each is packed several times, from fine to coarse, and the page
// takes of each what fits. Full precision stays in the CSV files. The page reads it in page/src/playback_data.js; the
// layout is in playback.cpp.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"
#include "cases/runner/recorder.h"

namespace rigor {

// A series beside the metrics': (E - E at the start) / the truth's largest kinetic energy, with its sign, as read.
inline constexpr const char* kEnergyChange = "energy_change";

// The names that a packed series' number stands for.
const std::vector<std::string>& series_names();

// Texts in base64, the finest first, each shorter than the one before. All but the finest leave out the series that
// the page shows only when asked for more, the coarsest may have no motion.
using Packings = Recording;

// Of one run, none longer than `limit` characters. `truth` may be null; a run that nobody could tell from it in the
// picture keeps no motion of its own.
Packings packed_run(const JudgedRun& run, const std::vector<NamedSeries>& series, double largest_kinetic_energy,
                    std::size_t limit);

// Likewise of the truth itself.
Packings packed_truth(const Scene& scene, const Truth& truth, double duration, double largest_kinetic_energy,
                      std::size_t limit);

// How many characters a cell, or with no dt the truth, can get at most, some times its even share: no more of it need
// be kept.
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
  void discard(const Cell&) const override {}
  bool still_has(const Cell&) const override { return true; }

 private:
  PlaybackLimit limit_;
};

// How fine each can be for all to be of at most `budget` characters.
class PlaybackChoice {
 public:
  PlaybackChoice(const Results& results, std::size_t budget);
  const std::string& of(const CaseResult& result, const Cell& cell) const;
  const std::string& of_truth(const CaseResult& result) const;

 private:
  double scale_ = 0;  // characters for each unit of weight
};

}  // namespace rigor
