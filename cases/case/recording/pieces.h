// Cuts trials into short pieces, each of which is a trial that starts from its own first sample. Errors cannot grow
// far in a short piece, so chaos does not hide which engine predicts better (as in Erez, Tassa, Todorov, ICRA 2015).
#pragma once

#include <vector>

#include "cases/case/recording/recording.h"

namespace rigor::inline cases {

// Pieces of at most `length` [s], each from where the one before ended. Dropped are what is left of a trial at its end,
// and intervals that are longer than a piece.
// Called "3 from 0.2 s" after the trial. A trial of several bodies has to have them measured at the same instants;
// throws InputError with a sentence otherwise, and if no trial is as long as a piece.
std::vector<RecordedTrial> pieces_of(const std::vector<RecordedTrial>& trials, double length);

}  // namespace rigor::inline cases
