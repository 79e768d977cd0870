#include "cases/runner/journal/journal.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <boost/test/unit_test.hpp>
#include <csignal>
#include <filesystem>
#include <iterator>

#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_journal)

namespace {

std::string content(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_was_added_is_found_again_by_the_same_plan_alone) {
  const Folder folder;
  const std::string file = (folder.path / "journal").string(), bytes("\0\n\xff", 3);
  {
    Journal journal(file, "plan");
    BOOST_TEST(journal.found().empty());
    journal.add(3, {"three", bytes});
    journal.add(Journal::kTruth, {"true", ""});
  }
  {
    Journal journal(file, "plan");
    BOOST_TEST_REQUIRE(journal.found().size() == 2u);
    BOOST_TEST(journal.found().at(3).message == "three");
    BOOST_TEST(journal.found().at(3).path == bytes);
    journal.add(4, {"4", ""});
    journal.add(5, {"five", ""});
  }
  {
    Journal journal(file, "plan");
    BOOST_TEST_REQUIRE(journal.found().size() == 4u);
    BOOST_TEST(journal.found().at(4).message == "4");
    journal.forget_if([](const Journal::Record& record) { return record.message == "five"; });
    BOOST_TEST(journal.found().size() == 3u);
  }
  const Journal later(file, "plan");
  BOOST_TEST(later.found().size() == 3u);  // what was forgotten stays so
  BOOST_TEST(!later.found().contains(5));
  BOOST_TEST(Journal(file, "another plan").found().empty());
  BOOST_TEST(Journal(file, "plan").found().empty());  // the other one has begun anew
}

BOOST_AUTO_TEST_CASE(a_journal_cut_anywhere_or_spoilt_keeps_its_whole_records) {
  const Folder folder;
  const std::string file = (folder.path / "journal").string();
  {
    Journal journal(file, "plan");
    journal.add(0, {"zero", "path"});
    journal.add(1, {"one", ""});
  }
  const std::string whole = content(file);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    folder.write("journal", whole.substr(0, size));
    const std::size_t count = Journal(file, "plan").found().size();
    BOOST_TEST(count == (size == whole.size() ? 2u : size + 35 >= whole.size() ? 1u : count));
    BOOST_TEST(count <= 2u);
    Journal(file, "plan").add(7, {"seven", ""});  // goes on behind what is whole
    BOOST_TEST(Journal(file, "plan").found().size() == count + 1);
  }
  std::string spoilt = whole;
  spoilt.back() = '?';
  folder.write("journal", spoilt);
  BOOST_TEST(Journal(file, "plan").found().size() == 1u);
}

// Simulates a full disk: data that do not fit are dropped, and the run continues.
BOOST_AUTO_TEST_CASE(a_journal_that_may_grow_no_further_keeps_what_was_whole) {
  const Folder folder;
  const std::string file = (folder.path / "journal").string();
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit whole{};
  getrlimit(RLIMIT_FSIZE, &whole);
  {
    Journal journal(file, "plan");
    journal.add(1, {"one", ""});
    rlimit small = whole;
    small.rlim_cur = std::filesystem::file_size(file) + 50;
    setrlimit(RLIMIT_FSIZE, &small);
    journal.add(2, {std::string(100, 'x'), std::string(100, 'y')});
    setrlimit(RLIMIT_FSIZE, &whole);
    journal.add(3, {"three", ""});  // it has given up
  }
  std::signal(SIGXFSZ, before);
  const Journal after(file, "plan");
  BOOST_TEST_REQUIRE(after.found().size() == 1u);
  BOOST_TEST(after.found().at(1).message == "one");
}

// As far as this process makes files that others may read.
BOOST_AUTO_TEST_CASE(a_journal_is_a_file_like_any_other) {
  const Folder folder;
  const std::string file = (folder.path / "journal").string();
  const mode_t mask = umask(022);
  Journal(file, "plan").add(1, {"one", ""});
  umask(mask);
  struct stat about {};
  BOOST_TEST_REQUIRE(stat(file.c_str(), &about) == 0);
  BOOST_TEST((about.st_mode & 0777) == 0644u);
}

BOOST_AUTO_TEST_CASE(what_is_forgotten_is_replaced_by_what_is_added) {
  const Folder folder;
  const std::string file = (folder.path / "journal").string();
  {
    Journal journal(file, "plan");
    journal.add(0, {"good", ""}), journal.add(1, {"wrong", ""});
  }
  {
    Journal journal(file, "plan");
    journal.forget_if([](const Journal::Record& record) { return record.message == "wrong"; });
    BOOST_TEST_REQUIRE(journal.found().size() == 1u);
    BOOST_TEST(journal.found().contains(0));
    journal.add(1, {"better", ""});
  }
  BOOST_TEST(Journal(file, "plan").found().at(1).message == "better");
}

BOOST_AUTO_TEST_CASE(without_a_place_nothing_is_kept_and_nothing_fails) {
  Journal none("", "plan");
  none.add(1, {"one", ""});
  Journal nowhere("/no/such/folder/journal", "plan");
  nowhere.add(1, {"one", ""});
  BOOST_TEST(nowhere.found().empty());
}

BOOST_AUTO_TEST_SUITE_END()
