#include "core/scene/toml/file_reader.h"

#include <sys/stat.h>

#include <boost/test/unit_test.hpp>

#include "tests/core/scene/toml/refusal.h"
#include "tests/folder.h"

using namespace rigor;

namespace core_scene_toml_file_reader {

namespace fs = std::filesystem;

void check(const std::string& path, const std::string& fault) {
  BOOST_TEST(refusal_of([&] { read_text_file(path); }) == path + ": " + fault);
}

}  // namespace core_scene_toml_file_reader

BOOST_FIXTURE_TEST_SUITE(core_scene_toml_file_reader, Folder)

BOOST_AUTO_TEST_CASE(a_file_is_read_byte_by_byte) {
  const std::string text("a\r\n\0\xff", 5);
  std::ofstream(path / "f", std::ios::binary) << text;
  BOOST_TEST(read_text_file(path / "f") == text);
  std::ofstream(path / "empty").flush();
  BOOST_TEST(read_text_file(path / "empty") == "");
}

BOOST_AUTO_TEST_CASE(what_is_no_readable_file_is_refused) {
  ::mkfifo((path / "pipe").c_str(), 0600);
  check(path / "none", "there is no such file");
  check(path / "none" / "deeper", "there is no such file");
  check("", "there is no such file");
  check(path, "is a folder, not a file");
  check(path / "pipe", "is not a regular file");
  check("/dev/zero", "is not a regular file");
  check("/" + std::string(5000, 'x'), "cannot be read: File name too long");
  check("/proc/self/mem", "cannot be read: Input/output error");  // a regular file that not even root can read at 0
}

BOOST_AUTO_TEST_CASE(a_file_beyond_the_limit_is_refused_and_one_at_it_is_not) {
  std::ofstream(path / "f").flush();
  fs::resize_file(path / "f", kLargestFile);
  BOOST_TEST(read_text_file(path / "f").size() == kLargestFile);
  fs::resize_file(path / "f", kLargestFile + 1);
  check(path / "f", "is larger than 64 MiB, the largest file that is read");
}

BOOST_AUTO_TEST_SUITE_END()
