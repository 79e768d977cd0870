#include "cases/runner/process_pool.h"

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <thread>

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/base/error.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_process_pool)

namespace {

struct Outcome {
  std::string message;
  JobEnd end;
  int times_ended = 0;
};

std::vector<Outcome> outcomes_of(const std::vector<Job>& jobs, int at_once) {
  std::vector<Outcome> outcomes(jobs.size());
  run_jobs(
      jobs, at_once, [&](std::size_t job, const std::string& message) { outcomes[job].message += message; },
      [&](std::size_t job, const JobEnd& end) { outcomes[job].end = end, ++outcomes[job].times_ended; });
  return outcomes;
}

Outcome outcome_of(const std::function<void(const Channel&)>& work, double limit = 20) {
  return outcomes_of({{work, limit}}, 1).front();
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_message_arrives_whole_whatever_its_size_and_content) {
  for (const std::size_t size : {0, 1, 65536, 5'000'000}) {
    std::string sent(size, '\0');
    for (std::size_t i = 0; i < size; ++i) sent[i] = static_cast<char>(i * 7);
    const Outcome outcome = outcome_of([&](const Channel& channel) { channel.send(sent); });
    BOOST_TEST((outcome.message == sent), "a message of " << size << " bytes");
    BOOST_TEST((outcome.end.how == Ending::finished));
  }
}

BOOST_AUTO_TEST_CASE(each_way_to_end_is_told_apart) {
  struct Row {
    Ending how;
    std::string text;  // stands in the sentence
    std::function<void(const Channel&)> work;
  };
  const std::vector<Row> rows = {
      {Ending::refused, "no such thing", [](const Channel&) { throw InputError("no such thing"); }},
      {Ending::threw, "out of luck", [](const Channel&) { throw std::runtime_error("out of luck"); }},
      {Ending::threw, "exception", [](const Channel&) { throw 7; }},
      {Ending::killed, "SIGABRT", [](const Channel&) { std::abort(); }},
      {Ending::killed, "SIGSEGV", [](const Channel&) { std::raise(SIGSEGV); }},
      {Ending::killed, "SIGKILL", [](const Channel&) { std::raise(SIGKILL); }},
      {Ending::exited, "exit(0)", [](const Channel&) { _exit(0); }},
      {Ending::exited, "exit(3)", [](const Channel&) { _exit(3); }},
  };
  for (const Row& row : rows) {
    const Outcome outcome = outcome_of(row.work);
    BOOST_TEST((outcome.end.how == row.how), row.text);
    BOOST_TEST(outcome.times_ended == 1);
    const std::string sentence = sentence_of(outcome.end, 20);
    BOOST_TEST(sentence.find(row.text) != std::string::npos, sentence);
  }
}

// As an engine that closes all files of its process. The exception must not go on into the parent's code.
BOOST_AUTO_TEST_CASE(a_job_that_loses_its_channel_ends_there) {
  void* page = mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  BOOST_REQUIRE(page != MAP_FAILED);
  int& went_on = *static_cast<int*>(page);
  const pid_t parent = getpid();
  Outcome outcome;
  try {
    outcome = outcome_of([](const Channel&) {
      for (int file = 3; file < 1024; ++file) close(file);
    });
  } catch (const std::exception&) {
    if (getpid() != parent) went_on = 1, _exit(1);
    throw;
  }
  BOOST_TEST(went_on == 0);
  BOOST_TEST((outcome.end.how == Ending::exited));
  const std::string sentence = sentence_of(outcome.end, 20);
  BOOST_TEST(sentence.find("sending a result to the parent process") != std::string::npos, sentence);
  munmap(page, sizeof(int));
}

BOOST_AUTO_TEST_CASE(an_endless_loop_costs_its_limit_and_no_more) {
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = outcome_of(
      [](const Channel&) {
        volatile bool is_spinning = true;
        while (is_spinning) {
        }
      },
      0.3);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  BOOST_TEST((outcome.end.how == Ending::timed_out));
  BOOST_TEST(seconds >= 0.3);
  BOOST_TEST(seconds < 10);  // far above the pool's tick of 50 ms, for a machine that is busy
}

// Slow, like a busy machine, but not forever.
BOOST_AUTO_TEST_CASE(waiting_costs_no_limit_until_it_is_ten_times_that) {
  const auto sleeping = [](int ms) {
    return [ms](const Channel&) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); };
  };
  BOOST_TEST((outcome_of(sleeping(600), 0.3).end.how == Ending::finished));
  BOOST_TEST((outcome_of(sleeping(60'000), 0.1).end.how == Ending::timed_out));
}

BOOST_AUTO_TEST_CASE(the_limit_ends_with_the_first_message) {
  const Outcome outcome = outcome_of(
      [](const Channel& channel) {
        channel.send("a");
        const std::clock_t start = std::clock();
        while (std::clock() - start < 0.6 * CLOCKS_PER_SEC) {
        }
        channel.send("b");
      },
      0.3);
  BOOST_TEST(outcome.message == "ab");
  BOOST_TEST((outcome.end.how == Ending::finished));
}

// As a process that something stops with SIGSTOP, before its first word or after it.
BOOST_AUTO_TEST_CASE(a_job_that_is_stopped_ends) {
  for (const bool has_spoken : {false, true}) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = outcome_of(
        [&](const Channel& channel) {
          if (has_spoken) channel.send("a");
          std::raise(SIGSTOP);
        },
        0.05);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    BOOST_TEST((outcome.end.how == Ending::timed_out));
    BOOST_TEST(seconds >= (has_spoken ? 1 : 0.5));  // twenty and ten times the limit
    BOOST_TEST(seconds < 30);                       // far above that, for a machine that is busy
  }
}

BOOST_AUTO_TEST_CASE(the_last_words_are_kept_however_much_was_said) {
  const Outcome outcome = outcome_of([](const Channel&) {
    for (int i = 0; i < 200'000; ++i) std::fprintf(stderr, "line %d of a very long complaint\n", i);
    std::puts("and this on stdout");
    std::fflush(stdout);
    std::fprintf(stderr, "the\x1b[31m last words\n\n");
    std::abort();
  });
  BOOST_TEST((outcome.end.how == Ending::killed));
  BOOST_TEST(outcome.end.last_words == "the [31m last words");  // the control character is blanked
}

// What a test has printed is not printed again by a child that calls exit(), nor taken for its words.
BOOST_AUTO_TEST_CASE(what_was_printed_before_is_not_a_childs) {
  std::printf("said before\n");
  const Outcome outcome = outcome_of([](const Channel&) { std::exit(0); });
  BOOST_TEST((outcome.end.how == Ending::exited));
  BOOST_TEST(outcome.end.last_words == "");
}

BOOST_AUTO_TEST_CASE(of_the_last_words_three_hundred_are_kept) {
  for (const std::size_t length : {299, 300, 301}) {
    const Outcome outcome = outcome_of([&](const Channel&) {
      std::fprintf(stderr, "before\n%s z", std::string(length - 2, 'x').c_str());
      std::abort();
    });
    const std::string whole = std::string(length - 2, 'x') + " z";
    BOOST_TEST(outcome.end.last_words == whole.substr(0, 300));
  }
}

// It dies with its parent, leaves no core file, and a file that grows too large is a write that fails.
BOOST_AUTO_TEST_CASE(a_child_is_what_it_has_to_be) {
  std::signal(SIGUSR1, [](int) {});
  const Outcome outcome = outcome_of([](const Channel& channel) {
    int with_parent = 0;
    prctl(PR_GET_PDEATHSIG, &with_parent);
    rlimit core{1, 1};
    getrlimit(RLIMIT_CORE, &core);
    struct sigaction large {
    }, own{};
    sigaction(SIGXFSZ, nullptr, &large), sigaction(SIGUSR1, nullptr, &own);
    channel.send(std::to_string(with_parent) + " " + std::to_string(core.rlim_cur) + " " +
                 std::to_string(large.sa_handler == SIG_IGN) + " " + std::to_string(own.sa_handler == SIG_DFL));
  });
  std::signal(SIGUSR1, SIG_DFL);
  BOOST_TEST(outcome.message == "9 0 1 1");
}

BOOST_AUTO_TEST_CASE(how_long_a_job_took_is_known) {
  const Outcome outcome =
      outcome_of([](const Channel&) { std::this_thread::sleep_for(std::chrono::milliseconds(120)); });
  BOOST_TEST(outcome.end.seconds >= 0.12);
  BOOST_TEST(outcome.end.seconds < 10);  // on a machine that is busy
}

BOOST_AUTO_TEST_CASE(no_more_run_at_once_than_may) {
  std::vector<Job> jobs(6, {[](const Channel& channel) {
                              channel.send("begun");
                              std::this_thread::sleep_for(std::chrono::milliseconds(30));
                            },
                            20});
  int running = 0, most = 0;
  run_jobs(
      jobs, 2, [&](std::size_t, const std::string&) { most = std::max(most, ++running); },
      [&](std::size_t, const JobEnd&) { --running; });
  BOOST_TEST(running == 0);
  BOOST_TEST(most <= 2);
}

BOOST_AUTO_TEST_CASE(all_jobs_end_once_and_a_bad_one_harms_no_other) {
  std::vector<Job> jobs;
  for (int i = 0; i < 40; ++i) {
    jobs.push_back({[i](const Channel& channel) {
                      if (i % 4 == 1) std::abort();
                      if (i % 4 == 3) _exit(0);
                      channel.send(std::to_string(i));
                    },
                    20});
  }
  const auto outcomes = outcomes_of(jobs, 3);
  for (int i = 0; i < 40; ++i) {
    BOOST_TEST(outcomes[i].times_ended == 1);
    BOOST_TEST(outcomes[i].message == (i % 2 == 0 ? std::to_string(i) : ""));
  }
}

BOOST_AUTO_TEST_CASE(an_interrupt_ends_the_children_and_is_reported) {
  std::vector<Job> jobs(4, {[](const Channel& channel) {
                              channel.send(std::to_string(getpid()));
                              pause();
                            },
                            20});
  std::vector<pid_t> children;
  const auto on_message = [&](std::size_t, const std::string& message) {
    children.push_back(std::stoi(message));
    if (children.size() == 2) std::raise(SIGINT);
  };
  BOOST_CHECK_THROW(run_jobs(jobs, 2, on_message, [](std::size_t, const JobEnd&) {}), Interrupted);
  BOOST_TEST_REQUIRE(children.size() == 2u);
  for (const pid_t child : children) BOOST_TEST(kill(child, 0) != 0);
}

BOOST_AUTO_TEST_SUITE_END()
