// A recorded run: one table of bodies for each sampled instant, t = 0 first.
#pragma once

#include <vector>

#include "core/engine/body_table.h"
#include "core/engine/capabilities.h"

namespace rigor::inline engine {

struct Sample {
  double time;  // s
  KeptBodies bodies;
  std::vector<ReportedReaction> reactions = {};  // by joint, of the step that ended then; none where no engine says
  std::vector<ReportedContact> contacts = {};    // of the step that ended then; none if they were not asked for
};

enum class ContactRecords { not_asked_for, not_reported, kept };

struct Trajectory {
  double dt = 0;  // s, the step size (samples may be several steps apart)
  std::vector<Sample> samples;
  ContactRecords contacts = ContactRecords::not_asked_for;
};

}  // namespace rigor::inline engine
