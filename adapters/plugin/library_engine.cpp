#include "adapters/plugin/library_engine.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "adapters/common/option_values.h"
#include "adapters/plugin/answer.h"
#include "adapters/plugin/in_quotes.h"
#include "adapters/plugin/memory_limit.h"
#include "adapters/plugin/rigor_loads.h"
#include "adapters/plugin/shared_library.h"
#include "core/base/json.h"
#include "core/engine/saved_bytes.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor::inline adapters {
namespace {

constexpr std::uint64_t bits_of(double number) { return std::bit_cast<std::uint64_t>(number); }

// The thirteen columns that a library writes, each between guards. A write past the end is found before the values are
// used.
class GuardedColumns {
 public:
  explicit GuardedColumns(std::size_t bodies) : bodies_(bodies), data_(13 * (bodies + 2 * kGuards), kNothing) {
    for (int c = 0; c < 13; ++c) columns_[c] = data_.data() + c * (bodies + 2 * kGuards) + kGuards;
    for (int c = 0; c < 13; ++c) {
      for (std::size_t k = 0; k < kGuards; ++k) columns_[c][-1 - std::ptrdiff_t(k)] = columns_[c][bodies + k] = kGuard;
    }
  }
  double* const* columns() const { return columns_.data(); }

  // The column beside which something was written, -1 if none.
  int overrun() const {
    for (int c = 0; c < 13; ++c) {
      const double *const before = columns_[c] - kGuards, *const behind = columns_[c] + bodies_;
      std::uint64_t difference = 0;
      for (std::size_t k = 0; k < kGuards; ++k)
        difference |= (bits_of(before[k]) ^ bits_of(kGuard)) | (bits_of(behind[k]) ^ bits_of(kGuard));
      if (difference) return c;
    }
    return -1;
  }

 private:
  static constexpr std::size_t kGuards = 4;                                     // doubles before and after each column
  static constexpr double kGuard = -7.0217481264e+201;                          // no motion has such a number
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();  // until it is written

  std::size_t bodies_;
  std::vector<double> data_;
  std::array<double*, 13> columns_{};
};

// Whether the library's struct is long enough to have a member that a later version appended.
template <typename Function>
bool has_function(const rigor_engine_v1& engine, Function rigor_engine_v1::*member, std::size_t offset) {
  return engine.struct_size >= offset + sizeof(Function) && engine.*member;
}

class LibraryWorld : public World, public ReportsContacts, public SavesState {
 public:
  LibraryWorld(const rigor_engine_v1& engine, std::string name, const PluginInfo& info, const Scene& scene,
               const Settings& settings)
      : engine_(engine),
        name_(std::move(name)),
        owner_(info.engine.name, info.engine.version, scene, settings),
        loads_(scene, info),
        told_(scene.bodies.size()),
        state_(scene.bodies.size()),
        room_(kRoomForText) {
    const std::string scene_text = scene_json(scene), settings_text = settings_json(info, settings);
    answered("load", engine_.load(scene_text.c_str(), settings_text.c_str(), &world_, text()));
    if (!world_) refuse("load", "it set no world");
    take_settings();
  }
  ~LibraryWorld() override {
    if (world_) engine_.unload(world_, text());
  }

  void step(double dt) override {
    if (lost_.empty() && !loads_.empty() && !loads_.over_step(*this, dt))
      lose("the forces of springs and dampers are no longer finite");
    if (lost_.empty())
      went_on("step", engine_.step(world_, dt, loads_.empty() ? nullptr : loads_.rows().data(), text()));
    clock_.advance(dt), last_dt_ = dt;
  }

  void read(Snapshot& out) const override {
    if (lost_.empty()) read_now();
    out.time = clock_.time();
    out.borrow(state_.columns());
  }

  SettingsInForce settings_in_force() const override { return in_force_; }
  std::string solver_warning() const override { return lost_; }

  Capabilities capabilities() override {
    using Abi = rigor_engine_v1;
    const bool reports = has_function(engine_, &Abi::contacts, offsetof(Abi, contacts));
    const bool saves = has_function(engine_, &Abi::save, offsetof(Abi, save)) &&
                       has_function(engine_, &Abi::restore, offsetof(Abi, restore));
    // A sampling servo holds its effort, which the library does not know.
    return {.contacts = reports ? this : nullptr, .state = saves && loads_.empty() ? this : nullptr};
  }
  void ask_for_contacts() override {}
  std::vector<ReportedContact> contacts() const override;
  std::unique_ptr<SavedState> save() const override;
  void restore(const SavedState& state) override;

 private:
  std::string saved_by_library() const;
  rigor_text text() const {
    room_.front() = room_.back() = '\0';
    return {room_.data(), room_.size() - 1};
  }
  [[noreturn]] void refuse(const char* call, const std::string& fault) const { refuse_answer({name_, call}, fault); }

  void answered(const char* call, rigor_status status) const {
    if (status == RIGOR_OK && room_.back() == '\0') return;
    if (room_.back() != '\0')
      refuse(call, fmt::format("it wrote past its room of {} bytes for a text", room_.size() - 1));
    const std::string why = in_quotes(room_.data(), 400);
    if (status == RIGOR_UNSUPPORTED)
      throw EngineFailure(FailureKind::unsupported, fmt::format("{} says so itself: {}", name_, why));
    if (status == RIGOR_DIVERGED) throw EngineDiverged(fmt::format("{} says that it diverged: {}", name_, why), 0);
    if (status == RIGOR_FAILED)
      throw EngineFailure(FailureKind::crashed, fmt::format("{} says that '{}' failed: {}", name_, call, why));
    refuse(call, fmt::format("its status is {}; allowed: 0 to 3", status));
  }

  // The same, of a world that has begun: one that diverges ends in a state that is not finite. Whether it goes on.
  bool went_on(const char* call, rigor_status status) const {
    try {
      answered(call, status);
    } catch (const EngineDiverged& diverged) {
      lose(diverged.what());
    }
    return lost_.empty();
  }
  void lose(const std::string& why) const {
    lost_ = why;
    state_.columns().set_position(0, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  }

  void read_now() const {
    double time = std::numeric_limits<double>::quiet_NaN();
    if (!went_on("read", engine_.read(world_, &time, told_.columns(), text()))) return;
    if (const int c = told_.overrun(); c >= 0)
      refuse("read", fmt::format("it wrote outside its column {} of {} doubles", kColumnNames[c], state_.size()));
    if (!is_time(time, clock_.time(), last_dt_)) check_time(time, {name_, "read"}, clock_.time(), last_dt_);
    for (int c = 0; c < 13; ++c) {
      const double* from = told_.columns()[c];
      double* to = state_.columns().column(c);
      bool is_finite = true;
      for (std::size_t i = 0; i < state_.size(); ++i) to[i] = from[i], is_finite &= std::isfinite(from[i]);
      if (!is_finite) refuse("read", fmt::format("{} of a body is not finite, or was not written", kColumnNames[c]));
    }
  }

  void take_settings() {
    const Json told = parse_json_or_discard(room_.data());
    if (told.is_object()) {
      for (const auto& [name, value] : told.items())
        in_force_.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
    }
    if (!loads_.empty())
      in_force_.emplace_back("wrenches", "springs, dampers and timed forces by Rigor, held over a step");
    if (in_force_.empty()) in_force_.emplace_back("settings", "the engine tells of none");
  }

  const rigor_engine_v1& engine_;
  const std::string name_;
  StateOwner owner_;
  RigorLoads loads_;
  SettingsInForce in_force_;
  rigor_world* world_ = nullptr;
  Clock clock_;
  double last_dt_ = 0;
  mutable GuardedColumns told_;
  mutable BodyTable state_;
  mutable std::vector<char> room_;
  mutable std::string lost_;  // why the state is no longer finite; empty while it is
};

// A second call has room for all that the first one counted.
std::vector<ReportedContact> LibraryWorld::contacts() const {
  constexpr std::size_t kFew = 256, kMost = 1'000'000;
  constexpr double kGuard = -7.0217481264e+201;  // no contact has such a number
  if (last_dt_ == 0 || !lost_.empty()) return {};
  std::vector<rigor_contact> told;
  std::size_t count = kFew, room = 0;
  for (int tries = 0; tries < 2 && room < count; ++tries) {
    room = count;
    told.assign(room + 1, rigor_contact{});
    told.back().gap = kGuard;
    if (!went_on("contacts", engine_.contacts(world_, told.data(), room, &count, text()))) return {};
    if (told.back().gap != kGuard) refuse("contacts", fmt::format("it wrote past its room of {} contacts", room));
    if (count > kMost) refuse("contacts", fmt::format("it counts {} contacts of one step; at most {}", count, kMost));
  }
  if (count > room) refuse("contacts", fmt::format("it first counted {} contacts and then {}", room, count));
  std::vector<ReportedContact> contacts;
  const auto vector = [](const double* v) { return Vec3(v[0], v[1], v[2]); };
  for (std::size_t k = 0; k < count; ++k) {
    const rigor_contact& at = told[k];
    contacts.push_back({at.a, at.b, vector(at.point), vector(at.normal), at.gap, vector(at.force)});
  }
  return contacts;
}

// A second call has room for all that the first one counted.
std::string LibraryWorld::saved_by_library() const {
  constexpr std::size_t kFew = 4096, kMost = 1'000'000'000;
  constexpr char kGuard = '\x5a';
  std::string bytes;
  std::size_t size = kFew, room = 0;
  for (int tries = 0; tries < 2 && room < size; ++tries) {
    room = size;
    bytes.assign(room + 1, kGuard);
    answered("save", engine_.save(world_, reinterpret_cast<unsigned char*>(bytes.data()), room, &size, text()));
    if (bytes.back() != kGuard) refuse("save", fmt::format("it wrote past its room of {} bytes", room));
    if (size > kMost) refuse("save", fmt::format("it saves {} bytes; at most {}", size, kMost));
  }
  if (size > room) refuse("save", fmt::format("it first counted {} bytes and then {}", room, size));
  bytes.resize(size);
  return bytes;
}

std::unique_ptr<SavedState> LibraryWorld::save() const {
  Clock clock = clock_;
  double last_dt = last_dt_;
  std::string lost = lost_, bytes = lost.empty() ? saved_by_library() : "";
  return owner_.save([&](StateArchive& archive) { archive(clock, last_dt, lost, bytes); });
}

void LibraryWorld::restore(const SavedState& state) {
  std::string bytes;
  owner_.restore(state, [&](StateArchive& archive) { archive(clock_, last_dt_, lost_, bytes); });
  if (!lost_.empty()) return;
  answered("restore",
           engine_.restore(world_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), text()));
}

}  // namespace

LibraryEngine::LibraryEngine(std::string path, double limit) : path_(std::move(path)) {
  info_ = read_plugin_info(info_of_library(path_, limit), fmt::format("plug-in '{}'", path_));
}

std::unique_ptr<World> LibraryEngine::load(const Scene& scene, const Settings& settings) const {
  refuse_unsupported(info_.engine, settings, scene);
  limit_memory();  // of the cell's process, which also holds the library
  return std::make_unique<LibraryWorld>(load_library(path_), fmt::format("plug-in '{}'", path_), info_, scene,
                                        settings);
}

}  // namespace rigor::inline adapters
