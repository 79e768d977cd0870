#include "cases/runner/output_folder.h"

#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/test/unit_test.hpp>
#include <csignal>
#include <iterator>
#include <set>

#include "core/base/error.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_output_folder)
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t entries(const fs::path& folder) { return std::distance(fs::directory_iterator(folder), {}); }

}  // namespace

BOOST_AUTO_TEST_CASE(old_outputs_stay_until_the_new_are_published) {
  const Folder place;
  place.write("out/results.json", "old");
  place.write("out/trajectories/of--an--earlier-run.csv", "old");
  place.write("out/trajectories/notes.txt", "the user's own");
  {
    OutputFolder folder((place.path / "out").string(), {"results.json"});
    folder.write("results.json", "new");
    std::ofstream(fs::path(folder.trajectories()) / "a--b--c.csv") << "rows";
    std::ofstream(fs::path(folder.trajectories()) / "d--e--f.csv") << "of a cell that crashed later";
    BOOST_TEST(content(place.path / "out/results.json") == "old");
    folder.publish({"a--b--c.csv"});
  }
  BOOST_TEST(content(place.path / "out/results.json") == "new");
  BOOST_TEST(content(place.path / "out/trajectories/a--b--c.csv") == "rows");
  BOOST_TEST(entries(place.path / "out") == 2u);
  BOOST_TEST(entries(place.path / "out/trajectories") == 2u);
  BOOST_TEST(content(place.path / "out/trajectories/notes.txt") == "the user's own");
}

BOOST_AUTO_TEST_CASE(what_was_kept_is_taken_over_by_a_run_that_goes_on_and_by_no_other) {
  const Folder place;
  const std::string out = (place.path / "out").string();
  const auto leave = [&] {
    OutputFolder folder(out, {"results.json"});
    std::ofstream(fs::path(folder.journals()) / "0.journal") << "half a case";
    std::ofstream(fs::path(folder.trajectories()) / "a--b--c.csv") << "rows";
    folder.write("results.json", "of half a run");
    folder.keep();
  };
  leave();
  {
    OutputFolder folder(out, {"results.json"}, true);
    BOOST_TEST(content(fs::path(folder.journals()) / "0.journal") == "half a case");
    BOOST_TEST(content(fs::path(folder.trajectories()) / "a--b--c.csv") == "rows");
    folder.publish({});
  }
  BOOST_TEST(!fs::exists(place.path / "out/results.json"));  // what was written before does not count
  leave();
  {
    OutputFolder folder(out, {"results.json"});
    BOOST_TEST(entries(folder.journals()) == 0u);
    BOOST_TEST(entries(folder.trajectories()) == 0u);
  }
  BOOST_TEST(!fs::exists(place.path / "out/.rigor-partial"));
}

BOOST_AUTO_TEST_CASE(what_is_not_published_leaves_no_trace) {
  const Folder place;
  place.write("out/results.json", "old");
  { OutputFolder((place.path / "out").string(), {"results.json"}).write("results.json", "new"); }
  BOOST_TEST(content(place.path / "out/results.json") == "old");
  BOOST_TEST(entries(place.path / "out") == 1u);
}

BOOST_AUTO_TEST_CASE(a_folder_that_another_run_writes_to_is_refused_and_untouched) {
  const Folder place;
  const std::string out = (place.path / "out").string();
  OutputFolder first(out, {"results.json"});
  first.write("results.json", "of the first");
  std::ofstream(fs::path(first.trajectories()) / "a--b--c.csv") << "rows";
  for (const bool resume : {false, true}) {
    // The lock is the file's: who holds it, and in what container, does not matter.
    BOOST_CHECK_EXCEPTION(OutputFolder(out, {"results.json"}, resume), InputError, [](const InputError& error) {
      return std::string(error.what()).find("another run is writing to it") != std::string::npos;
    });
  }
  first.publish({"a--b--c.csv"});
  BOOST_TEST(content(place.path / "out/results.json") == "of the first");
  BOOST_TEST(content(place.path / "out/trajectories/a--b--c.csv") == "rows");
}

// Like a killed run: the kernel releases its lock.
BOOST_AUTO_TEST_CASE(a_run_that_is_no_longer_there_holds_nothing) {
  const Folder place;
  const std::string out = (place.path / "out").string();
  const pid_t child = fork();
  if (child == 0) {
    const OutputFolder folder(out, {});
    std::ofstream(fs::path(folder.journals()) / "0.journal") << "half a case";
    std::raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  const OutputFolder folder(out, {}, true);
  BOOST_TEST(content(fs::path(folder.journals()) / "0.journal") == "half a case");
}

// Like a run whose children survive for an instant.
BOOST_AUTO_TEST_CASE(a_run_that_is_about_to_be_gone_is_waited_for) {
  const Folder place;
  const std::string out = (place.path / "out").string();
  int held[2];
  BOOST_TEST_REQUIRE(pipe(held) == 0);
  const pid_t child = fork();
  if (child == 0) {
    const OutputFolder folder(out, {});
    if (write(held[1], "!", 1) == 1) usleep(300'000);
    _exit(0);
  }
  char byte = 0;
  BOOST_TEST(read(held[0], &byte, 1) == 1);
  BOOST_CHECK_NO_THROW(OutputFolder(out, {}));
  waitpid(child, nullptr, 0);
  close(held[0]), close(held[1]);
}

BOOST_AUTO_TEST_CASE(a_report_that_cannot_be_written_is_missing_and_the_others_are_new) {
  const Folder place;
  place.write("out/report.md", "old"), place.write("out/results.json", "old");
  const pid_t child = fork();
  if (child == 0) {
    int code = 1;
    {
      OutputFolder folder((place.path / "out").string(), {"report.md", "results.json"});
      const rlimit small{4096, 4096};
      std::signal(SIGXFSZ, SIG_IGN), setrlimit(RLIMIT_FSIZE, &small);
      folder.write("results.json", "new");
      try {
        folder.write("report.md", std::string(100'000, 'x'));
      } catch (const std::runtime_error& error) {
        code = std::string(error.what()).find("File too large") != std::string::npos ? 0 : 2;
      }
      folder.publish({});
    }
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  BOOST_TEST(status == 0);
  BOOST_TEST(content(place.path / "out/results.json") == "new");
  BOOST_TEST(!fs::exists(place.path / "out/report.md"));  // it would be of another run
  BOOST_TEST(entries(place.path / "out") == 2u);          // and the trajectories
}

// Runs `work` in a child and kills it, and all that it has forked, at its n-th system call. False if it has not so
// many.
bool is_killed_at(int n, const std::function<void()>& work) {
  const pid_t first = fork();
  if (first == 0) {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    std::raise(SIGSTOP);
    work();
    _exit(0);
  }
  waitpid(first, nullptr, 0);
  constexpr long kOptions =
      PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK | PTRACE_O_TRACECLONE | PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL;
  BOOST_TEST_REQUIRE(ptrace(PTRACE_SETOPTIONS, first, nullptr, kOptions) == 0);
  std::set<pid_t> traced = {first};
  ptrace(PTRACE_SYSCALL, first, nullptr, nullptr);
  int count = 0, status = 0;
  while (!traced.empty()) {
    const pid_t stopped = waitpid(-1, &status, __WALL);
    if (stopped < 0) break;
    if (!WIFSTOPPED(status)) {
      traced.erase(stopped);
      continue;
    }
    traced.insert(stopped);
    if (status >> 16 != 0) {  // it has forked; the new process may not have been seen yet
      unsigned long forked = 0;
      ptrace(PTRACE_GETEVENTMSG, stopped, nullptr, &forked);
      traced.insert(static_cast<pid_t>(forked));
    }
    if (WSTOPSIG(status) == (SIGTRAP | 0x80) && ++count >= n) {
      for (const pid_t each : traced) kill(each, SIGKILL);
      for (const pid_t each : traced) waitpid(each, nullptr, __WALL);
      return true;
    }
    ptrace(PTRACE_SYSCALL, stopped, nullptr, nullptr);
  }
  return false;
}

// Fails every system call, in the process that publishes and in its helper process. The next run finds all of the old
// outputs or all of the new ones, and its own trajectories beside its journals.
BOOST_AUTO_TEST_CASE(publishing_that_is_killed_anywhere_leaves_the_old_or_the_new) {
  int kills = 0, old = 0;
  for (int n = 1;; ++n, ++kills) {
    const Folder place;
    const std::string out = (place.path / "out").string();
    for (const char* name :
         {"out/results.json", "out/report.md", "out/trajectories/a--b--c.csv", "out/trajectories/d--e--f.csv"})
      place.write(name, "old");
    const std::vector<std::string> names = {"report.html", "report.md", "results.json"};
    const auto work = [&] {
      OutputFolder folder(out, names);
      std::ofstream(fs::path(folder.trajectories()) / "a--b--c.csv") << "new";
      std::ofstream(fs::path(folder.journals()) / "0.journal") << "whole";
      for (const char* name : {"report.html", "results.json"}) folder.write(name, "new");
      folder.publish({"a--b--c.csv"});
    };
    const bool was_killed = is_killed_at(n, work);
    {
      const OutputFolder next(out, names, true);
      const fs::path journal = fs::path(next.journals()) / "0.journal", own = next.trajectories();
      if (content(journal) == "whole") BOOST_TEST(content(own / "a--b--c.csv") == "new");
      BOOST_TEST(!fs::exists(own / "d--e--f.csv"));
    }
    const std::string state = content(fs::path(out) / "results.json");
    const bool is_old = state == "old";
    BOOST_TEST((is_old || state == "new"), "after " << n << " calls");
    BOOST_TEST(content(fs::path(out) / "report.md") == (is_old ? "old" : ""), "after " << n << " calls");
    BOOST_TEST(content(fs::path(out) / "report.html") == (is_old ? "" : "new"), "after " << n << " calls");
    BOOST_TEST(content(fs::path(out) / "trajectories/a--b--c.csv") == state, "after " << n << " calls");
    BOOST_TEST(fs::exists(fs::path(out) / "trajectories/d--e--f.csv") == is_old, "after " << n << " calls");
    BOOST_TEST(!fs::exists(fs::path(out) / ".rigor-partial"));
    old += is_old;
    if (!was_killed) break;
  }
  BOOST_TEST_MESSAGE(kills << " kills, " << old << " of which left the old outputs");
  BOOST_TEST(old > 10);
  BOOST_TEST(kills - old > 10);
}

// A user who links a folder means its target. A link inside the folder may come from somebody else, so its target stays
// untouched.
BOOST_AUTO_TEST_CASE(a_link_to_the_folder_is_followed_and_links_inside_it_are_replaced) {
  const Folder place;
  place.write("real/results.json", "old");
  place.write("elsewhere/mine.txt", "mine"), place.write("elsewhere/a--b--c.csv", "mine, too");
  fs::create_directory_symlink(place.path / "real", place.path / "out");
  fs::create_symlink(place.path / "elsewhere/mine.txt", place.path / "real/report.md");
  fs::create_directory_symlink(place.path / "elsewhere", place.path / "real/trajectories");
  {
    OutputFolder folder((place.path / "out").string(), {"results.json", "report.md"});
    folder.write("results.json", "new"), folder.write("report.md", "new");
    std::ofstream(fs::path(folder.trajectories()) / "a--b--c.csv") << "rows";
    folder.publish({"a--b--c.csv"});
  }
  BOOST_TEST(fs::is_symlink(place.path / "out"));
  BOOST_TEST(content(place.path / "real/results.json") == "new");
  BOOST_TEST(content(place.path / "real/report.md") == "new");
  BOOST_TEST(content(place.path / "real/trajectories/a--b--c.csv") == "rows");
  BOOST_TEST(content(place.path / "elsewhere/mine.txt") == "mine");
  BOOST_TEST(content(place.path / "elsewhere/a--b--c.csv") == "mine, too");
  BOOST_TEST(entries(place.path / "elsewhere") == 2u);
}

BOOST_AUTO_TEST_CASE(a_place_that_cannot_be_written_is_refused) {
  const Folder place;
  const std::string file = place.write("file", "");
  place.write("blocked/trajectories", "a file where a folder must be");
  place.write("taken/results.json/inside", "a folder where a file must be");
  for (const std::string& path : {file, file + "/below", std::string(), std::string("/proc/rigor"),
                                  (place.path / "blocked").string(), (place.path / "taken").string()}) {
    BOOST_CHECK_THROW(OutputFolder(path, {"results.json"}), InputError);
  }
  BOOST_TEST(entries(place.path / "taken") == 1u);
  BOOST_TEST(entries(place.path / "blocked") == 1u);
}

BOOST_AUTO_TEST_SUITE_END()
