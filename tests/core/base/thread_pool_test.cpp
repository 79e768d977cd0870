// Every member works once per task on the caller's earlier writes, and the caller sees the member's writes afterwards.
// Under the thread sanitizer (preset tsan) an unsynchronised access fails here even if the numbers are right.
#include <boost/test/unit_test.hpp>
#include <numeric>
#include <vector>

#include "core/base/thread_pool.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_base_thread_pool)

BOOST_AUTO_TEST_CASE(every_member_works_once_a_task_on_what_was_written_before_it) {
  for (const int members : {1, 2, 3, 5}) {
    ThreadPool pool(members);
    BOOST_TEST(pool.members() == static_cast<std::size_t>(members));
    std::vector<int> given(pool.members()), made(pool.members(), 0);
    for (int task = 0; task < 2000; ++task) {
      std::iota(given.begin(), given.end(), task);
      pool.run([&](std::size_t member) { made[member] += given[member]; });
    }
    for (int member = 0; member < members; ++member)  // 0 + 1 + ... + 1999, and as often its own number
      BOOST_TEST(made[member] == 2000 * 1999 / 2 + 2000 * member);
  }
}

BOOST_AUTO_TEST_CASE(members_that_meet_see_what_all_wrote_before) {
  for (const int members : {1, 2, 3, 5}) {
    ThreadPool pool(members);
    std::vector<int> made(pool.members(), 0), seen(pool.members(), 0);
    pool.run([&](std::size_t member) {
      for (int round = 1; round <= 2000; ++round) {
        made[member] = round;
        pool.meet();
        for (const int other : made) seen[member] += other == round;
        pool.meet();
      }
    });
    for (const int count : seen) BOOST_TEST(count == 2000 * members);
  }
}

BOOST_AUTO_TEST_CASE(shares_are_whole_and_leave_nothing_out) {
  ThreadPool pool(3);
  for (const std::size_t rows : {0u, 1u, 7u, 8u, 100u}) {
    for (const std::size_t whole : {1u, 8u}) {
      std::size_t next = 0;
      for (std::size_t member = 0; member < pool.members(); ++member) {
        const auto [first, last] = pool.share(rows, member, whole);
        BOOST_TEST(first == next);
        BOOST_TEST(first % whole == 0u);
        next = last;
      }
      BOOST_TEST(next == rows);
    }
  }
}

// They sleep by then, and must be woken.
BOOST_AUTO_TEST_CASE(members_that_waited_long_still_come) {
  ThreadPool pool(3);
  std::vector<int> made(pool.members(), 0);
  for (int task = 0; task < 3; ++task) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    pool.run([&](std::size_t member) { ++made[member]; });
  }
  for (const int count : made) BOOST_TEST(count == 3);
}

BOOST_AUTO_TEST_CASE(a_pool_that_never_worked_goes) {
  for (int k = 0; k < 100; ++k) const ThreadPool pool(4);
}

BOOST_AUTO_TEST_SUITE_END()
