// junit.xml, in the form that Jenkins, GitLab and GitHub's readers share. Each case is a testsuite. Each cell is a
// testcase with its wall time, and so is each gate over several cells. A failed gate is a <failure>, a cell without
// result an <error>. Unsupported features and known deviations are <skipped>.
#include <fmt/format.h>

#include <algorithm>

#include "cases/report/reports.h"
#include "cases/results/result_json.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

// Text of other people: bytes that are no UTF-8 and characters that XML 1.0 does not allow at all become U+FFFD or '?'.
std::string xml_escaped(const std::string& text) {
  const auto clean = parse_json(text_of(text, -1)).get<std::string>();
  std::string out;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const char c = clean[i];
    const auto byte = static_cast<unsigned char>(c);
    const bool is_forbidden = clean.compare(i, 3, "\xEF\xBF\xBE") == 0 || clean.compare(i, 3, "\xEF\xBF\xBF") == 0;
    if (is_forbidden) {
      out += '?', i += 2;
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\n') {
      out += "&#10;";
    } else {
      out += byte < 0x20 || byte == 0x7f ? '?' : c;
    }
  }
  return out;
}

struct TestCase {
  std::string name, classname;
  double seconds = 0;
  std::string kind;     // "", "failure", "error", "skipped"
  std::string type;     // the metric that failed, or the cell's status
  std::string message;  // the first line
  std::string text;     // all of them
  std::string warning;  // details beside a passed test
};

struct Suite {
  std::string name;
  std::vector<TestCase> cases;
  long count(const std::string& kind) const {
    return std::count_if(cases.begin(), cases.end(), [&](const TestCase& c) { return c.kind == kind; });
  }
  double seconds() const {
    double sum = 0;
    for (const TestCase& c : cases) sum += c.seconds;
    return sum;
  }
};

void add_line(TestCase& test, const std::string& line) {
  if (test.message.empty()) test.message = line;
  test.text += line + "\n";
}

void add_warning(TestCase& test, const GateResult& answer) {
  if (!answer.caveat.empty()) test.warning += fmt::format("warning: {}, but {}\n", answer.text, answer.caveat);
}

TestCase of_cell(const Results& results, const CaseResult& result, const Cell& cell) {
  const std::string& run = results.runs[cell.run].text;
  TestCase test{
      fmt::format("{} dt={}", run, cell.dt.text), result.definition.id, cell.wall_seconds, "", "", "", "", ""};
  if (cell.reduced_order)
    test.warning =
        fmt::format("warning: from {:.4g} s on stepped {}\n", cell.reduced_order->from, cell.reduced_order->how);
  if (cell.status == Status::unsupported) test.kind = "skipped", add_line(test, cell.reason);
  if (cell.status == Status::crashed || cell.status == Status::timed_out || cell.status == Status::invalid)
    test.kind = "error", test.type = word_of(cell.status), add_line(test, cell.reason);
  for (const GateResult& answer : result.gates) {
    if (answer.engine != run || answer.dt != cell.dt.text) continue;
    const Gate& gate = result.definition.gates[answer.gate];
    add_warning(test, answer);
    if (is_failure(answer.answer)) {
      if (test.kind != "error") test.kind = "failure";
      if (test.type.empty()) test.type = gate.metric;
      add_line(test, kind_of(gate) + ": " + answer.text);
    } else if (answer.answer == GateAnswer::known_deviation && test.kind.empty()) {
      test.kind = "skipped", add_line(test, "known deviation: " + answer.text);
    }
  }
  return test;
}

// A gate over several cells, or one that met none.
TestCase of_answer(const CaseResult& result, const GateResult& answer) {
  const Gate& gate = result.definition.gates[answer.gate];
  const std::string of = answer.engine.empty() ? "" : " " + answer.engine;
  TestCase test{fmt::format("gate {}{}", answer.gate + 1, of), result.definition.id, 0, "", "", "", "", ""};
  add_warning(test, answer);
  if (is_failure(answer.answer))
    test.kind = "failure", test.type = gate.metric, add_line(test, kind_of(gate) + ": " + answer.text);
  if (answer.answer == GateAnswer::known_deviation) test.kind = "skipped", add_line(test, answer.text);
  return test;
}

Suite suite_of(const Results& results, const CaseResult& result) {
  Suite suite{result.definition.id, {}};
  if (!result.error.empty())
    suite.cases.push_back({"truth", result.definition.id, 0, "error", "truth", result.error, result.error + "\n", ""});
  for (const Cell& cell : result.cells) suite.cases.push_back(of_cell(results, result, cell));
  for (const GateResult& answer : result.gates) {
    if (answer.dt.empty()) suite.cases.push_back(of_answer(result, answer));
  }
  return suite;
}

std::string xml_of(const TestCase& test) {
  std::string xml = fmt::format("    <testcase name=\"{}\" classname=\"{}\" time=\"{:.6f}\"", xml_escaped(test.name),
                                xml_escaped(test.classname), test.seconds);
  if (test.kind.empty() && test.warning.empty()) return xml + "/>\n";
  xml += ">\n";
  if (!test.kind.empty()) {
    xml += fmt::format("      <{} message=\"{}\"", test.kind, xml_escaped(test.message));
    if (test.kind != "skipped") xml += fmt::format(" type=\"{}\"", xml_escaped(test.type));
    xml += (test.kind == "skipped" ? "/>" : fmt::format(">{}</{}>", xml_escaped(test.text), test.kind)) + "\n";
  }
  if (!test.warning.empty()) xml += fmt::format("      <system-out>{}</system-out>\n", xml_escaped(test.warning));
  return xml + "    </testcase>\n";
}

std::string counts_of(long tests, long failures, long errors, long skipped, double seconds) {
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.6f}\"", tests, failures,
                     errors, skipped, seconds);
}

}  // namespace

std::string junit_report(const Results& results) {
  long tests = 0, failures = 0, errors = 0, skipped = 0;
  std::string suites;
  for (const CaseResult& result : results.cases) {
    const Suite suite = suite_of(results, result);
    const long all = static_cast<long>(suite.cases.size());
    tests += all, failures += suite.count("failure"), errors += suite.count("error");
    skipped += suite.count("skipped");
    suites += fmt::format(
        "  <testsuite name=\"{}\" {}>\n", xml_escaped(suite.name),
        counts_of(all, suite.count("failure"), suite.count("error"), suite.count("skipped"), suite.seconds()));
    for (const TestCase& test : suite.cases) suites += xml_of(test);
    suites += "  </testsuite>\n";
  }
  return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"rigor\" {}>\n{}</testsuites>\n",
                     counts_of(tests, failures, errors, skipped, results.wall_seconds), suites);
}

}  // namespace rigor::inline report
