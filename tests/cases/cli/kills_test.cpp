// Kills the program at random moments, in the first run and during --resume: the process alone or its whole group. The
// files must always be old or new and complete, and the finished run must have the bits of an undisturbed one.
// RIGOR_KILLS=1000 sets the number of kills.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "tests/cases/cli/disturbed_program.h"

using namespace rigor;
using namespace rigor::test;

namespace cases_cli_kills {

using Clock = std::chrono::steady_clock;
using Microseconds = std::chrono::microseconds;

constexpr int kFew = 20;          // kills, where no number is asked for
constexpr int kMostInARow = 4;    // of a run and those that go on with it
constexpr double kBeyond = 1.05;  // of an undisturbed run's time, so that the last instants are met too

struct KilledProgram : DisturbedProgram {
  std::mt19937_64 random{20};  // the moments that it leads to are others each time
  int asked = std::getenv("RIGOR_KILLS") ? std::atoi(std::getenv("RIGOR_KILLS")) : kFew;
  int kills = 0, of_the_group = 0, of_resumes = 0, kept_old = 0, published = 0, half_published = 0;

  Microseconds time_of_a_run() const {
    const auto begin = Clock::now();
    BOOST_TEST_REQUIRE(run(words).code == 0);
    return std::chrono::duration_cast<Microseconds>(Clock::now() - begin);
  }
  static void wait_for_group(pid_t group) {
    for (int i = 0; i < 2000 && kill(-group, 0) == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    BOOST_TEST_REQUIRE(kill(-group, 0) != 0, "something that the program started is still there");
  }
  // It survives in a group of its own, and holds the lock until it ends. Before that, old and new files are mixed.
  void wait_for_whoever_publishes() const {
    const int lock = open((fs::path(out) / ".rigor-partial/lock").c_str(), O_RDWR | O_CLOEXEC);
    if (lock < 0) return;
    BOOST_TEST_REQUIRE(flock(lock, LOCK_EX) == 0);
    close(lock);
  }
  Answer killed_after(Microseconds time, bool resumes, bool with_group) const {
    const pid_t pid = start(resumes ? words_to_resume() : words);
    std::this_thread::sleep_for(time);
    kill(with_group ? -pid : pid, SIGKILL);
    const Answer answer = wait_for(pid);
    wait_for_group(pid);
    wait_for_whoever_publishes();
    return answer;
  }
  // One run over the old outputs, killed, gone on with and killed again, and gone on with to its end.
  void kill_in_a_row(Microseconds whole) {
    put_old_outputs_there();
    // Every other kill is meant for the last quarter, where results are published.
    std::uniform_real_distribution<double> any(0, kBeyond), late(0.75, kBeyond);
    const auto row = 1 + random() % kMostInARow;
    for (std::uint64_t i = 0; i < row; ++i) {
      const double share = random() % 2 == 0 ? any(random) : late(random);
      const Microseconds time(static_cast<long>(share * static_cast<double>(whole.count())));
      const bool with_group = random() % 2 == 0;
      const Answer answer = killed_after(time, i > 0, with_group);
      const std::string where = "killed after " + std::to_string(time.count()) + " us" +
                                (with_group ? " with its group" : "") + (i > 0 ? ", going on" : "");
      const Files files = files_in(out);
      const bool is_half = is_half_published();
      const std::string flaw = is_half ? "" : flaw_of(files, answer);
      BOOST_TEST(flaw.empty(), where << ": " << flaw << "; it said " << answer.code << ": " << answer.err);
      if (answer.code != -SIGKILL) return;  // it was over before
      ++kills, of_the_group += with_group, of_resumes += i > 0;
      ++(is_half ? half_published : files == old ? kept_old : published);
    }
    const Answer resumed = run(words_to_resume());
    const std::string flaw = flaw_of_resumed(files_in(out), resumed);
    BOOST_TEST(flaw.empty(), "after " << row << " kills, resumed: " << flaw);
  }
};

}  // namespace cases_cli_kills

BOOST_FIXTURE_TEST_SUITE(cases_cli_kills, KilledProgram)

BOOST_AUTO_TEST_CASE(random_kills_tear_nothing_leave_nothing_stale_and_resume_gives_the_same_bits) {
  const Microseconds whole = time_of_a_run();
  for (int i = 0; i < 4 * asked && kills < asked; ++i) kill_in_a_row(whole);
  BOOST_TEST_MESSAGE(kills << " kills, " << of_the_group << " of the whole group, " << of_resumes
                           << " while going on: " << kept_old << " left the old outputs, " << published
                           << " the new ones, " << half_published << " left the rest of publishing to the next run");
  BOOST_TEST(kills >= asked);
  BOOST_TEST(kept_old > 0);
}

BOOST_AUTO_TEST_SUITE_END()
