// Each command line that the program prints is run as it stands, by a shell.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <regex>

#include "cases/report/wording/printed_command.h"
#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_printed_commands {

const std::string kPlugin = "python3 " RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py";

struct Pasting : Program {
  // All that stand in a text: "rigor ..." to the end of the line or to a backtick. Those with a word in capitals, as
  // DIR, say how a command is used and are none to paste.
  static std::vector<std::string> commands_in(const std::string& text) {
    static const std::regex command("rigor ((diagnose|run|tune|sweep|history|gate) [^`\n]*)");
    static const std::regex usage("(^| )[A-Z]{3,}( |$)");
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), command), end; match != end; ++match) {
      if (!std::regex_search((*match)[1].str(), usage)) found.push_back((*match)[1]);
    }
    return found;
  }
  int paste(const std::string& command, const std::string& more = "") const {
    const std::string line =
        "cd '" + folder.path.string() + "' && '" RIGOR_PROGRAM "' " + command + more + " >pasted.out 2>pasted.err";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

// The thrown stone with a gate that no semi-implicit engine keeps.
std::string failing_case() {
  return fmt::format("{}[[gate]]\nmetric = \"position_error\"\nmax = 1e-9\nbecause = \"a test\"\n", kThrown);
}

}  // namespace cases_cli_printed_commands

BOOST_FIXTURE_TEST_SUITE(cases_cli_printed_commands, Pasting)

BOOST_AUTO_TEST_CASE(words_are_quoted_where_a_shell_needs_it) {
  BOOST_TEST(pasted({"rigor", "run", "a/b-1.toml", "--engine", "ode,erp=0.2@stock"}) ==
             "rigor run a/b-1.toml --engine ode,erp=0.2@stock");
  BOOST_TEST(pasted({"my case", "it's", "", "2% energy", "$x"}) == "'my case' 'it'\\''s' '' '2% energy' '$x'");
}

// An engine from outside, a case with a blank in its name.
BOOST_AUTO_TEST_CASE(the_report_names_the_plugin_that_diagnose_needs) {
  folder.write("my stone.toml", failing_case());
  run({"run", "my stone.toml", "--plugin", kPlugin, "--engine", "toy-py", "--out", "out"});
  const std::vector<std::string> commands = commands_in(content("out/report.md"));
  BOOST_TEST_REQUIRE(commands.size() == 1u, content("out/report.md"));
  BOOST_TEST(commands[0].find("--plugin") != std::string::npos, commands[0]);
  BOOST_TEST(paste(commands[0]) == 0, commands[0] << ": " << content("pasted.err"));
  BOOST_TEST(content("pasted.out").starts_with("toy-py: "), content("pasted.out"));
}

BOOST_AUTO_TEST_CASE(a_failed_gate_names_the_plugin_that_diagnose_needs) {
  folder.write("my stone.toml", failing_case());
  const Answer answer = run({"gate", "my stone.toml", "--plugin", kPlugin, "--engine", "toy-py", "--out", "out"});
  BOOST_TEST(answer.code == 1, answer.err);
  const std::vector<std::string> commands = commands_in(answer.out + answer.err);
  BOOST_TEST_REQUIRE(commands.size() == 1u, answer.out);
  BOOST_TEST(paste(commands[0]) == 0, commands[0] << ": " << content("pasted.err"));
  BOOST_TEST(content("pasted.out").starts_with("toy-py: "), content("pasted.out"));
}

BOOST_AUTO_TEST_CASE(the_report_names_the_suite_that_diagnose_needs) {
  folder.write("suite/stones/stone.toml", failing_case());
  run({"run", "stones/stone", "--suite", "suite", "--engine", "ode", "--out", "out"});
  const std::vector<std::string> commands = commands_in(content("out/report.md"));
  BOOST_TEST_REQUIRE(commands.size() == 1u, content("out/report.md"));
  BOOST_TEST(paste(commands[0]) == 0, commands[0] << ": " << content("pasted.err"));
}

BOOST_AUTO_TEST_CASE(tunes_commands_run) {
  folder.write("my stone.toml", kThrown);
  const Answer answer = run(
      {"tune", "my stone.toml", "--engine", "ode:worldstep", "--within", "5cm", "--duration", "0.5", "--jobs", "2"});
  const std::vector<std::string> commands = commands_in(answer.out);
  BOOST_TEST_REQUIRE(commands.size() == 2u, answer.out);
  BOOST_TEST(commands[0].starts_with("run 'my stone.toml' --engine ode:worldstep"), commands[0]);
  for (const std::string& command : commands) {
    const bool is_run = command.starts_with("run ");
    const int code = paste(command, is_run ? " --out pasted" : " --jobs 2");
    BOOST_TEST(code == 0, command << ": " << content("pasted.err"));
  }
}

BOOST_AUTO_TEST_SUITE_END()
