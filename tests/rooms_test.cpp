// The house: which room may include which. A room sees only those before it in its chain; a line that breaks this is
// printed as the compiler would print it.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "generated/tests/places.h"

BOOST_AUTO_TEST_SUITE(rooms)

namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

struct Include {
  std::string file;  // from the source's top
  int line;
  std::string what;  // with its quotes or angle brackets taken off
};

// The rooms of a folder, each of which sees itself and those before it.
struct Chain {
  std::string folder;  // "" is the top
  Names rooms;
};

const std::vector<Chain> kChains = {
    {"", {"core", "adapters", "cases", "bench", "tests"}},
    {"core", {"base", "scene", "engine", "dynamics", "", "examples"}},  // "": the public face, core/world.h
    {"core/dynamics", {"kernels", "model", "joints", "integrators", "collision", "contact"}},
    {"cases/report",
     {"", "wording", "csv", "json", "console", "markdown", "github", "junit", "html", "site", "scene", "trace"}},
    {"cases",
     {"import", "case", "truth", "metrics", "results", "runner", "gates", "analysis", "report", "laboratory", "cli"}},
};

// A table of rows: it alone includes what all rooms of its folder have.
const Names kTables = {"adapters/engines.cpp", "cases/report/reports.cpp"};

bool is_table(const std::string& file) { return std::find(kTables.begin(), kTables.end(), file) != kTables.end(); }

// The rooms of adapters/ that are no engine: what adapters share, engines from outside, and injected mistakes.
const Names kNoEngines = {"", "common", "plugin", "faults"};

// Whether a file of adapters/ may include another. An engine sees itself and common/. Siconos, and MuJoCo 3 as the
// reader of MJCF, run in another process, so they build on plugin/, which has the seam of those. So does the engine
// MuJoCo 3, which gets the scene as mujoco/ writes it.
bool is_allowed_adapter(const std::string& from, const std::string& to) {
  const bool is_engine = std::find(kNoEngines.begin(), kNoEngines.end(), from) == kNoEngines.end();
  if (from == to || to == "common") return true;
  if (from == "siconos" || from == "mjcf") return to == "plugin";
  if (from == "mujoco3") return to == "plugin" || to == "mujoco";
  return !is_engine && from != "common" && to.empty();
}

const fs::path kTop = RIGOR_SOURCE_DIR;

bool is_source(const fs::path& path) { return path.extension() == ".cpp" || path.extension() == ".h"; }

// Below `folder`, as paths from the top.
Names sources_in(const std::string& folder) {
  Names files;
  for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
    if (is_source(entry.path())) files.push_back(fs::relative(entry.path(), kTop).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Include> includes_of(const std::string& file) {
  std::vector<Include> found;
  std::ifstream in(kTop / file);
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    if (!text.starts_with("#include ")) continue;
    const std::size_t first = text.find_first_of("\"<"), last = text.find_last_of("\">");
    BOOST_TEST_REQUIRE((first != std::string::npos && last > first));
    found.push_back({file, line, text.substr(first + 1, last - first - 1)});
  }
  return found;
}

std::vector<Include> all_includes() {
  std::vector<Include> all;
  for (const std::string& room : kChains[0].rooms) {
    for (const std::string& file : sources_in(room)) {
      for (Include& one : includes_of(file)) all.push_back(std::move(one));
    }
  }
  return all;
}

// The room of a path in a chain: nothing for one that is not below its folder, "" for a file of the folder itself.
std::optional<std::string> room_of(const std::string& path, const Chain& chain) {
  const std::string start = chain.folder.empty() ? "" : chain.folder + "/";
  if (!path.starts_with(start)) return {};
  const std::size_t slash = path.find('/', start.size());
  return slash == std::string::npos ? "" : path.substr(start.size(), slash - start.size());
}

// Whether a line of `from` may include a file of `to`.
bool is_allowed(const std::string& from, const std::string& to, const Chain& chain) {
  const auto a = std::find(chain.rooms.begin(), chain.rooms.end(), from),
             b = std::find(chain.rooms.begin(), chain.rooms.end(), to);
  if (a == chain.rooms.end() || b == chain.rooms.end()) return false;
  return b <= a && !(from == "tests" && to == "bench");
}

// "file:line: #include what": those that `is_wrong`.
std::string wrong_ones(const std::vector<Include>& includes, const std::function<bool(const Include&)>& is_wrong) {
  std::string text;
  for (const Include& one : includes) {
    if (is_wrong(one)) text += one.file + ":" + std::to_string(one.line) + ": #include " + one.what + "\n";
  }
  return text;
}

std::string arrows_back(const std::vector<Include>& includes, const Chain& chain) {
  return wrong_ones(includes, [&](const Include& one) {
    const auto from = room_of(one.file, chain), to = room_of(one.what, chain);
    const bool is_ours = to && (!chain.folder.empty() || fs::exists(kTop / one.what));
    return from && is_ours && !is_table(one.file) && !is_allowed(*from, *to, chain);
  });
}

std::string arrows_between_adapters(const std::vector<Include>& includes) {
  const Chain adapters{"adapters", {}};
  return wrong_ones(includes, [&](const Include& one) {
    const auto from = room_of(one.file, adapters), to = room_of(one.what, adapters);
    return from && to && !is_table(one.file) && !is_allowed_adapter(*from, *to);
  });
}

// Types in named namespaces, and the lines of their definitions. Files are formatted by clang-format: a line without
// indent is directly in a namespace, and a namespace of more than one line is closed by its name.
std::map<std::string, Names> types_in(const std::string& file, std::istream& in) {
  static const std::regex space("(?:inline )?namespace ?([\\w: ]*) \\{"),
      type("(?:struct|class|enum class) (\\w+)(?: final)?(?: :[^;{]*)? \\{.*");
  std::map<std::string, Names> found;
  Names spaces;
  std::string text;
  std::smatch match;
  for (int line = 1, opened = 0; std::getline(in, text); ++line) {
    if (std::regex_match(text, match, space)) {
      spaces.push_back(match[1]), opened = line;
    } else if (text.starts_with("}  // namespace") || (text == "}" && line == opened + 2)) {
      BOOST_TEST_REQUIRE(!spaces.empty(), file << ":" << line);
      spaces.pop_back();
    } else if (std::regex_match(text, match, type)) {
      const bool is_its_own = std::find(spaces.begin(), spaces.end(), "") != spaces.end();
      std::string name;
      for (const std::string& outer : spaces) name += outer + "::";
      if (!is_its_own) found[name + match[1].str()].push_back(file + ":" + std::to_string(line));
    }
  }
  return found;
}

// The namespace of a file, or of the files below a folder; of several rows, that of the longest one. They are inline,
// so that another room says `Scene` for rigor::scene::Scene. Of a name that two rooms have each uses its own, and a
// third must say which.
struct RoomNamespace {
  std::string folder, name;
};

const std::vector<RoomNamespace> kNamespaces = {
    {"core/", "rigor"},
    {"core/scene/", "rigor::inline scene"},
    {"core/engine/", "rigor::inline engine"},
    {"core/dynamics/", "rigor::inline dynamics"},
    {"adapters/", "rigor::inline adapters"},
    {"cases/import/", "rigor::inline imports"},
    {"cases/case/", "rigor::inline cases"},
    {"cases/truth/", "rigor::inline truth"},
    {"cases/metrics/", "rigor::inline metric"},
    {"cases/results/", "rigor::inline results"},
    {"cases/runner/", "rigor::inline runner"},
    {"cases/gates/", "rigor::inline gates"},
    {"cases/analysis/", "rigor::inline analysis"},
    {"cases/report/", "rigor::inline report"},
    {"cases/laboratory/", "rigor::inline laboratory"},
    // In place of files of other rooms.
    {"cases/laboratory/wasm/child_in_page.cpp", "rigor::inline adapters"},
    {"cases/laboratory/wasm/no_cache.cpp", "rigor::inline truth"},
    {"cases/laboratory/wasm/no_hull.cpp", "rigor::inline scene"},
    {"cases/laboratory/wasm/scheme_rows.cpp", "rigor::inline adapters"},
    {"cases/cli/", "rigor::inline cli"},
    {"cases/python/", "rigor::python"},
    {"bench/", "rigor::bench"},
};

const std::string& namespace_of(const std::string& file) {
  const RoomNamespace* best = nullptr;
  for (const RoomNamespace& one : kNamespaces) {
    if (file.starts_with(one.folder) && (!best || one.folder.size() > best->folder.size())) best = &one;
  }
  BOOST_TEST_REQUIRE(best, file << " is in no room");
  return best->name;
}

// Namespaces below rigor that a file opens at the left margin for more than forward declarations, each with its line.
std::map<std::string, int> opened_in(std::istream& in) {
  static const std::regex opening("namespace (rigor[\\w: ]*) \\{"),
      declaration("(?:struct|class|enum class) [\\w: ]+;|");
  std::map<std::string, int> opened;
  std::string text, name;
  std::smatch match;
  int at = 0;
  for (int line = 1; std::getline(in, text); ++line) {
    if (std::regex_match(text, match, opening)) {
      name = match[1], at = line;
    } else if (text.starts_with("}")) {
      name.clear();
    } else if (!name.empty() && !std::regex_match(text, declaration)) {
      opened.emplace(name, at);
    }
  }
  return opened;
}

// "file:line: namespace": those that `file` opens and that are not its room's.
std::string foreign_namespaces(const std::string& file, std::istream& in) {
  const std::string& room = namespace_of(file);
  std::string text;
  for (const auto& [name, line] : opened_in(in)) {
    if (name != room && !name.starts_with(room + "::")) text += file + ":" + std::to_string(line) + ": " + name + "\n";
  }
  return text;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_file_opens_the_namespace_of_its_room) {
  std::istringstream right(
      "namespace rigor::inline scene {\nstruct Later;\n}\n\nnamespace rigor::inline gates {\nint a;\n}"),
      wrong("namespace rigor {\n\nint a;\n\n}  // namespace rigor\n"),
      inner("namespace rigor::inline adapters::bullet {\n\nint a;\n");
  BOOST_TEST(foreign_namespaces("cases/gates/gates.h", right) == "");
  BOOST_TEST(foreign_namespaces("cases/gates/gates.h", wrong) == "cases/gates/gates.h:1: rigor\n");
  BOOST_TEST(foreign_namespaces("adapters/bullet/bullet_turn.h", inner) == "");
  std::size_t read = 0;
  std::string foreign;
  for (const char* room : {"core", "adapters", "cases", "bench"}) {
    for (const std::string& file : sources_in(room)) {
      std::ifstream in(kTop / file);
      foreign += foreign_namespaces(file, in);
      ++read;
    }
  }
  BOOST_TEST(foreign == "");
  BOOST_TEST(read > 1000u);
}

BOOST_AUTO_TEST_CASE(a_room_includes_only_rooms_before_it) {
  const std::vector<Include> includes = all_includes();
  BOOST_TEST(includes.size() > 1000u);  // they are found at all
  for (const Chain& chain : kChains) {
    BOOST_TEST_CONTEXT("in " << (chain.folder.empty() ? "the house" : chain.folder))
    BOOST_TEST(arrows_back(includes, chain) == "");
  }
}

BOOST_AUTO_TEST_CASE(an_arrow_back_is_printed_with_its_line) {
  const Chain& cases = kChains.back();
  BOOST_TEST(arrows_back({{"cases/case/case_reader.cpp", 8, "cases/metrics/metric.h"}}, cases) ==
             "cases/case/case_reader.cpp:8: #include cases/metrics/metric.h\n");
  BOOST_TEST(arrows_back({{"cases/metrics/metrics.cpp", 3, "cases/metrics/metric.h"}}, cases) == "");
  BOOST_TEST(arrows_back({{"cases/cli/main.cpp", 1, "cases/attic/old.h"}}, cases) != "");  // a room that is no room
  BOOST_TEST(arrows_back({{"core/base/math.h", 1, "adapters/engines.h"}}, kChains[0]) != "");
}

BOOST_AUTO_TEST_CASE(only_readers_and_writers_include_the_toml_library) {
  BOOST_TEST(wrong_ones(all_includes(), [](const Include& one) {
               const bool may = one.file.ends_with("_reader.cpp") || one.file.ends_with("_writer.cpp");
               return one.what.starts_with("toml++") && !may && !one.file.starts_with("tests/");
             }) == "");
}

BOOST_AUTO_TEST_CASE(only_its_adapter_includes_an_engine) {
  const std::map<std::string, Names> headers = {{"ode", {"ode/"}},
                                                {"bullet", {"bullet/", "btBullet", "Bullet", "LinearMath/"}}};
  std::size_t met = 0;
  const std::string wrong = wrong_ones(all_includes(), [&](const Include& one) {
    if (one.file.starts_with("tests/") || one.file.starts_with("bench/")) return false;  // they hold ours against it
    return std::any_of(headers.begin(), headers.end(), [&](const auto& engine) {
      const bool is_its = std::any_of(engine.second.begin(), engine.second.end(),
                                      [&](const std::string& start) { return one.what.starts_with(start); });
      met += is_its;
      return is_its && !one.file.starts_with("adapters/" + engine.first + "/");
    });
  });
  BOOST_TEST(wrong == "");
  BOOST_TEST(met > 0u);
}

BOOST_AUTO_TEST_CASE(an_adapter_includes_only_itself_and_what_adapters_share) {
  BOOST_TEST(arrows_between_adapters(all_includes()) == "");
  for (const char* other : {"adapters/bullet/bullet_turn.h", "adapters/engines.h", "adapters/plugin/plugins.h"})
    BOOST_TEST(arrows_between_adapters({{"adapters/ode/ode_world.cpp", 3, other}}) != "", other);
  BOOST_TEST(arrows_between_adapters({{"adapters/common/spanning_tree.h", 3, "adapters/ode/ode_hull.h"}}) != "");
  BOOST_TEST(arrows_between_adapters({{"adapters/ode/ode_world.cpp", 3, "adapters/common/spanning_tree.h"}}) == "");
  BOOST_TEST(arrows_between_adapters({{"adapters/siconos/siconos_engine.h", 3, "adapters/plugin/plugin_info.h"}}) ==
             "");
}

BOOST_AUTO_TEST_CASE(no_folder_holds_more_than_a_reader_can_take_in) {
  constexpr int kMost = 25;  // files, beside the rows of a table: sources without a header of their own
  std::map<std::string, int> count;
  for (const char* room : {"core", "cases"}) {
    for (const std::string& file : sources_in(room)) {
      const fs::path path = file;
      const bool is_row = path.extension() == ".cpp" && !fs::exists(kTop / fs::path(file).replace_extension(".h"));
      if (!is_row) ++count[path.parent_path().string()];
    }
  }
  for (const auto& [folder, files] : count) BOOST_TEST_CONTEXT(folder) BOOST_TEST(files <= kMost);
}

// Two of them in one program are no error to a compiler, nor to a linker, which takes one's functions for both.
BOOST_AUTO_TEST_CASE(no_two_types_have_one_name) {
  std::istringstream sample("namespace a::b {\nnamespace {\nstruct Own {\n}  // namespace\nclass C final : D {\n");
  BOOST_TEST((types_in("f.h", sample) == std::map<std::string, Names>{{"a::b::C", {"f.h:5"}}}));
  std::map<std::string, Names> all;
  for (const std::string& room : kChains[0].rooms) {
    for (const std::string& file : sources_in(room)) {
      std::ifstream in(kTop / file);
      for (const auto& [name, places] : types_in(file, in))
        all[name].insert(all[name].end(), places.begin(), places.end());
    }
  }
  BOOST_TEST(all.size() > 300u);  // they are found at all
  for (const auto& [name, places] : all)
    BOOST_TEST(places.size() == 1u, name << " stands in " << places.front() << " and in " << places.back());
}

BOOST_AUTO_TEST_SUITE_END()
