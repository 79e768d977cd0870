// That every member works once a task, on what the caller wrote before it, and that the caller sees what it wrote after
// it. Under the thread sanitizer (preset tsan) an unsynchronised access fails here even where the numbers come out
// right.
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
