// Runs that are saved on their way and continued from what was saved.
#pragma once

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "tests/state_of.h"

namespace rigor::test {

// Where two states differ in bits; empty if they do not.
inline std::string bits_apart(BodyColumns found, BodyColumns due) {
  for (std::size_t i = 0; i < due.size(); ++i) {
    for (int c = 0; c < 13; ++c) {
      const double a = found.column(c)[i], b = due.column(c)[i];
      if (std::memcmp(&a, &b, sizeof a) != 0)
        return fmt::format("{} of body {} is {:.17g} and not {:.17g}", kColumnNames[static_cast<std::size_t>(c)], i, a,
                           b);
    }
  }
  return "";
}

// A run that was saved after 0, `every`, 2 `every`, ... steps, with its states.
struct SavedRun {
  double dt = 0;
  long every = 1;
  std::vector<BodyTable> states;  // of all steps
  std::vector<std::unique_ptr<SavedState>> saved;
};

inline SavedRun saved_run(World& world, double dt, long steps, long every) {
  SavedRun run{dt, every, {}, {}};
  for (long n = 0; n <= steps; ++n) {
    if (n > 0) world.step(dt);
    run.states.push_back(state_of(world));
    if (n % every == 0) run.saved.push_back(world.capabilities().state->save());
  }
  return run;
}

// Continues from each saved state, the last first, until after the next one. Empty if all states have the same bits.
inline std::string restored_apart(World& world, const SavedRun& run) {
  for (std::size_t k = run.saved.size(); k-- > 0;) {
    world.capabilities().state->restore(*run.saved[k]);
    const std::size_t first = k * static_cast<std::size_t>(run.every),
                      last = std::min(first + static_cast<std::size_t>(run.every) + 2, run.states.size() - 1);
    for (std::size_t n = first; n <= last; ++n) {
      if (n > first) world.step(run.dt);
      const std::string apart = bits_apart(state_of(world).columns(), run.states[n].columns());
      if (!apart.empty()) return fmt::format("saved after {} steps, after {}: {}", first, n, apart);
    }
  }
  return "";
}

}  // namespace rigor::test
