// The limits of foreign files: nothing outside --out is written, whatever names occur in a case, in the answers of a
// plug-in or in a part of a grid. A page made from them contains none of their markup. See .github/SECURITY.md.
#include <boost/test/unit_test.hpp>
#include <map>

#include "cases/runner/journal/journal.h"
#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_security {

namespace fs = std::filesystem;

const std::string kWayUp = "../../planted";
const std::string kMarkup = "\"><img src=x onerror=alert(1)></script><script>alert(2)</script>";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

// A stone that is thrown, under the name that a case file gives it.
std::string thrown_with(const std::string& name) {
  return replaced(replaced(kThrown, "name = \"stone\"", "name = '" + name + "'"), "title = \"thrown\"",
                  "title = '" + name + "'");
}

struct Fixture : Program {
  // All that stands beside `out`, where nothing may change.
  std::map<std::string, std::string> beside_out() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path)) {
      const std::string name = fs::relative(entry.path(), folder.path).string();
      if (name == "stdout" || name == "stderr" || name == "a/b/out" || name.starts_with("a/b/out/")) continue;
      found[name] = entry.is_regular_file() ? content(name) : "";
    }
    return found;
  }
};

// A plug-in in Python that says this name of itself, and that any run has blown up.
std::string plugin_named(const std::string& name) {
  return "import sys\nfor line in sys.stdin:\n"
         "    info = '{\"ok\":true,\"name\":\"" +
         name +
         "\",\"version\":\"1\",\"precision\":\"double\",\"features\":[\"wrench\"],\"methods\":[{\"name\":\"m\","
         "\"summary\":\"s\",\"order\":1,\"symplectic\":false,\"leapfrog_stagger\":0,\"options\":[]}],\"calls\":[]}'\n"
         "    answer = '{\"ok\":false,\"status\":\"diverged\",\"why\":\"" +
         name + "\"}'\n    print(info if '\"info\"' in line else answer, flush=True)\n";
}

}  // namespace cases_cli_security

BOOST_FIXTURE_TEST_SUITE(cases_cli_security, Fixture)

BOOST_AUTO_TEST_CASE(names_that_lead_out_of_the_folder_write_nothing_there) {
  folder.write("suite/air/stone.toml", thrown_with(kWayUp));
  folder.write("a/b/case.toml", thrown_with("/tmp/planted"));
  const auto before = beside_out();
  for (const std::string word : {"stone", "a/b/../../suite/air/../air/stone.toml", "a/b/case.toml"}) {
    const Answer answer = run({"run", word, "--suite", "suite", "--engine", "core", "--out", "a/b/out"});
    BOOST_TEST(answer.code == 0, answer.err);
    BOOST_TEST((beside_out() == before), word);
    BOOST_TEST(std::distance(fs::directory_iterator(folder.path / "a/b/out/trajectories"), {}) == 1);
  }
}

BOOST_AUTO_TEST_CASE(a_plugin_whose_name_leads_out_or_is_markup_is_refused) {
  for (const std::string& name : {kWayUp, std::string("<b>bold</b>"), std::string("a b"), std::string()}) {
    folder.write("plugin.py", plugin_named(name));
    folder.write("case.toml", kThrown);
    const auto before = beside_out();
    const Answer answer =
        run({"run", "case.toml", "--plugin", "python3 " + path("plugin.py"), "--engine", "core", "--out", "a/b/out"});
    BOOST_TEST(answer.code == 2, name << ": " << answer.err);
    BOOST_TEST(answer.err.find("plug-in") != std::string::npos, answer.err);
    BOOST_TEST((beside_out() == before), name);
  }
}

// The parts are whole, and were made by this build of this grid; but for the names of their trajectories.
BOOST_AUTO_TEST_CASE(a_part_of_a_grid_links_no_file_to_another_place) {
  folder.write("suite/air/stone.toml", kThrown);
  int changed = 0;
  for (const std::string part : {"1", "2"}) {
    BOOST_TEST_REQUIRE(run({"run", "--suite", "suite", "--engine", "core", "--dt", "1/10", "--dt", "1/20", "--shard",
                            part + "/2", "--out", "part-" + part})
                           .code == 0);
    const std::string name = "part-" + part + "/part.journal", bytes = content(name);
    std::size_t at = bytes.find('\n') + 1, of_case = 0;
    std::string forged = bytes.substr(0, at);
    for (Journal::Record record; at < bytes.size() && take_record(bytes, at, of_case, record);) {
      const std::string named = "\"trajectory\":\"";
      if (const std::size_t from = record.message.find(named); from != std::string::npos)
        record.message.insert(from + named.size(), "../../../../"), ++changed;
      forged += framed(of_case, record);
    }
    folder.write("forged-" + name, forged);
  }
  BOOST_TEST_REQUIRE(changed == 2);
  BOOST_TEST(run({"merge", "part-1", "part-2", "--suite", "suite", "--out", "a/b/out"}).code == 0);
  const auto before = beside_out();
  const Answer answer = run({"merge", "forged-part-1", "forged-part-2", "--suite", "suite", "--out", "a/b/out"});
  BOOST_TEST(answer.code == 2, answer.err);
  BOOST_TEST(answer.err.find("it names another trajectory") != std::string::npos, answer.err);
  BOOST_TEST((beside_out() == before));
}

// The report's own page is asked in a browser, by cases/report/html.
BOOST_AUTO_TEST_CASE(a_page_of_a_sweep_holds_no_markup_of_the_case_and_allows_no_script) {
  folder.write("suite/air/stone.toml", thrown_with(kMarkup));
  const Answer answer = run({"sweep", "stone", "--suite", "suite", "--engine", "core", "--vary",
                             "scene.gravity[1]=-9,-10", "--out", "a/b/out"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  const std::string page = content("a/b/out/sweep.html");
  BOOST_TEST(page.find("&quot;&gt;&lt;img src=x onerror=alert(1)&gt;") != std::string::npos);
  for (const char* word : {"<img", "<script", "</script"}) BOOST_TEST(page.find(word) == std::string::npos, word);
  const std::size_t policy =
      page.find("http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src");
  BOOST_TEST(policy < page.find("<title>"));
}

BOOST_AUTO_TEST_SUITE_END()
