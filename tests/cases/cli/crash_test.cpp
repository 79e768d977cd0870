// Runs the program with one failing system call, or kills it at one, each in turn, over an older result. Its outputs
// must be the old or the new, complete ones, and its exit code must say which. --resume must then give the bits of an
// undisturbed run. RIGOR_ALL_CRASHES=1 tests every call, not a sample.
#include <cerrno>
#include <cstring>

#include "core/base/sanitizers.h"
#include "tests/cases/cli/disturbed_program.h"

using namespace rigor;
using namespace rigor::test;

namespace cases_cli_crash {

constexpr int kSample = 30;  // calls of each kind of fault, where not all are asked for

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

struct CrashProgram : DisturbedProgram {
  const fs::path state = folder.path / "state";

  // The program with its n-th call disturbed; `what`: which call that was.
  Answer run_with(const Fault& fault, long n, std::string& what) const {
    std::ofstream(state, std::ios::binary) << std::string(256, '\0');
    const std::string at = std::to_string(n);
    const Answer answer = run(words, [&] {
      setenv("RIGOR_FAULT_STATE", state.c_str(), 1), setenv("RIGOR_FAULT_AT", at.c_str(), 1);
      setenv("RIGOR_FAULT", fault.how.c_str(), 1), setenv("LD_PRELOAD", RIGOR_BUILD_DIR "/plugins/system_calls.so", 1);
      if (kHasAddressSanitizer) setenv("ASAN_OPTIONS", "verify_asan_link_order=0:detect_leaks=0", 1);
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
};

bool all_are_asked_for() { return std::getenv("RIGOR_ALL_CRASHES") != nullptr; }

}  // namespace cases_cli_crash

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
      const bool is_half = fault.how == "kill-all" && is_half_published();
      half_published += is_half;
      const std::string flaw = is_half ? "" : flaw_of(files, answer);
      BOOST_TEST(flaw.empty(), where << ": " << flaw << "; it said " << answer.code << ": " << answer.err);
      const Answer resumed = run(words_to_resume());
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
