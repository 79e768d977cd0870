#include "cases/case/suite.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/vocabulary.h"
#include "tests/core/scene/toml/refusal.h"
#include "tests/folder.h"

using namespace rigor;

namespace cases_case_suite {

namespace fs = std::filesystem;

const std::string kCase = "title = 'x'\nscene.body = [{ name = 'a', fixed = true }]\nrun = { duration = 1, dt = 1 }";

// A suite of five cases, and a folder of two beside it.
struct TwoFolders : Folder {
  std::string suite = (path / "suite").string();
  std::string other = (path / "other").string();
  TwoFolders() {
    for (const char* file :
         {"suite/springs/one.toml", "suite/springs/two.toml", "suite/contact/two.toml", "suite/contact/deep/three.toml",
          "suite/springs/one-more.toml", "other/b.toml", "other/a.toml"}) {
      write(file, kCase);
    }
    write("suite/springs/notes.md", "not a case");
    fs::create_directories(path / "empty" / "folder.toml");
  }

  std::string ids_of(const std::vector<std::string>& words) const {
    std::string ids;
    for (const Case& c : select_cases(words, suite, test::words())) ids += (ids.empty() ? "" : " ") + c.id;
    return ids;
  }
  std::string refusal(const std::string& word) const {
    return refusal_of([&] { select_cases({word}, suite, test::words()); });
  }
};

const std::string kAll = "contact/deep/three contact/two springs/one springs/one-more springs/two";

}  // namespace cases_case_suite

BOOST_FIXTURE_TEST_SUITE(cases_case_suite, TwoFolders)

BOOST_AUTO_TEST_CASE(the_ids_are_the_sorted_paths_of_the_case_files) {
  std::string ids;
  for (const std::string& id : suite_ids(suite)) ids += (ids.empty() ? "" : " ") + id;
  BOOST_TEST(ids == kAll);
  BOOST_TEST(suite_ids(suite + "/").front() == "contact/deep/three");
}

BOOST_AUTO_TEST_CASE(words_name_cases_by_id_last_part_and_family) {
  BOOST_TEST(ids_of({}) == kAll);
  BOOST_TEST(ids_of({"springs/one"}) == "springs/one");
  BOOST_TEST(ids_of({"one"}) == "springs/one");
  BOOST_TEST(ids_of({"springs"}) == "springs/one springs/one-more springs/two");
  BOOST_TEST(ids_of({"springs/"}) == "springs/one springs/one-more springs/two");
  BOOST_TEST(ids_of({"contact/deep"}) == "contact/deep/three");
  BOOST_TEST(ids_of({"three", "springs/two"}) == "contact/deep/three springs/two");
}

BOOST_AUTO_TEST_CASE(words_name_files_and_folders_anywhere) {
  BOOST_TEST(ids_of({other + "/a.toml"}) == other + "/a.toml");
  BOOST_TEST(ids_of({other}) == other + "/a.toml " + other + "/b.toml");
}

BOOST_AUTO_TEST_CASE(a_file_of_the_suite_goes_by_its_id_however_it_is_named) {
  BOOST_TEST(ids_of({suite + "/springs/one.toml"}) == "springs/one");
  BOOST_TEST(ids_of({other + "/../suite/contact/deep"}) == "contact/deep/three");
}

BOOST_AUTO_TEST_CASE(a_case_named_twice_is_selected_once) {
  BOOST_TEST(ids_of({"one", "springs", "springs/one", suite + "/springs/one.toml"}) ==
             "springs/one springs/one-more springs/two");
  BOOST_TEST(ids_of({other, other + "/./b.toml"}) == other + "/a.toml " + other + "/b.toml");
}

BOOST_AUTO_TEST_CASE(a_word_that_names_nothing_is_answered_with_the_near_match) {
  BOOST_TEST(
      refusal("sprins").starts_with("there is no case, family, file or folder 'sprins' (did you mean 'springs'?)"));
  BOOST_TEST(refusal("springs/tow")
                 .starts_with("there is no case, family, file or folder 'springs/tow' (did you mean 'springs/two'?)"));
  BOOST_TEST(refusal("thre").find("did you mean 'three'?") != std::string::npos);
  BOOST_TEST(refusal("unrelated").find("did you mean") == std::string::npos);
  BOOST_TEST(refusal("") == "an empty word names no case");
  BOOST_TEST(refusal(std::string(100'000, 'x')).starts_with("there is no case"));
}

BOOST_AUTO_TEST_CASE(a_name_that_several_cases_have_is_refused_with_their_ids) {
  BOOST_TEST(refusal("two") == "'two' is the name of several cases: contact/two, springs/two; give one of these");
}

BOOST_AUTO_TEST_CASE(a_folder_or_file_without_a_case_is_refused) {
  const std::string empty = (path / "empty").string(), notes = suite + "/springs/notes.md";
  BOOST_TEST(refusal(empty) == empty + ": there is no case, no .toml file, in this folder");
  BOOST_TEST(refusal(notes) == notes + ": is not a .toml file, nor one of a robot: .urdf, .sdf, .mjcf, .xml");
  BOOST_TEST(refusal_of([&] { select_cases({}, empty, test::words()); }) ==
             "--suite: there is no case in the folder '" + empty + "'");
  BOOST_TEST(refusal_of([&] { select_cases({}, empty + "/none", test::words()); }) ==
             "--suite: there is no folder '" + empty + "/none'");
  // The folder is at fault, and not the word.
  BOOST_TEST(refusal_of([&] { select_cases({"springs/two"}, empty + "/none", test::words()); }) ==
             "--suite: there is no folder '" + empty + "/none'");
}

BOOST_AUTO_TEST_CASE(a_file_can_be_given_where_there_is_no_suite) {
  const std::string file = other + "/a.toml";
  BOOST_TEST(select_cases({file}, suite + "/none", test::words()).at(0).id == file);
}

BOOST_AUTO_TEST_CASE(a_broken_case_is_refused_with_its_place) {
  const std::string file = write("suite/springs/one.toml", "[&");
  BOOST_TEST(refusal("one").starts_with(file + ":1:2: is not TOML"));
}

BOOST_AUTO_TEST_CASE(a_link_to_itself_is_no_case) {
  fs::create_symlink(path / "loop.toml", path / "loop.toml");
  BOOST_TEST(refusal((path / "loop.toml").string()).starts_with("there is no case, family, file or folder"));
}

BOOST_AUTO_TEST_CASE(the_suite_holds_the_scenes_of_the_course) {
  const auto ids = suite_ids(default_suite_dir());
  for (const char* id : {"ballistic/projectile", "contact/collision", "contact/collision-elastic",
                         "contact/collision-inelastic", "springs/body-springs", "springs/fixed-spring"}) {
    BOOST_TEST_CONTEXT(id) { BOOST_TEST((std::find(ids.begin(), ids.end(), id) != ids.end())); }
  }
}

BOOST_AUTO_TEST_SUITE_END()
