#include "adapters/plugin/process_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "adapters/plugin/answer.h"

namespace rigor::inline adapters {
namespace {

// Limits of one request: steps, and bytes of its samples, each number of some 20 characters.
constexpr long kMostSteps = 1000;
constexpr double kMostBytes = 8e6, kBytesOfBody = 260;

}  // namespace

ProcessWorld::ProcessWorld(std::shared_ptr<ProcessSession> session, const Scene& scene, const Settings& settings,
                           WorldTerms terms)
    : session_(std::move(session)),
      owner_(session_->info().engine.name, session_->info().engine.version, scene, settings),
      scene_(scene),
      settings_(settings),
      terms_(std::move(terms)),
      loads_(scene, session_->info()),
      state_(scene.bodies.size()) {
  world_ = session_->load(scene_, settings_, terms_.beside_scene, in_force_);
  if (!loads_.empty())
    in_force_.emplace_back("wrenches", "springs, dampers and timed forces by Rigor, held over a step");
  if (in_force_.empty()) in_force_.emplace_back("settings", "the engine tells of none");
}

ProcessWorld::~ProcessWorld() {
  if (!session_->is_usable()) return;
  try {
    session_->unload(world_);
  } catch (const std::exception&) {  // its next request, if there is one, will tell
  }
}

void ProcessWorld::expect(double dt, long steps, long every) {
  const bool can = session_->info().can_run && !asks_for_reports_ && loads_.empty() && lost_why_.empty();
  ahead_ = {};
  if (can) ahead_.dt = dt, ahead_.left = steps, ahead_.every = every;
}

void ProcessWorld::step(double dt) {
  if (lost_why_.empty()) {
    const bool is_announced = ahead_.taken < ahead_.count || ahead_.left > 0;
    assert((!is_announced || dt == ahead_.dt) && "a step of another dt than was announced");
    if (!is_announced) ahead_ = {};
    if (is_announced && ahead_.taken == ahead_.count) run_ahead();
    if (ahead_.taken < ahead_.count) {
      ++ahead_.taken;
    } else {
      step_alone(dt);
    }
  }
  steps_are_equal_ = steps_are_equal_ && (steps_ == 0 || dt == last_dt_);
  last_dt_ = dt, ++steps_;
  clock_.advance(dt);
  is_read_ = false;
}

void ProcessWorld::step_alone(double dt) {
  try {
    if (!loads_.empty() && !loads_.over_step(*this, dt))
      return lose("the forces of springs and dampers are no longer finite", 0);
    session_->step(world_, dt, loads_.empty() ? std::vector<double>() : loads_.rows());
    warning_ = session_->warning();
  } catch (const EngineDiverged& diverged) {
    lose(diverged.what(), diverged.body());
  }
}

void ProcessWorld::run_ahead() {
  const double bytes = kBytesOfBody * static_cast<double>(bodies());
  const long most_samples = std::max(1L, static_cast<long>(kMostBytes / bytes));
  // Requests end where a sample does, so that the samples of all are each `every`-th of the whole.
  const long samples_each = std::clamp(kMostSteps / ahead_.every, 1L, most_samples);
  ahead_.count = std::min(ahead_.left, samples_each * ahead_.every), ahead_.taken = 0;
  ahead_.samples.assign(static_cast<std::size_t>((ahead_.count + ahead_.every - 1) / ahead_.every),
                        KeptBodies(bodies()));
  try {
    session_->run(world_, clock_.time(), ahead_.dt, ahead_.count, ahead_.every, ahead_.samples);
    warning_ = session_->warning();
    ahead_.left -= ahead_.count;
  } catch (const EngineDiverged&) {
    go_back_and_step();
  }
}

// A diverged `run` does not return earlier samples. The world is created again, advanced to its old state, and stepped
// one by one, so that the motion is kept up to its last step.
void ProcessWorld::go_back_and_step() {
  const double dt = ahead_.dt;
  ahead_ = {};
  assert(steps_are_equal_ && (steps_ == 0 || last_dt_ == dt) && "announced at the start, or after equal steps");
  session_->unload(world_);
  SettingsInForce again;
  world_ = session_->load(scene_, settings_, terms_.beside_scene, again);
  for (long n = 0; n < steps_; ++n) session_->step(world_, dt, {});
}

void ProcessWorld::lose(const std::string& why, int body) const {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  lost_why_ = why;
  const int last = static_cast<int>(bodies()) - 1;
  state_.columns().set_position(static_cast<std::size_t>(std::clamp(body, 0, last)), Vec3::Constant(kNaN));
}

std::vector<ReportedContact> ProcessWorld::contacts() const {
  if (steps_ == 0 || !lost_why_.empty()) return {};
  return session_->contacts(world_);
}

void ProcessWorld::ask_for_reactions() {
  asks_for_reports_ = true, ahead_ = {};
  session_->reactions(world_, 0, bodies());
}

std::vector<ReportedReaction> ProcessWorld::reactions() const {
  if (steps_ == 0 || !lost_why_.empty()) return {};
  return session_->reactions(world_, scene_.joints.size(), bodies());
}

std::unique_ptr<SavedState> ProcessWorld::save() const {
  assert(ahead_.taken == ahead_.count && "the engine is ahead of the step that would be saved");
  std::string snapshot = lost_why_.empty() ? session_->save(world_) : "";
  // An archive that saves changes nothing.
  return owner_.save([&](StateArchive& archive) { const_cast<ProcessWorld*>(this)->archive_state(archive, snapshot); });
}

void ProcessWorld::restore(const SavedState& state) {
  std::string snapshot;
  owner_.restore(state, [&](StateArchive& archive) { archive_state(archive, snapshot); });
  if (lost_why_.empty()) session_->restore(world_, snapshot);
  ahead_ = {}, is_read_ = false;
}

void ProcessWorld::archive_state(StateArchive& archive, std::string& snapshot) {
  archive(clock_, last_dt_, steps_, steps_are_equal_, warning_, lost_why_, snapshot);
}

void ProcessWorld::read(Snapshot& out) const {
  out.time = clock_.time();
  if (lost_why_.empty() && ahead_.taken > 0) {
    const bool is_sampled = ahead_.taken % ahead_.every == 0 || ahead_.taken == ahead_.count;
    assert(is_sampled && "a read of a step of which it was announced that it is not read");
    if (is_sampled)
      return out.borrow(ahead_.samples[static_cast<std::size_t>((ahead_.taken - 1) / ahead_.every)].columns());
  } else if (lost_why_.empty() && !is_read_) {
    read_now();
  }
  out.borrow(state_.columns());
}

void ProcessWorld::read_now() const {
  try {
    session_->read(world_, clock_.time(), last_dt_, state_.columns());
    is_read_ = true;
  } catch (const EngineDiverged& diverged) {
    lose(diverged.what(), diverged.body());
  }
}

}  // namespace rigor::inline adapters
