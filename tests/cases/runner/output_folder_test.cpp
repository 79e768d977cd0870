#include "cases/runner/output_folder.h"

#include <unistd.h>

#include <boost/test/unit_test.hpp>
#include <iterator>

#include "core/base/error.h"
#include "tests/folder.h"

using namespace rigor;
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t entries(const fs::path& folder) { return std::distance(fs::directory_iterator(folder), {}); }

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_runner_output_folder)

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
  place.write("out/.partial-999999999/journals/0.journal", "half a case");
  {
    OutputFolder folder(out, {}, true);
    BOOST_TEST(content(fs::path(folder.journals()) / "0.journal") == "half a case");
    folder.keep();
  }
  BOOST_TEST(entries(place.path / "out") == 2u);  // what was kept, and the folder of trajectories
  fs::rename(place.path / ("out/.partial-" + std::to_string(getpid())), place.path / "out/.partial-999999999");
  OutputFolder folder(out, {});
  BOOST_TEST(!fs::exists(fs::path(folder.journals()) / "0.journal"));
}

BOOST_AUTO_TEST_CASE(what_is_not_published_leaves_no_trace) {
  const Folder place;
  place.write("out/results.json", "old");
  { OutputFolder((place.path / "out").string(), {"results.json"}).write("results.json", "new"); }
  BOOST_TEST(content(place.path / "out/results.json") == "old");
  BOOST_TEST(entries(place.path / "out") == 2u);  // and the empty folder of trajectories
}

BOOST_AUTO_TEST_CASE(what_a_killed_run_left_is_swept_away) {
  const Folder place;
  place.write("out/.partial-999999999/results.json", "torn");
  place.write("out/.partial-mine/notes", "not Rigor's");
  { OutputFolder folder((place.path / "out").string(), {}); }
  BOOST_TEST(!fs::exists(place.path / "out/.partial-999999999"));
  BOOST_TEST(fs::exists(place.path / "out/.partial-mine/notes"));
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
  BOOST_TEST(entries(place.path / "taken") == 2u);
}

BOOST_AUTO_TEST_SUITE_END()
