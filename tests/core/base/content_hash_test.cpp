#include "core/base/content_hash.h"

#include <boost/test/unit_test.hpp>
#include <set>

#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_base_content_hash)

BOOST_AUTO_TEST_CASE(any_bit_of_a_file_changes_its_hash) {
  const Folder folder;
  const std::string zeros(35, '\0');  // four words and three bytes
  std::set<std::uint64_t> hashes = {hash_of_file(folder.write("zeros", zeros))};
  for (std::size_t bit = 0; bit < 8 * zeros.size(); ++bit) {
    std::string one = zeros;
    one[bit / 8] = static_cast<char>(1 << bit % 8);
    hashes.insert(hash_of_file(folder.write("one", one)));
  }
  BOOST_TEST(hashes.size() == 1 + 8 * zeros.size());
}

BOOST_AUTO_TEST_CASE(a_file_is_read_to_its_end_and_in_its_order) {
  const Folder folder;
  const std::string some(3'000'001, 'x');
  std::string last = some, swapped = some;
  last.back() = 'y';
  swapped[8] = 'y';
  const std::set<std::uint64_t> hashes = {
      hash_of_file(folder.write("some", some)), hash_of_file(folder.write("last", last)),
      hash_of_file(folder.write("swapped", swapped)), hash_of_file(folder.write("longer", some + 'x'))};
  BOOST_TEST(hashes.size() == 4);
  BOOST_TEST(hash_of_file(folder.write("again", some)) == hash_of_file(folder.write("some", some)));
}

BOOST_AUTO_TEST_CASE(what_comes_before_counts_and_a_file_that_is_not_there_is_empty) {
  const Folder folder;
  const std::string file = folder.write("file", "some words");
  BOOST_TEST(hash_of_file(file) != hash_of_file(file, content_hash("before")));
  BOOST_TEST(hash_of_file((folder.path / "none").string()) == kHashOfNothing);
  BOOST_TEST(hash_of_file(folder.write("short", "bytes")) == content_hash("bytes"));
}

BOOST_AUTO_TEST_SUITE_END()
