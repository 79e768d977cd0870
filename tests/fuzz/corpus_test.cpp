// The corpora of the fuzz targets, read once more: what was found once is not found again; and changed at random, as
// often as is asked for.
#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "generated/tests/places.h"
#include "tests/fuzz/targets.h"

BOOST_AUTO_TEST_SUITE(fuzz_corpus)

namespace fs = std::filesystem;

namespace {

std::vector<std::string> corpus_of(const std::string& target) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(RIGOR_SOURCE_DIR "/tests/fuzz/corpus/" + target))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());  // the same inputs everywhere
  std::vector<std::string> corpus;
  for (const fs::path& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return corpus;
}

// One of the corpus with one to four changes: a bit, a byte, some bytes gone, some twice, some of another one, cut.
std::string changed(const std::vector<std::string>& corpus, std::mt19937_64& random) {
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % end); };
  std::string bytes = corpus[below(corpus.size())];
  for (std::size_t left = 1 + below(4); left > 0 && !bytes.empty(); --left) {
    const std::size_t at = below(bytes.size()), what = below(6);
    const std::string& other = corpus[below(corpus.size())];
    if (what == 0) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
    if (what == 1) bytes[at] = static_cast<char>(below(256));
    if (what == 2) bytes.erase(at, 1 + below(16));
    if (what == 3) bytes.insert(at, bytes.substr(below(bytes.size()), below(32)));
    if (what == 4 && !other.empty()) bytes.insert(at, other.substr(below(other.size()), below(64)));
    if (what == 5) bytes.resize(at);
  }
  return bytes;
}

std::string asked_for(const char* variable, const char* otherwise) {
  const char* said = std::getenv(variable);
  return said ? said : otherwise;
}

}  // namespace

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

// RIGOR_FUZZ_INPUTS of each target, or of RIGOR_FUZZ_TARGET alone; what RIGOR_FUZZ_SEED begins with.
BOOST_AUTO_TEST_CASE(what_is_changed_at_random_is_read_or_refused) {
  const long inputs = std::stol(asked_for("RIGOR_FUZZ_INPUTS", "5000"));
  const std::string only = asked_for("RIGOR_FUZZ_TARGET", ""), seed = asked_for("RIGOR_FUZZ_SEED", "1");
  int asked = 0;
  for (const auto& target : rigor::fuzz::targets()) {
    if (!only.empty() && only != target.name) continue;
    const std::vector<std::string> corpus = corpus_of(target.name);
    std::mt19937_64 random(std::stoull(seed));
    const std::clock_t start = std::clock();
    for (long n = 0; n < inputs; ++n) {
      const std::string bytes = changed(corpus, random);
      try {
        target.read(bytes);
      } catch (const std::exception& error) {
        BOOST_ERROR(target.name << ", seed " << seed << ", input " << n << ": " << error.what() << "\n" << bytes);
      }
    }
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    BOOST_TEST_MESSAGE(fmt::format("{}: {} inputs, {:.0f} a second", target.name, inputs, inputs / seconds));
    ++asked;
  }
  BOOST_TEST(asked > 0, "no target is called " << only);
}

BOOST_AUTO_TEST_SUITE_END()
