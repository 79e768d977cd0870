// The corpora of the fuzz targets, read once more: what was found once is not found again.
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/targets.h"

namespace fs = std::filesystem;

BOOST_AUTO_TEST_SUITE(fuzz_corpus)

BOOST_AUTO_TEST_CASE(every_file_of_every_corpus_is_read_or_refused) {
  for (const auto& target : rigor::fuzz::targets()) {
    int files = 0;
    for (const auto& entry : fs::directory_iterator(RIGOR_SOURCE_DIR "/tests/fuzz/corpus/" + target.name)) {
      std::ifstream stream(entry.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
      BOOST_TEST_CONTEXT(entry.path().string()) BOOST_CHECK_NO_THROW(target.read(bytes));
      // Cut anywhere, and with any byte changed: a little of what the fuzzer does.
      for (std::size_t i = 0; i < bytes.size(); i += 1 + bytes.size() / 50) {
        std::string changed = bytes;
        changed[i] = static_cast<char>(changed[i] ^ (1 << i % 8));
        BOOST_TEST_CONTEXT(entry.path().string() << ", byte " << i) {
          BOOST_CHECK_NO_THROW(target.read(bytes.substr(0, i)));
          BOOST_CHECK_NO_THROW(target.read(changed));
        }
      }
      ++files;
    }
    BOOST_TEST(files >= 5, "the corpus of " << target.name);
  }
}

BOOST_AUTO_TEST_SUITE_END()
