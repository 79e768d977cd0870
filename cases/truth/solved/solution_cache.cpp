#include "cases/truth/solved/solution_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "core/base/content_hash.h"
#include "core/scene/toml/writing/scene_writer.h"
#include "solver_fingerprints.h"

namespace rigor::inline truth {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMagic = "rigor reference solution 3\n";  // the layout of the file
constexpr std::size_t kMostBytes = 128'000'000;                 // larger ones are not kept
constexpr std::uintmax_t kMostKept = 2'000'000'000;             // bytes in all

class Writer {
 public:
  void add(std::uint64_t number) {
    for (int byte = 0; byte < 8; ++byte) bytes_.push_back(static_cast<char>(number >> (8 * byte)));
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  // Stored as the nearest double and the rest.
  void add(long double number) {
    const auto next = static_cast<double>(number);
    add(next);
    add(static_cast<double>(number - next));
  }
  void add(bool flag) { add(std::uint64_t{flag}); }
  void add(const std::string& text) {
    add(text.size());
    bytes_ += text;
  }
  template <typename Number>
  void add(const std::vector<Number>& numbers) {
    add(numbers.size());
    for (const Number number : numbers) add(number);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Returns zeros past the end, and reports it.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}

  std::uint64_t number() {
    if (left_.size() < 8) return good_ = false, 0;
    std::uint64_t value = 0;
    for (int byte = 7; byte >= 0; --byte) value = value << 8 | static_cast<unsigned char>(left_[byte]);
    left_.remove_prefix(8);
    return value;
  }
  void read(double& number_read) { number_read = std::bit_cast<double>(number()); }
  void read(long double& number_read) {
    double next = 0, rest = 0;
    read(next), read(rest);
    number_read = static_cast<long double>(next) + rest;
  }
  template <typename Number>
  void read(std::vector<Number>& numbers) {
    const std::uint64_t size = number();
    if (size > left_.size() / 8) good_ = false;
    if (!good_) return;
    numbers.resize(size);
    for (Number& one : numbers) read(one);
  }
  ContactTie tie() {
    ContactTie tie;
    read(tie.time);
    for (std::uint64_t left = number(); left > 0 && good_; --left) {
      const int a = static_cast<int>(number()), b = static_cast<int>(number());
      tie.pairs.emplace_back(a, b);
    }
    return tie;
  }
  bool is_good() const { return good_; }
  bool at_end() const { return good_ && left_.empty(); }

 private:
  std::string_view left_;
  bool good_ = true;
};

constexpr const char* kPrefix = "reference-";  // of every file

// Empty if there is none.
fs::path cache_folder() {
  if (const char* own = std::getenv("RIGOR_CACHE_DIR")) return own;
  if (const char* shared = std::getenv("XDG_CACHE_HOME"); shared && *shared) return fs::path(shared) / "rigor";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "rigor";
  return {};
}

fs::path file_for(const fs::path& folder, const std::string& content) {
  return folder / fmt::format("{}{:016x}", kPrefix, content_hash(content));
}

struct KeptFile {
  fs::path path;
  fs::file_time_type used;
  std::uintmax_t bytes;
};

// Last used first. Another process may drop some meanwhile.
std::vector<KeptFile> kept_files(const fs::path& folder) {
  std::vector<KeptFile> kept;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    if (!entry->path().filename().string().starts_with(kPrefix) || !entry->is_regular_file(gone)) continue;
    const KeptFile file{entry->path(), entry->last_write_time(gone), entry->file_size(gone)};
    if (!gone) kept.push_back(file);
  }
  std::sort(kept.begin(), kept.end(), [](const KeptFile& a, const KeptFile& b) { return a.used > b.used; });
  return kept;
}

// Files that no run has asked for in a month, which another program made, or of a scene that is no more; and those
// unused for longest where all take more than kMostKept. Another process that asks for one now finds none: it is solved
// again. The folder may hold ten thousand (a sweep keeps one a cell), so that it is gone through once in a while only.
void drop_unused(const fs::path& folder) {
  constexpr auto kMonth = std::chrono::hours(30 * 24);
  constexpr auto kWhile = std::chrono::minutes(10);
  const fs::path last_time = folder / "last-tidied";
  const auto now = fs::file_time_type::clock::now();
  std::error_code error;
  const auto since = now - fs::last_write_time(last_time, error);
  if (!error && since < kWhile && since > -kWhile) return;  // a clock may have been set back
  std::ofstream(last_time) << "";
  std::uintmax_t bytes = 0;
  for (const KeptFile& file : kept_files(folder)) {
    bytes += file.bytes;
    if (now - file.used > kMonth || bytes > kMostKept) fs::remove(file.path, error);
  }
}

// Empty if it cannot be read.
std::string bytes_of(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return {};
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

// The whole content stands at the head of the file, so that of two scenes with one hash none gets the other's.
std::string head_of(const std::string& content) {
  Writer writer;
  writer.add(content);
  return kMagic + writer.bytes();
}

// Whether state_at and the error may rely on it.
bool is_sound(const ReferenceSolution& s) {
  // Divided rather than multiplied: a garbled dimension may be any number.
  return !s.times.empty() && s.states.size() % s.times.size() == 0 && s.states.size() / s.times.size() == s.dimension &&
         !s.errors.empty() && s.errors.size() == s.error_times.size() &&
         (s.phases.times.empty() ? s.phases.modes.empty() : s.phases.modes.size() % s.phases.times.size() == 0);
}

// The scene as JSON without names, and without data that cannot affect a motion of this kind.
std::string motion_content(Scene scene, double duration, bool can_touch) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    Body& body = scene.bodies[i];
    body.name = std::to_string(i), body.collides = body.collides && can_touch;
    if (!body.collides) body.shape.reset();
  }
  for (std::size_t k = 0; k < scene.joints.size(); ++k) scene.joints[k].name = std::to_string(k);
  if (!can_touch) scene.contact_pairs.clear(), scene.contact_default = {};
  Writer content;
  content.add(duration), content.add(scene_json(scene));
  return content.bytes();
}

}  // namespace

std::string reference_content(const Scene& scene, double duration, const std::string& made_by) {
  Writer content;
  content.add(made_by), content.add(motion_content(scene, duration, false));
  return content.bytes();
}

std::string reference_content(const Scene& scene, double duration) {
  return reference_content(scene, duration, kReferenceMadeBy);
}

std::string events_content(const Scene& scene, double duration) {
  return events_content(scene, duration, kEventsMadeBy);
}

std::string events_content(const Scene& scene, double duration, const std::string& made_by) {
  Writer content;
  content.add(std::string("events")), content.add(made_by), content.add(motion_content(scene, duration, true));
  return content.bytes();
}

std::optional<ReferenceSolution> kept_solution(const std::string& content) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return std::nullopt;
  const fs::path file = file_for(folder, content);
  const std::string bytes = bytes_of(file), head = head_of(content);
  if (bytes.size() < head.size() + 8 || !bytes.starts_with(head)) return std::nullopt;
  const std::string_view all = bytes, sealed = all.substr(0, all.size() - 8);
  if (Reader(all.substr(sealed.size())).number() != content_hash(sealed)) return std::nullopt;
  Reader body(sealed.substr(head.size()));
  ReferenceSolution solution;
  solution.dimension = body.number(), solution.complete = body.number() != 0;
  body.read(solution.times), body.read(solution.states), body.read(solution.error_times), body.read(solution.errors);
  body.read(solution.phases.times), body.read(solution.phases.modes);
  for (std::uint64_t left = body.number(); left > 0 && body.is_good(); --left) solution.ties.push_back(body.tie());
  if (!body.at_end() || !is_sound(solution)) return std::nullopt;
  std::error_code ignored;
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);  // in use: see drop_unused
  return solution;
}

void keep_solution(const std::string& content, const ReferenceSolution& solution) {
  const fs::path folder = cache_folder();
  if (folder.empty() || solution.states.size() * sizeof(double) > kMostBytes) return;
  Writer body, seal;
  body.add(solution.dimension), body.add(solution.complete);
  body.add(solution.times), body.add(solution.states), body.add(solution.error_times), body.add(solution.errors);
  body.add(solution.phases.times), body.add(solution.phases.modes), body.add(solution.ties.size());
  for (const ContactTie& tie : solution.ties) {
    body.add(tie.time), body.add(tie.pairs.size());
    for (const auto& [a, b] : tie.pairs)
      body.add(static_cast<std::uint64_t>(a)), body.add(static_cast<std::uint64_t>(b));
  }
  const std::string bytes = head_of(content) + body.bytes();
  seal.add(content_hash(bytes));

  // Writes under another name first, so that another run never sees half a file.
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const fs::path file = file_for(folder, content);
  const fs::path draft = fmt::format("{}.{}.{:08x}", file.string(), getpid(), std::random_device()());
  std::ofstream out(draft, std::ios::binary);
  out << bytes << seal.bytes();
  out.close();
  if (out) fs::rename(draft, file, ignored);
  if (!out || ignored) fs::remove(draft, ignored);
  drop_unused(folder);
}

ReferenceSolution kept_or_solved(const std::string& content, const std::function<ReferenceSolution()>& solve) {
  if (auto kept = kept_solution(content)) return std::move(*kept);
  ReferenceSolution solution = solve();
  keep_solution(content, solution);
  return solution;
}

}  // namespace rigor::inline truth
