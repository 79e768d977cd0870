// The first minutes of a new user: the next step, an own case, completions, and the program's files.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "cases/cli/commands.h"
#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_first_minutes {

using Json = nlohmann::json;

struct Variable {
  explicit Variable(const std::string& value) { setenv("RIGOR_HOME", value.c_str(), 1); }
  ~Variable() { unsetenv("RIGOR_HOME"); }
};

}  // namespace cases_cli_first_minutes

BOOST_FIXTURE_TEST_SUITE(cases_cli_first_minutes, Program)

BOOST_AUTO_TEST_CASE(without_a_command_it_says_what_to_do_next) {
  const Answer answer = run({});
  BOOST_TEST(answer.code == 2);
  for (const char* next : {"rigor run springs/fixed-spring", "rigor list", "rigor new my-case", "rigor gate --quick"})
    BOOST_TEST(answer.err.find(next) != std::string::npos, answer.err);
}

BOOST_AUTO_TEST_CASE(a_new_case_runs_and_its_gate_holds_and_it_is_never_written_over) {
  BOOST_TEST(run({"new", "my-case"}).code == 0);
  const std::string text = content("my-case.toml");
  const Answer gate = run({"gate", "my-case.toml", "--out", "out"});
  BOOST_TEST(gate.code == 0, gate.out + gate.err);
  const Json results = Json::parse(content("out/results.json"));
  BOOST_TEST(!results.at("cases")[0].at("gates")[0].at("answers").empty());
  const Answer again = run({"new", "my-case.toml"});
  BOOST_TEST(again.code == 2);
  BOOST_TEST(again.err.find("exists") != std::string::npos, again.err);
  BOOST_TEST(content("my-case.toml") == text);
  BOOST_TEST(run({"new"}).code == 2);
  BOOST_TEST(run({"new", "no/such/folder/case"}).code == 2);
  BOOST_TEST(run({"new", "a\"b"}).code == 2);
}

BOOST_AUTO_TEST_CASE(the_version_names_the_compiler_and_each_engine) {
  const Answer answer = run({"--version"});
  BOOST_TEST(answer.code == 0);
  for (const char* part : {"rigor ", "commit ", "ode ", "bullet ", "core ", "double precision"})
    BOOST_TEST(answer.out.find(part) != std::string::npos, part);
  const bool has_compiler =
      answer.out.find("g++ ") != std::string::npos || answer.out.find("clang ") != std::string::npos;
  BOOST_TEST(has_compiler);
}

BOOST_AUTO_TEST_CASE(a_run_first_says_what_it_will_do_and_about_how_long_that_takes) {
  folder.write("thrown.toml", kThrown);
  const Answer answer = run({"run", "thrown.toml", "--engine", "ode", "--engine", "core:rk4", "--jobs", "1"});
  const std::string moment = "rigor: 1 case by 2 runs: 2 cells; a moment with 1 job; the reports will be in out\n";
  BOOST_TEST(answer.err.starts_with(moment), answer.err);
  const Answer longer =
      run({"run", "thrown.toml", "--engine", "ode", "--duration", "300", "--dt", "1/1000", "--jobs", "1"});
  BOOST_TEST(longer.err.find(" 1 cell; ") != std::string::npos, longer.err);
  BOOST_TEST(longer.err.find(" s with 1 job") != std::string::npos, longer.err);
}

BOOST_AUTO_TEST_CASE(the_report_is_opened_by_the_desktop_or_it_says_where_it_is) {
  BOOST_TEST(run({"open"}).code == 2);
  folder.write("out/report.html", "<html/>");
  const std::string path_before = std::getenv("PATH");
  setenv("PATH", folder.path.c_str(), 1);  // with no xdg-open in it, and then with one
  const Answer none = run({"open"});
  const std::string opener = folder.write("xdg-open", "#!/bin/sh\necho \"$1\" > asked\n");
  std::filesystem::permissions(opener, std::filesystem::perms::owner_all);
  const Answer shown = run({"open"});
  setenv("PATH", path_before.c_str(), 1);
  BOOST_TEST(none.code == 3);
  BOOST_TEST(none.err.find(path("out/report.html")) != std::string::npos, none.err);
  BOOST_TEST(shown.code == 0, shown.err);
  BOOST_TEST(content("asked") == path("out/report.html") + "\n");
}

BOOST_AUTO_TEST_CASE(the_laboratory_is_opened_at_a_scene_or_it_says_how_to_build_it) {
  const Answer wrong = run({"play", "contact/colision"});
  BOOST_TEST((wrong.code == 2 && wrong.err.find("did you mean 'contact/collision'?") != std::string::npos), wrong.err);
  folder.write("mine.toml", kThrown);
  BOOST_TEST(run({"play", "mine.toml"}).err.find("drop the file onto the page") != std::string::npos);
  BOOST_TEST(run({"play", "springs/net", "springs/ellipse"}).code == 2);
  const std::string opener = folder.write("xdg-open", "#!/bin/sh\n/bin/cat \"$1\" > asked\n");
  std::filesystem::permissions(opener, std::filesystem::perms::owner_all);
  const std::string path_before = std::getenv("PATH");
  setenv("PATH", folder.path.c_str(), 1);
  const Answer shown = run({"play", "contact/collision"});
  setenv("PATH", path_before.c_str(), 1);
  if (std::filesystem::exists(RIGOR_BUILD_DIR "/play/index.html")) {
    BOOST_TEST(shown.code == 0, shown.err);
    BOOST_TEST(content("asked").find("/play/index.html#/contact/collision\"") != std::string::npos, content("asked"));
  } else {
    BOOST_TEST((shown.code == 2 && shown.err.find("cases/setup release play") != std::string::npos), shown.err);
  }
}

// A shell reads what it is given, and completes each command and option of the table.
BOOST_AUTO_TEST_CASE(completions_and_the_manual_know_every_command_and_option) {
  const Answer bash = run({"completion", "bash"}), zsh = run({"completion", "zsh"}), man = run({"completion", "man"});
  BOOST_TEST(bash.code + zsh.code + man.code == 0);
  for (const CommandRow& row : commands()) {
    BOOST_TEST(bash.out.find("      " + row.name + ") words=") != std::string::npos, row.name);
    BOOST_TEST(zsh.out.find("'" + row.name + ":") != std::string::npos, row.name);
    BOOST_TEST(man.out.find(".SS " + row.name + "\n") != std::string::npos, row.name);
    for (const OptionFact& option : options_of(row))
      BOOST_TEST(bash.out.find(option.name) != std::string::npos, option.name);
  }
  folder.write("rigor.bash", bash.out);
  const std::string asked =
      "bash -c 'cd " + folder.path.string() +
      " && . ./rigor.bash && COMP_WORDS=(rigor swe) COMP_CWORD=1 && _rigor && "
      "[ \"${COMPREPLY[*]}\" = sweep ] && COMP_WORDS=(rigor merge --su) COMP_CWORD=2 && _rigor && "
      "[ \"${COMPREPLY[*]}\" = --suite ] && COMP_WORDS=(rigor run springs/fixed-s) COMP_CWORD=2 && _rigor && "
      "[ \"${COMPREPLY[*]}\" = springs/fixed-spring ] && COMP_WORDS=(rigor trace --format g) COMP_CWORD=3 && _rigor && "
      "[ \"${COMPREPLY[*]}\" = gltf ] && COMP_WORDS=(rigor export --format m) COMP_CWORD=3 && _rigor && "
      "[ \"${COMPREPLY[*]}\" = mjcf ]'";
  BOOST_TEST(std::system(asked.c_str()) == 0);
  BOOST_TEST(run({"completion"}).code == 2);
  BOOST_TEST(run({"completion", "bsh"}).err.find("did you mean 'bash'") != std::string::npos);
}

// A page is the same for every user, so it names no folder of the machine that built it.
BOOST_AUTO_TEST_CASE(help_and_the_manual_have_examples_and_no_path_of_the_build) {
  const std::string man = run({"completion", "man"}).out;
  BOOST_TEST(man.find(".SH EXAMPLES\n") != std::string::npos);
  BOOST_TEST(man.find(RIGOR_SOURCE_DIR) == std::string::npos);
  for (const CommandRow& row : commands()) {
    const Answer help = run({row.name, "--help"});
    BOOST_TEST(help.out.find("Examples:\n  rigor " + row.name) != std::string::npos, help.out);
    BOOST_TEST(run({row.name, "-h"}).out == help.out);
    BOOST_TEST(run({"help", row.name}).out == help.out);
    for (const OptionFact& option : options_of(row))
      BOOST_TEST(help.out.find("  " + option.name) != std::string::npos, option.name);
  }
  BOOST_TEST(run({"help"}).out == run({"--help"}).out);
  BOOST_TEST(run({"-h"}).out == run({"--help"}).out);
  BOOST_TEST(run({"version"}).out == run({"--version"}).out);
  const Answer wrong = run({"help", "rnu"});
  BOOST_TEST((wrong.code == 2 && wrong.err.find("did you mean 'run'?") != std::string::npos), wrong.err);
}

BOOST_AUTO_TEST_CASE(examples_name_options_and_cases_that_there_are) {
  for (const CommandRow& row : commands()) {
    BOOST_TEST(row.examples.size() >= 1u, row.name);
    for (const Example& example : row.examples) {
      BOOST_TEST(example.call.starts_with("rigor " + row.name), example.call);
      std::istringstream words(example.call);
      for (std::string word; words >> word;) {
        if (word.starts_with("--")) BOOST_TEST(has_option(row, word), example.call);
        const bool is_case =
            word.starts_with("springs/") || word.starts_with("joints/") || word.starts_with("ballistic/");
        if (is_case)
          BOOST_TEST(std::filesystem::exists(RIGOR_SOURCE_DIR "/cases/suite/" + word + ".toml"), example.call);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_wrong_home_does_not_stop_the_help) {
  const Variable set((folder.path / "nowhere").string());
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"}, {"run", "--help"}, {"--version"}})
    BOOST_TEST(run(words).code == 0);
}

BOOST_AUTO_TEST_CASE(a_trace_takes_the_only_step_of_its_case) {
  folder.write("thrown.toml", kThrown);
  const Answer answer = run({"trace", "thrown.toml", "--engine", "core:rk4"});
  BOOST_TEST(answer.code == 0, answer.err);
  BOOST_TEST(answer.out == run({"trace", "thrown.toml", "--engine", "core:rk4", "--dt", "1/10"}).out);
}

BOOST_AUTO_TEST_CASE(a_folder_of_cases_that_is_not_there_is_named_and_not_the_case) {
  const Answer answer = run({"run", "springs/fixed-spring", "--suite", "/nonexist"});
  BOOST_TEST(answer.code == 2);
  BOOST_TEST(answer.err == "rigor: --suite: there is no folder '/nonexist'\n", answer.err);
}

BOOST_AUTO_TEST_CASE(a_file_that_is_no_json_is_refused_in_words_of_our_own) {
  folder.write("broken.json", "{\"a\": nonsense}");
  folder.write("other.json", "{\"a\": 1}");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"compare", "broken.json", "broken.json"},
                                                {"baseline", "broken.json", "--regression", "ode"},
                                                {"baseline", "other.json"},
                                                {"history", "add", "broken.json"}}) {
    const Answer answer = run(words);
    BOOST_TEST(answer.code == 2);
    BOOST_TEST(answer.err.find("json.exception") == std::string::npos, answer.err);
  }
  const std::string err = run({"compare", "broken.json", "broken.json"}).err;
  BOOST_TEST(err.find("broken.json: neither a results.json nor a baseline: line 1, column 8: is not JSON") !=
                 std::string::npos,
             err);
}

BOOST_AUTO_TEST_CASE(its_files_are_where_the_variable_says_or_it_says_that_they_are_not) {
  const std::string home = (folder.path / "home").string();
  {
    const Variable set(home);
    const Answer answer = run({"list", "cases"});
    BOOST_TEST(answer.code == 2);
    BOOST_TEST(
        answer.err.find("RIGOR_HOME is '" + home + "', in which there is no folder 'suite'") != std::string::npos,
        answer.err);
  }
  std::filesystem::create_directories(home + "/adapters");
  run({"new", "mine"});
  folder.write("home/suite/own/mine.toml", content("mine.toml"));
  const Variable set(home);
  const Answer answer = run({"list", "cases"});
  BOOST_TEST(answer.code == 0, answer.err);
  BOOST_TEST(answer.out.find("own/mine") != std::string::npos, answer.out);
  BOOST_TEST(answer.out.find("springs/") == std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
