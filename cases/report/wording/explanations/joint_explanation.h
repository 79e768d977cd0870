// Joints that come apart, stretch or lose energy. The measured values, and the engine's own setting that
// explains them.
#pragma once

#include <vector>

#include "cases/analysis/joint_diagnosis.h"
#include "cases/report/wording/message.h"

namespace rigor::inline report {

// The quantities that these messages state beside metrics:
//   joints in a row, mass ratio   of the scene, see joint_diagnosis.h
//   gap closed by one step        a share, as the engine's setting "erp" states it
//   steps that stand              its inverse
//   gap opened by one step        m
//   order of M                    of a metric between its two finest steps
std::vector<Message> joint_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
