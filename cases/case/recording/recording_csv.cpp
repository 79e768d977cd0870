// Reads the CSV file of a recording.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "cases/case/recording/recorded_trial.h"
#include "cases/case/recording/recording.h"
#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline cases {
namespace {

using CellTexts = std::vector<std::string_view>;

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

// A vector or a quaternion: either all of its columns are in the file or none.
template <std::size_t N>
struct ColumnGroup {
  std::array<const char*, N> names;
  std::array<std::size_t, N> columns = {};
  bool is_there() const { return columns[0] != kAbsent; }
};

struct CsvRow {
  std::string_view text;
  CellTexts cells;
};

class RecordingFile {
 public:
  RecordingFile(const std::string& text, const std::string& path, const Scene& scene)
      : left_(text), path_(path), scene_(scene) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      names_.push_back(scene.bodies[i].name);
      bodies_.emplace(scene.bodies[i].name, static_cast<int>(i));
    }
  }

  std::vector<RecordedTrial> read(const std::string& group) {
    if (left_.starts_with("\xef\xbb\xbf")) left_.remove_prefix(3);
    read_header(group);
    while (!left_.empty()) {
      const CsvRow row = next_row();
      if (row.cells.size() == 1 && row.cells[0].empty()) continue;
      add(row);
    }
    if (trials_.empty()) refuse(1, "there is no row below the header; allowed: two rows or more of each trial");
    for (RecordedTrial& trial : trials_) begin_at_zero(trial, names_, path_);
    return std::move(trials_);
  }

 private:
  void read_header(const std::string& group) {
    header_ = next_row().cells;
    time_ = find("time");
    if (time_ == kAbsent) refuse(1, fmt::format("there is no column 'time'; there is: {}", columns()));
    body_ = find("body");
    if (body_ == kAbsent) body_without_column();
    if (!group.empty()) {
      group_ = find(group);
      if (group_ == kAbsent)
        refuse(1, fmt::format("there is no column '{}', which truth.group names{}; there is: {}", group,
                              did_you_mean(group, list()), columns()));
    }
    whole(position_), whole(orientation_), whole(velocity_), whole(angular_velocity_);
    if (!position_.is_there() && !orientation_.is_there())
      refuse(1, fmt::format("there are neither px, py, pz nor qw, qx, qy, qz; allowed: one of them or both; there is: "
                            "{}",
                            columns()));
  }

  // The file is then about the only body that moves.
  void body_without_column() {
    std::vector<int> movers;
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
      if (!scene_.bodies[i].fixed) movers.push_back(static_cast<int>(i));
    if (movers.size() != 1)
      refuse(1, fmt::format("there is no column 'body', and {} bodies of the scene move; allowed: a column 'body'",
                            movers.size()));
    only_body_ = movers.front();
  }

  std::vector<std::string> list() const { return {header_.begin(), header_.end()}; }
  std::string columns() const { return shown(listed(list()), 400); }

  std::size_t find(std::string_view name) const {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found == header_.end()) return kAbsent;
    if (std::find(found + 1, header_.end(), name) != header_.end())
      refuse(1, fmt::format("the column '{}' is there twice; allowed: once", name));
    return static_cast<std::size_t>(found - header_.begin());
  }

  template <std::size_t N>
  void whole(ColumnGroup<N>& group) {
    std::string missing;
    for (std::size_t i = 0; i < N; ++i) {
      group.columns[i] = find(group.names[i]);
      if (group.columns[i] == kAbsent) missing = group.names[i];
    }
    const bool is_any =
        std::any_of(group.columns.begin(), group.columns.end(), [](std::size_t column) { return column != kAbsent; });
    if (is_any && !missing.empty())
      refuse(1, fmt::format("there is no column '{}'; allowed: all of {}, or none", missing,
                            fmt::join(group.names, ", ")));
  }

  CsvRow next_row() {
    CsvRow row;
    const std::size_t end = left_.find('\n');
    row.text = left_.substr(0, end);
    left_.remove_prefix(end == std::string_view::npos ? left_.size() : end + 1);
    ++line_;
    for (std::string_view line = row.text;;) {
      const std::size_t comma = line.find(',');
      std::string_view cell = line.substr(0, comma);
      while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
      while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t' || cell.back() == '\r')) cell.remove_suffix(1);
      row.cells.push_back(cell);
      if (comma == std::string_view::npos) return row;
      line.remove_prefix(comma + 1);
    }
  }

  std::size_t place_of(const CsvRow& row, std::size_t column) const {
    return static_cast<std::size_t>(row.cells[column].data() - row.text.data()) + 1;
  }

  double number(const CsvRow& row, std::size_t column) const {
    const std::string_view cell = row.cells[column];
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value)) return value;
    refuse(place_of(row, column),
           fmt::format("{}: found '{}'; allowed: a finite number", header_[column], shown(cell)));
  }

  Vec3 vector(const CsvRow& row, const ColumnGroup<3>& group) const {
    return {number(row, group.columns[0]), number(row, group.columns[1]), number(row, group.columns[2])};
  }

  Quat quaternion(const CsvRow& row) const {
    const auto& c = orientation_.columns;
    const Quat q(number(row, c[0]), number(row, c[1]), number(row, c[2]), number(row, c[3]));
    if (std::abs(q.norm() - 1) > kUnitLength)
      refuse(place_of(row, c[0]), fmt::format("found a quaternion of the length {:.4g}; allowed: a unit quaternion, "
                                              "(w, x, y, z) from the body to the world",
                                              q.norm()));
    return q.normalized();
  }

  int body_of(const CsvRow& row) const {
    if (body_ == kAbsent) return only_body_;
    const std::string name(row.cells[body_]);
    const auto found = bodies_.find(name);
    if (found != bodies_.end()) return found->second;
    refuse(place_of(row, body_), fmt::format("the scene has no body '{}'{}; it has: {}", shown(name),
                                             did_you_mean(name, names_), shown(listed(names_), 400)));
  }

  void add(const CsvRow& row) {
    if (row.cells.size() != header_.size())
      refuse(row.text.size() + 1,
             fmt::format("found {} columns; allowed: {}, as in the header", row.cells.size(), header_.size()));
    RecordedBody& samples = samples_of(row);
    const double time = number(row, time_);
    if (!samples.times.empty() && !(time > samples.times.back()))
      refuse(place_of(row, time_),
             fmt::format("found the time {} s of '{}' after {} s; allowed: times that rise in each trial{}", time,
                         names_[static_cast<std::size_t>(samples.body)], samples.times.back(),
                         group_ == kAbsent ? ", or truth.group, the column of the trials" : ""));
    samples.times.push_back(time);
    if (position_.is_there()) samples.positions.push_back(vector(row, position_));
    if (orientation_.is_there()) samples.orientations.push_back(quaternion(row));
    if (velocity_.is_there()) samples.velocities.push_back(vector(row, velocity_));
    if (angular_velocity_.is_there()) samples.angular_velocities.push_back(vector(row, angular_velocity_));
  }

  RecordedBody& samples_of(const CsvRow& row) {
    const std::string name(group_ == kAbsent ? "" : row.cells[group_]);
    if (group_ != kAbsent && name.empty())
      refuse(place_of(row, group_), fmt::format("{} is empty; allowed: the name of a trial", header_[group_]));
    const auto [place, is_new] = places_.try_emplace(name, trials_.size());
    if (is_new) trials_.push_back({name, {}, 0});
    return rigor::samples_of(trials_[place->second], body_of(row));
  }

  [[noreturn]] void refuse(std::size_t at, const std::string& fault) const {
    throw InputError(fmt::format("{}:{}:{}: {}", path_, line_, at, fault));
  }

  std::string_view left_;
  const std::string& path_;
  const Scene& scene_;
  std::size_t line_ = 0;
  CellTexts header_;
  std::vector<std::string> names_;
  std::map<std::string, int> bodies_;
  std::size_t time_ = kAbsent, body_ = kAbsent, group_ = kAbsent;
  int only_body_ = 0;
  ColumnGroup<3> position_{{"px", "py", "pz"}}, velocity_{{"vx", "vy", "vz"}}, angular_velocity_{{"wx", "wy", "wz"}};
  ColumnGroup<4> orientation_{{"qw", "qx", "qy", "qz"}};
  std::map<std::string, std::size_t> places_;  // of trials, by name
  std::vector<RecordedTrial> trials_;
};

}  // namespace

std::vector<RecordedTrial> read_trials(const std::string& text, const std::string& path, const std::string& group,
                                       const Scene& scene) {
  return RecordingFile(text, path, scene).read(group);
}

}  // namespace rigor::inline cases
