#include "adapters/plugin/process_session.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "adapters/plugin/answer.h"
#include "adapters/plugin/in_quotes.h"
#include "core/base/json.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor::inline adapters {
namespace {

static_assert(std::endian::native == std::endian::little, "columns of doubles are read as they come");

constexpr std::size_t kShortAnswer = 1 << 20;  // bytes
// A body's row is 13 numbers of up to 25 characters; other data of the engine may take as much again.
constexpr std::size_t kLongestRow = 1 << 10;  // bytes

std::string row_of(const double* first) {
  return fmt::format("[{},{},{},{},{},{}]", first[0], first[1], first[2], first[3], first[4], first[5]);
}

Question asked_of(const std::string& engine, const std::string& call, int world) {
  Question asked{engine, call};
  if (world > 0) asked.world = world;
  return asked;
}

}  // namespace

ProcessSession::ProcessSession(const PluginStart& start)
    : child_(std::make_unique<ChildProcess>(start.command, start.limit, start.log,
                                            fmt::format("plug-in '{}'", start.command))) {
  const std::string line =
      child_->ask(fmt::format(R"({{"rigor":{},"call":"info"}})", kProtocolVersion), "info", kShortAnswer);
  info_ = read_plugin_info(line, child_->name());
}

Json ProcessSession::ask(const std::string& line, const std::string& call, std::size_t longest, int world) {
  try {
    return parsed_answer(child_->ask(line, call, longest), asked_of(child_->name(), call, world));
  } catch (const EngineFailure& failure) {
    is_sound_ = failure.kind() == FailureKind::unsupported || failure.kind() == FailureKind::diverged;
    throw;
  }
}

template <typename Read>
void ProcessSession::checked(const Read& read) {
  try {
    read();
  } catch (const EngineFailure&) {
    is_sound_ = false;
    throw;
  }
}

int ProcessSession::load(const Scene& scene, const Settings& settings, const std::string& beside,
                         SettingsInForce& in_force) {
  const int world = ++worlds_;
  const std::string line = fmt::format(R"({{"call":"load","world":{},"scene":{},"settings":{}{}}})", world,
                                       scene_json(scene), settings_json(info_, settings), beside);
  const Json answer = ask(line, "load", kShortAnswer, world);
  const auto told = answer.find("settings");
  if (told == answer.end() || !told->is_object()) return world;
  for (const auto& [name, value] : told->items())
    in_force.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
  return world;
}

void ProcessSession::step(int world, double dt, const std::vector<double>& wrenches) {
  std::string line = fmt::format(R"({{"call":"step","world":{},"dt":{})", world, dt);
  for (std::size_t i = 0; i < wrenches.size(); i += 6)
    line += (i == 0 ? R"(,"wrenches":[)" : ",") + row_of(wrenches.data() + i);
  line += wrenches.empty() ? "}" : "]}";
  keep_warning(ask(line, "step", kShortAnswer, world));
}

void ProcessSession::read(int world, double due, double dt, MutableBodyColumns into) {
  const Question asked = asked_of(child_->name(), "read", world);
  const Json answer = ask(fmt::format(R"({{"call":"read","world":{}}})", world), "read",
                          kShortAnswer + kLongestRow * into.size(), world);
  checked([&] {
    check_time(answer, asked, due, dt);
    if (!info_.has_columns || answer.contains("bodies")) return read_bodies(answer, asked, into);
    receive_raw(asked, into.size());
    copy_raw(asked, 0, into);
  });
}

void ProcessSession::run(int world, double begin, double dt, long count, long every, std::vector<KeptBodies>& samples) {
  const Question asked = asked_of(child_->name(), "run", world);
  const std::size_t due = samples.size(), bodies = samples.front().size();
  const std::string line =
      fmt::format(R"({{"call":"run","world":{},"dt":{},"count":{},"every":{}}})", world, dt, count, every);
  const Json answer = ask(line, "run", kShortAnswer + kLongestRow * due * (1 + bodies), world);
  keep_warning(answer);
  checked([&] {
    const auto found = answer.find("samples");
    const bool is_list = found != answer.end() && found->is_array();
    if (!is_list || found->size() != due)
      refuse_answer(asked, fmt::format("its samples are {}; {} are due, one every {} of {} steps and one at their end",
                                       is_list ? fmt::format("{}", found->size()) : "not a list", due, every, count));
    const bool is_raw = info_.has_columns && !found->front().contains("bodies");
    if (is_raw) receive_raw(asked, due * bodies);
    for (std::size_t n = 0; n < due; ++n) {
      const long steps = std::min(static_cast<long>(n + 1) * every, count);
      check_time((*found)[n], asked, begin + static_cast<double>(steps) * dt, dt);
      is_raw ? copy_raw(asked, n, samples[n].columns()) : read_bodies((*found)[n], asked, samples[n].columns());
    }
  });
}

void ProcessSession::receive_raw(const Question& asked, std::size_t bodies) {
  raw_.resize(kColumnNames.size() * bodies);
  child_->receive(reinterpret_cast<char*>(raw_.data()), raw_.size() * sizeof(double), asked.call);
}

void ProcessSession::keep_warning(const Json& answer) {
  const auto found = answer.find("warning");
  warning_ = found != answer.end() && found->is_string() ? in_quotes(found->get<std::string>()) : "";
}

// The n-th table of this many bodies: thirteen columns, one after another.
void ProcessSession::copy_raw(const Question& asked, std::size_t n, MutableBodyColumns into) const {
  const double* next = raw_.data() + n * kColumnNames.size() * into.size();
  for (std::size_t c = 0; c < kColumnNames.size(); ++c) {
    for (std::size_t i = 0; i < into.size(); ++i, ++next) {
      if (!std::isfinite(*next))
        refuse_answer(asked, fmt::format("{} of body {} is {}; a finite number is due", kColumnNames[c], i, *next));
      into.column(static_cast<int>(c))[i] = *next;
    }
  }
}

std::vector<ReportedContact> ProcessSession::contacts(int world) {
  constexpr std::size_t kLongest = 32'000'000;  // bytes: some hundred thousand contacts
  const Json answer = ask(fmt::format(R"({{"call":"contacts","world":{}}})", world), "contacts", kLongest, world);
  std::vector<ReportedContact> contacts;
  checked([&] { contacts = read_contacts(answer, {child_->name(), "contacts", world}); });
  return contacts;
}

std::vector<ReportedReaction> ProcessSession::reactions(int world, std::size_t joints, std::size_t bodies) {
  const Question asked = asked_of(child_->name(), "reactions", world);
  const Json answer = ask(fmt::format(R"({{"call":"reactions","world":{}}})", world), "reactions",
                          kShortAnswer + kLongestRow * joints, world);
  std::vector<ReportedReaction> reactions;
  checked([&] { reactions = read_reactions(answer, asked, joints, bodies); });
  return reactions;
}

std::string ProcessSession::save(int world) {
  constexpr std::size_t kLongest = 256'000'000;  // bytes: some hundred thousand bodies
  const Json answer = ask(fmt::format(R"({{"call":"save","world":{}}})", world), "save", kLongest, world);
  std::string snapshot;
  checked([&] {
    const auto found = answer.find("snapshot");
    if (found == answer.end() || !found->is_string())
      refuse_answer({child_->name(), "save", world}, "its snapshot is no text");
    snapshot = found->get<std::string>();
  });
  return snapshot;
}

void ProcessSession::restore(int world, const std::string& snapshot) {
  const Json request = {{"call", "restore"}, {"world", world}, {"snapshot", snapshot}};
  ask(request.dump(), "restore", kShortAnswer, world);
}

void ProcessSession::unload(int world) {
  ask(fmt::format(R"({{"call":"unload","world":{}}})", world), "unload", kShortAnswer, world);
}

}  // namespace rigor::inline adapters
