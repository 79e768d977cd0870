#include "core/scene/toml/table_reader.h"

#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_toml_table_reader)

namespace {

const Keys kKeys = {"flag", "friction", "mass", "name", "position", "rows", "share", "table", "unit"};

struct Row {
  Refusal refusal;
  void (*read)(const TableReader& root);
};

void read_mass(const TableReader& t) { t.at("mass").number(); }
void read_positive(const TableReader& t) { t.at("mass").positive(); }
void read_non_negative(const TableReader& t) { t.at("mass").non_negative(); }
void read_friction(const TableReader& t) { t.at("friction").non_negative_or_infinite(); }
void read_share(const TableReader& t) { t.at("share").fraction_of_one(); }
void read_flag(const TableReader& t) { t.at("flag").flag(); }
void read_name(const TableReader& t) { t.at("name").text(); }
void read_unit(const TableReader& t) { t.at("unit").choice({"metre", "second"}); }
void read_position(const TableReader& t) { t.at("position").vector(); }
void read_direction(const TableReader& t) { t.at("position").direction(); }
void read_six(const TableReader& t) { t.at("position").numbers({3, 6}); }
void read_items(const TableReader& t) { t.at("position").items(); }
void read_table(const TableReader& t) { t.at("table").table({"x"}).at("x").number(); }
void read_rows(const TableReader& t) {
  for (const TableReader& row : t.at("rows").tables({"x"})) row.at("x").number();
}
void read_narrowed(const TableReader& t) {
  TableReader table = t.at("table").table({"type", "radius", "size"});
  table.narrow({"type", "radius"}, "a sphere");
}

const std::vector<Row> kRows = {
    // Keys.
    {{"mas = 1", "1:1: mas: unknown key", {"did you mean 'mass'?", "allowed: flag, friction"}}, read_mass},
    {{"mass = 1\n  zzz = 1\n aaa = 2", "2:3: zzz: unknown key; allowed", {}}, read_mass},
    {{"\"a\\u0007b\" = 1", "1:1: a\\u0007b: unknown key", {}}, read_mass},
    {{"", "1:1: mass: missing", {}}, read_mass},
    {{"[table]\n", "1:1: table.x: missing", {}}, read_table},
    {{"table = { x = 1, y = 2 }", "1:18: table.y: unknown key", {"did you mean 'x'?"}}, read_table},
    {{"[[rows]]\nx = 1\n\n[[rows]]\n", "4:1: rows.x: missing", {}}, read_rows},
    {{"table = { type = 1, size = 2 }", "1:21: table.size: a sphere has no such key", {"allowed: type, radius"}},
     read_narrowed},
    // Types.
    {{"mass = 'ten'", "1:8: mass: ", {"found a string, 'ten'", "a finite number"}}, read_mass},
    {{"mass = true", "1:8: mass: ", {"found a boolean, true"}}, read_mass},
    {{"mass = [1]", "1:8: mass: ", {"found an array of 1 value"}}, read_mass},
    {{"mass = {}", "1:8: mass: ", {"found a table"}}, read_mass},
    {{"mass = 1979-05-27", "1:8: mass: ", {"found a date"}}, read_mass},
    {{"flag = 'yes'", "1:8: flag: ", {"found a string, 'yes'", "true or false"}}, read_flag},
    {{"flag = 1", "1:8: flag: ", {"found 1", "true or false"}}, read_flag},
    {{"name = 3", "1:8: name: ", {"found 3", "a string"}}, read_name},
    {{"table = 3", "1:9: table: ", {"found 3", "a table with the keys x"}}, read_table},
    {{"[rows]\nx = 1", "1:1: rows: ", {"found a table", "[[rows]]"}}, read_rows},
    {{"rows = [{ x = 1 }, 2]", "1:20: rows: ", {"found 2", "a table with the keys x"}}, read_rows},
    {{"position = 1", "1:12: position: ", {"found 1", "an array of 3 numbers"}}, read_position},
    {{"position = [0, 'x', 0]", "1:16: position[1]: ", {"found a string, 'x'"}}, read_position},
    // Numbers.
    {{"mass = nan", "1:8: mass: ", {"found nan", "a finite number"}}, read_mass},
    {{"mass = -inf", "1:8: mass: ", {"found -inf", "a finite number"}}, read_mass},
    {{"mass = 0", "1:8: mass: ", {"found 0", "greater than 0"}}, read_positive},
    {{"mass = inf", "1:8: mass: ", {"found inf", "greater than 0"}}, read_positive},
    {{"mass = nan", "1:8: mass: ", {"found nan", "greater than 0"}}, read_positive},
    {{"mass = -1.5", "1:8: mass: ", {"found -1.5", "0 or greater"}}, read_non_negative},
    {{"mass = nan", "1:8: mass: ", {"found nan", "0 or greater"}}, read_non_negative},
    {{"friction = -0.1", "1:12: friction: ", {"found -0.1", "or inf"}}, read_friction},
    {{"friction = nan", "1:12: friction: ", {"found nan", "or inf"}}, read_friction},
    {{"friction = 'infinit'", "1:12: friction: ", {"found a string, 'infinit'", "or inf"}}, read_friction},
    {{"share = 1.01", "1:9: share: ", {"found 1.01", "from 0 to 1"}}, read_share},
    {{"share = nan", "1:9: share: ", {"found nan", "from 0 to 1"}}, read_share},
    // Vectors.
    {{"position = [0, 1]", "1:12: position: ", {"found an array of 2 values", "an array of 3 numbers"}}, read_position},
    {{"position = [0, 1, 2, 3]", "1:12: position: ", {"found an array of 4 values", "3 or 6 numbers"}}, read_six},
    {{"position = [0, inf, 0]", "1:16: position[1]: ", {"found inf", "a finite number"}}, read_position},
    {{"position = [0, 0.0, 0]", "1:12: position: ", {"points nowhere"}}, read_direction},
    {{"position = []", "1:12: position: ", {"found an empty array"}}, read_items},
    // Words.
    {{"name = ''", "1:8: name: ", {"found an empty string"}}, read_name},
    {{"name = \"a\\nb\"", "1:8: name: ", {"control character", "'a\\u000ab'"}}, read_name},
    {{"name = \"a\\u0085b\"", "1:8: name: ", {"control character", "'a\\u0085b'"}}, read_name},
    {{"name = '" + std::string(kLongestText + 1, 'x') + "'", "1:8: name: ", {"4097 bytes", "at most 4096"}}, read_name},
    {{"unit = 'meter'", "1:8: unit: ", {"found 'meter'", "did you mean 'metre'?", "allowed: metre, second"}},
     read_unit},
    {{"unit = 1", "1:8: unit: ", {"found 1", "metre, second"}}, read_unit},
};

TableReader root_of(const TomlFile& file) { return file.root(kKeys); }

}  // namespace

BOOST_AUTO_TEST_CASE(each_bad_value_is_refused_with_its_place_and_what_is_allowed) {
  for (const Row& row : kRows) {
    check_refusal(row.refusal, "f.toml", [&] {
      const TomlFile file = TomlFile::parse(row.refusal.text, "f.toml");
      row.read(root_of(file));
    });
  }
}

BOOST_AUTO_TEST_CASE(each_good_value_is_read_as_it_stands) {
  const TomlFile file = TomlFile::parse(
      "mass = 9007199254740993\nfriction = inf\nshare = 1\nflag = true\nname = 'é, \"quoted\"'\nposition = [3e200, 0, "
      "4e200]\n"
      "unit = 'second'\nrows = []\ntable = { x = 2.5 }",
      "f.toml");
  const TableReader root = root_of(file);
  BOOST_TEST(root.at("mass").number() == 9007199254740992.0);  // the nearest double
  BOOST_TEST(root.at("friction").non_negative_or_infinite() == std::numeric_limits<double>::infinity());
  BOOST_TEST(root.at("share").fraction_of_one() == 1);
  BOOST_TEST(root.at("flag").flag());
  BOOST_TEST(root.at("name").text() == "é, \"quoted\"");
  BOOST_TEST((root.at("position").vector() == Vec3(3e200, 0, 4e200)));
  // A length whose square is no number any more; the division rounds once.
  BOOST_TEST((root.at("position").direction() - Vec3(0.6, 0, 0.8)).norm() < 4e-16);
  BOOST_TEST(root.at("unit").choice({"metre", "second"}) == "second");
  BOOST_TEST(root.at("rows").tables({"x"}).empty());
  BOOST_TEST(root.at("table").table({"x"}).at("x").number() == 2.5);
}

BOOST_AUTO_TEST_CASE(a_direction_is_a_unit_vector_whatever_its_length) {
  for (const char* length : {"5e-324", "1e-300", "1", "1.7e308"}) {
    const TomlFile file = TomlFile::parse(fmt::format("position = [{0}, -{0}, {0}]", length), "f.toml");
    // A division, a norm and a division: a few roundings.
    BOOST_TEST((root_of(file).at("position").direction() - Vec3(1, -1, 1) / std::sqrt(3)).norm() < 1e-15, length);
  }
}

BOOST_AUTO_TEST_CASE(infinite_friction_may_be_a_word) {
  const TomlFile file = TomlFile::parse("friction = 'infinite'", "f.toml");
  BOOST_TEST(root_of(file).at("friction").non_negative_or_infinite() == std::numeric_limits<double>::infinity());
}

BOOST_AUTO_TEST_CASE(columns_count_characters_and_not_bytes) {
  check_refusal({"table = { \"é\" = 1 }", "1:11: table.é: unknown key", {}}, "f.toml", [] {
    const TomlFile file = TomlFile::parse("table = { \"é\" = 1 }", "f.toml");
    read_table(root_of(file));
  });
}

BOOST_AUTO_TEST_CASE(a_text_that_is_not_toml_is_refused_with_its_place) {
  const std::vector<Refusal> rows = {
      {"[&", "1:2: is not TOML: ", {"'&'"}},
      {"&", "1:1: is not TOML: ", {"'&'"}},
      {"mass = 1\nmass = 2", "2:8: is not TOML: ", {"cannot redefine"}},
      {"mass = 1e400", "1:13: is not TOML: ", {"1e400"}},
      {"mass = 99999999999999999999", "1:28: is not TOML: ", {"not representable"}},
      {std::string("mass = 1\0", 9), "1:9: is not TOML: ", {}},
      {std::string("mass = 1\n\0\0", 11), "2:1: is not TOML: ", {}},
      {"name = \"\xff\xfe\"", "1:8: is not TOML: ", {"utf-8"}},
      {"name = \"\xc3", "1:8: is not TOML: ", {"utf-8"}},
      {"name = \"\xed\xa0\x80\"", "1:8: is not TOML: ", {"utf-8"}},
      {std::string("\xff\xfe[\0", 4), "1:1: is not TOML: ", {"utf-8"}},
      {"mass = 1\nname = 'cut sho", "2:16: is not TOML: ", {"end-of-file"}},
      {"table = { x = [1, 2", "1:20: is not TOML: ", {"end-of-file"}},
      {"[[rows", "1:7: is not TOML: ", {"end-of-file"}},
      {"x = " + std::string(1'000'000, '['), "1:", {"is not TOML", "nested"}},
      {"x = " + std::string(1'000'000, '9'), "1:", {"is not TOML"}},
  };
  for (const Refusal& row : rows) check_refusal(row, "f.toml", [&] { TomlFile::parse(row.text, "f.toml"); });
}

// The library itself nests as many tables as such a key has parts, and overflows the stack when it gives them back.
BOOST_AUTO_TEST_CASE(a_key_of_a_million_parts_is_refused) {
  std::string deep = "a";
  for (int i = 0; i < 1'000'000; ++i) deep += ".a";
  const std::vector<Refusal> rows = {
      {deep + " = 1", "1:64: found a key of more than 32 parts", {}},
      {"title = 'a.b'\n[" + deep + "]", "2:65: found a key", {}},
      {"x = [\"\"\"a ' # \\\"\"\"\"\", { " + deep + " = 1 }]", "1:88: found a key", {}},
      {"x = '''\n\"\n''''' # '\n" + deep + " = 1", "4:64: found a key", {}},
  };
  for (const Refusal& row : rows) check_refusal(row, "f.toml", [&] { TomlFile::parse(row.text, "f.toml"); });
}

// The library's behaviour is undefined for these: it looks up missing entries, or assumes a key.
BOOST_AUTO_TEST_CASE(what_the_library_has_no_answer_for_is_refused_with_its_place) {
  const std::string name_begins = "where the name of a table begins", not_ascii = "that is not ASCII";
  const std::string outside = "is not TOML: found a character outside of strings";
  const std::vector<Refusal> rows = {
      {"[ #", "1:3: is not TOML: found '#' " + name_begins, {}},
      {"x = 1\n  [[\t=]]", "2:6: is not TOML: found '=' " + name_begins, {}},
      {"[[[a]]]", "1:3: is not TOML: found '[' " + name_begins, {}},
      {"[[ [a]]]", "1:4: is not TOML: found '[' " + name_begins, {}},
      {"[\n]", "1:2: is not TOML: found a character that no name has " + name_begins, {}},
      {"x = [1,\n[2]]\n[.a]", "3:2: is not TOML: found '.' " + name_begins, {}},
      {"[é]", "1:2: is not TOML: found ", {name_begins}},
      {"é = 1", "1:1: " + outside, {not_ascii}},
      {"x = 1 あ", "1:7: " + outside, {not_ascii}},
      {"x = 1\u00a0", "1:6: " + outside, {not_ascii}},
      {"x = ['é', é]", "1:11: " + outside, {not_ascii}},
      {"x = \"\"\"\\é\"\"\"", "1:9: is not TOML: found a backslash before a character", {not_ascii}},
      {"x = \"\"\"a\\\n é\"\"\"", "2:2: found a character " + not_ascii + " right behind a line's end", {}},
  };
  for (const Refusal& row : rows) check_refusal(row, "f.toml", [&] { TomlFile::parse(row.text, "f.toml"); });
}

BOOST_AUTO_TEST_CASE(characters_of_any_script_may_stand_in_strings_and_comments) {
  const TomlFile file = TomlFile::parse(
      "\xef\xbb\xbf# é [ あ\nname = \"é \\u00e9 \\\\あ\" # é\nunit = 'é\\é'\nshare = '''\né'''\n"
      "table . \"é\" = [\n [ 1 ] ]\n [ rows . \"é\" ]",
      "f.toml");
  BOOST_TEST(root_of(file).at("name").text() == "é é \\あ");
  BOOST_TEST(root_of(file).at("unit").text() == "é\\é");
}

BOOST_AUTO_TEST_CASE(dots_outside_of_keys_are_no_parts_of_one) {
  const std::string dots(100, '.');
  const std::string text = "# " + dots + "\nname = '" + dots + "'\nposition = [" + std::string(49, ' ') +
                           "1.5, 2.5, 3.5]\n" + "unit = \"\"\"" + dots + "\\\"\\\\\"\"\"";
  const TomlFile file = TomlFile::parse(text, "f.toml");
  BOOST_TEST(root_of(file).at("name").text() == dots);
  BOOST_TEST(root_of(file).at("unit").text() == dots + "\"\\");
}

BOOST_AUTO_TEST_CASE(nothing_that_is_cut_anywhere_crashes) {
  const std::string text = "[scene]\nx = [1.5, 'é', \"\"\"a\n\"\"\"]\n[[scene.y]]\nz.w = { a = 1e3, b = 1979-05-27 }\n";
  int refused = 0;
  for (std::size_t length = 0; length <= text.size(); ++length) {
    refused += !refusal_of([&] { TomlFile::parse(text.substr(0, length), "f.toml"); }).empty();
  }
  BOOST_TEST(refused > 0);
  BOOST_TEST(refused < static_cast<int>(text.size()));
}

BOOST_AUTO_TEST_CASE(what_a_message_shows_is_short_and_printable) {
  BOOST_TEST(shown("plain") == "plain");
  BOOST_TEST(shown("\x1b[31m") == "\\u001b[31m");
  BOOST_TEST(shown(std::string(100, 'x')) == std::string(80, 'x') + "...");
  BOOST_TEST(shown("aé", 2) == "a...");
}

BOOST_AUTO_TEST_SUITE_END()
