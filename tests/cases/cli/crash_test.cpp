// The program where one of its system calls fails, or where it is killed at one: each in turn, over an older result.
// Its outputs are the old or the new, whole, it says so by its exit code, and --resume after it gives the bits of a run
// that nothing disturbed. RIGOR_ALL_CRASHES=1: at every call, not at a sample of them.
#include <fcntl.h>
#include <sys/mman.h>

#include <boost/test/unit_test.hpp>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>

#include "cases/report/reports.h"
#include "tests/cases/cli/suite_program.h"

using namespace rigor;
using namespace rigor::test;

namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;
using Files = std::map<std::string, std::string>;  // content by path in the folder

constexpr int kSample = 30;  // calls of each kind of fault, where not all are asked for

// What takes another time each time, what is made of it, and what the machine said of itself.
void drop_timings(Json& json) {
  if (json.is_object()) {
    for (const char* key : {"cost", "cpu_seconds", "findings", "machine", "wall_seconds", "work_precision"})
      json.erase(key);
  }
  for (auto& part : json) {
    if (part.is_structured()) drop_timings(part);
  }
}

Json without_timings(const std::string& results) {
  Json json = Json::parse(results);
  drop_timings(json);
  return json;
}

Files files_in(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && !name.starts_with(".rigor-partial")) files[name] = content(entry.path());
  }
  return files;
}

// "how" as the preloaded layer takes it.
struct Fault {
  std::string how, name;
  bool kills() const { return how.starts_with("kill"); }
};

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = {{std::to_string(ENOSPC), "ENOSPC"},
                                         {std::to_string(EIO), "EIO"},
                                         {std::to_string(EAGAIN), "EAGAIN"},
                                         {"kill", "kill"},
                                         {"kill-all", "kill-all"}};
  return all;
}

struct CrashProgram : SuiteProgram {
  const fs::path old_out = folder.path / "old", state = folder.path / "state";
  const Words words = {"run",  "stone",  "--engine", "core:rk4", "--dt", "1/10",      "--dt",
                       "1/20", "--jobs", "1",        "--out",    out,    "--timeout", "20"};
  Files old, undisturbed;

  CrashProgram() {
    BOOST_TEST_REQUIRE(run({"run", "stone", "--engine", "core:rk4", "--engine", "core:explicit-euler", "--dt", "1/10",
                            "--duration", "0.5", "--out", old_out.string()})
                           .code == 0);
    BOOST_TEST_REQUIRE(run(words).code == 0);
    old = files_in(old_out), undisturbed = files_in(out);
    BOOST_TEST_REQUIRE(old.size() == reports().size() + 2);
    BOOST_TEST_REQUIRE(undisturbed.size() == reports().size() + 2);
    for (const auto& [name, bytes] : undisturbed) BOOST_TEST_REQUIRE((!old.contains(name) || old[name] != bytes), name);
  }

  void put_old_outputs_there() const {
    fs::remove_all(out);
    fs::copy(old_out, out, fs::copy_options::recursive);
  }
  // The program with its n-th call disturbed; `what`: which call that was.
  Answer run_with(const Fault& fault, long n, std::string& what) const {
    std::ofstream(state, std::ios::binary) << std::string(256, '\0');
    const std::string at = std::to_string(n);
    const Answer answer = run(words, [&] {
      setenv("RIGOR_FAULT_STATE", state.c_str(), 1), setenv("RIGOR_FAULT_AT", at.c_str(), 1);
      setenv("RIGOR_FAULT", fault.how.c_str(), 1), setenv("LD_PRELOAD", RIGOR_BUILD_DIR "/plugins/system_calls.so", 1);
      alarm(120);  // s; what hangs is killed, which is no exit code of ours
    });
    what = content(state).substr(sizeof(long)).c_str();
    return answer;
  }
  long calls_of_a_run() const {
    std::string what;
    BOOST_TEST_REQUIRE(run_with({"5", "none"}, 0, what).code == 0);
    long count = 0;
    const std::string bytes = content(state);
    std::memcpy(&count, bytes.data(), sizeof count);
    return count;
  }

  // Of new outputs: what there is must be of this run alone, and what is missing said.
  std::string flaw_of_new(const Files& files, const Answer& answer) const {
    std::set<std::string> rest;
    for (const auto& [name, bytes] : files) rest.insert(name);
    for (const ReportRow& report : reports()) {
      const bool is_there = rest.erase(report.file_name) > 0;
      if (!is_there && answer.err.find(report.file_name + std::string(" was not written")) == std::string::npos)
        return report.file_name + std::string(" is missing and nothing is said of it");
      if (is_there && files.at(report.file_name) == old.at(report.file_name))
        return report.file_name + std::string(" is of the older run");
    }
    if (files.contains("results.json")) {
      if (!Json::accept(files.at("results.json"))) return "results.json is torn";
      const Json results = Json::parse(files.at("results.json"));
      for (const auto& cell : results.at("cells")) {
        const std::string trajectory =
            cell.at("trajectory").is_string() ? cell.at("trajectory").get<std::string>() : "";
        if (trajectory.empty()) continue;
        if (rest.erase("trajectories/" + trajectory) == 0) return trajectory + " is not there";
      }
      if (!rest.empty()) return *rest.begin() + " is in no result";
    }
    for (const auto& [name, bytes] : files) {
      if (name.starts_with("trajectories/") && (!undisturbed.contains(name) || undisturbed.at(name) != bytes))
        return name + " is not that of an undisturbed run";
    }
    return "";
  }
  // Empty if all is well.
  std::string flaw_of(const Files& files, const Answer& answer) const {
    if (files == old) return answer.code == 0 ? "says that it is good, and nothing is new" : "";
    const std::string flaw = flaw_of_new(files, answer);
    if (!flaw.empty() || answer.code != 0) return flaw;
    return without_timings(files.at("results.json")) == without_timings(undisturbed.at("results.json"))
               ? ""
               : "says that it is good, and has other results";
  }
  std::string flaw_of_resumed(const Files& files, const Answer& answer) const {
    if (answer.code != 0) return "resuming answers " + std::to_string(answer.code) + ": " + answer.err;
    if (fs::exists(fs::path(out) / ".rigor-partial")) return "resuming leaves its hidden folder";
    return flaw_of(files, answer);
  }
};

bool all_are_asked_for() { return std::getenv("RIGOR_ALL_CRASHES") != nullptr; }

}  // namespace

BOOST_FIXTURE_TEST_SUITE(cases_cli_crash, CrashProgram)

BOOST_AUTO_TEST_CASE(a_call_that_fails_or_a_kill_there_tears_nothing_and_resume_gives_the_same_bits) {
  const long calls = calls_of_a_run();
  BOOST_TEST_REQUIRE(calls > 100);
  long done = 0, reached = 0, unharmed = 0, kept_old = 0, half_published = 0;
  const long step = all_are_asked_for() ? 1 : std::max(1L, calls / kSample);
  for (std::size_t f = 0; f < faults().size(); ++f) {
    const Fault& fault = faults()[f];
    for (long n = 1 + static_cast<long>(f) * step / static_cast<long>(faults().size()); n <= calls; n += step, ++done) {
      put_old_outputs_there();
      std::string what;
      const Answer answer = run_with(fault, n, what);
      const Files files = files_in(out);
      const std::string where = fault.name + " at call " + std::to_string(n) + ", " + what;
      BOOST_TEST(
          (answer.code == 0 || answer.code == 2 || answer.code == 3 || (fault.kills() && answer.code == -SIGKILL)),
          where << ": answers " << answer.code << ": " << answer.err);
      reached += !what.empty(), unharmed += answer.code == 0, kept_old += files == old;
      // Whoever is killed between two renames leaves that to the next run; it says so by what it leaves.
      const bool is_half = fault.how == "kill-all" && fs::exists(fs::path(out) / ".rigor-partial/staged/ready");
      half_published += is_half;
      const std::string flaw = is_half ? "" : flaw_of(files, answer);
      BOOST_TEST(flaw.empty(), where << ": " << flaw << "; it said " << answer.code << ": " << answer.err);
      Words again = words;
      again.push_back("--resume");
      const Answer resumed = run(again);
      const std::string flaw_after = flaw_of_resumed(files_in(out), resumed);
      BOOST_TEST(flaw_after.empty(), where << ", resumed: " << flaw_after);
    }
  }
  BOOST_TEST_MESSAGE(calls << " calls, " << done << " disturbed runs: " << reached << " met their fault, " << unharmed
                           << " were none the worse, " << kept_old << " left the old outputs, " << half_published
                           << " left the rest of publishing to the next run");
  BOOST_TEST(reached > done / 2);  // the count of calls differs a little from run to run
  BOOST_TEST(kept_old > 10);
}

BOOST_AUTO_TEST_SUITE_END()
