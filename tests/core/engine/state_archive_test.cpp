#include "core/engine/state_archive.h"

#include <boost/test/unit_test.hpp>
#include <limits>

#include "core/base/error.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_engine_state_archive)

namespace {

enum class Kind { one, two };

struct Part {
  int count = 0;
  std::string name;
  void archive_state(StateArchive& archive) { archive(count, name); }
};

// One of each kind of value.
struct All {
  bool flag = false;
  Kind kind = Kind::one;
  long number = 0;
  double real = 0;
  std::string text;
  std::vector<double> reals;
  std::vector<bool> flags;
  std::vector<Part> parts;
  std::array<float, 3> floats{};
  std::optional<Part> perhaps;
  std::pair<int, double> both;
  Vec3 vector = Vec3::Zero();
  Quat turn = Quat::Identity();
  Eigen::VectorXd any;
  BodyTable bodies;
  Clock clock;

  void archive_state(StateArchive& archive) {
    archive(flag, kind, number, real, text, reals, flags, parts, floats, perhaps, both, vector, turn, any, bodies,
            clock);
  }
};

All filled() {
  All all;
  all.flag = true, all.kind = Kind::two, all.number = -7, all.real = std::numeric_limits<double>::denorm_min();
  all.text = "a text", all.reals = {1, 2.5, -0.0}, all.flags = {true, false, true};
  all.parts = {{3, "x"}, {4, ""}}, all.floats = {1, 2, 3}, all.perhaps = Part{5, "there"}, all.both = {8, 0.1};
  all.vector = {1, 2, 3}, all.turn = Quat(0.1, 0.2, 0.3, 0.4), all.any.setLinSpaced(5, 0, 1);
  all.bodies.resize(2, true);
  for (int c = 0; c < kRotation + 9; ++c)
    for (std::size_t i = 0; i < 2; ++i) all.bodies.columns().column(c)[i] = c + 0.5 * static_cast<double>(i);
  all.clock.advance(0.1), all.clock.advance(0.1);
  return all;
}

std::string bytes_of(All all) {
  StateArchive archive;
  archive(all);
  return archive.bytes();
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_kind_of_value_comes_back) {
  const std::string bytes = bytes_of(filled());
  All back;
  StateArchive archive(bytes);
  BOOST_TEST(archive.restores());
  archive(back);
  archive.end();
  BOOST_TEST(bytes_of(back) == bytes);
  BOOST_TEST(back.text == "a text");
  BOOST_TEST(back.perhaps->name == "there");
  BOOST_TEST(back.flags[2]);
  BOOST_TEST(back.turn.w() == 0.1);
  BOOST_TEST(back.bodies.columns().column(kRotation + 8)[1] == static_cast<int>(kRotation) + 8.5);
  BOOST_TEST(back.clock.time() == 0.2);
}

BOOST_AUTO_TEST_CASE(a_state_that_is_cut_anywhere_is_refused) {
  const std::string bytes = bytes_of(filled());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    All back;
    const std::string cut = bytes.substr(0, length);
    StateArchive archive(cut);
    BOOST_CHECK_THROW(archive(back), InputError);
  }
  All back;
  const std::string longer = bytes + "x";
  StateArchive archive(longer);
  archive(back);
  BOOST_CHECK_THROW(archive.end(), InputError);
}

// No list is made longer than the bytes can fill.
BOOST_AUTO_TEST_CASE(damaged_lengths_ask_for_no_memory) {
  const std::string huge(8, '\x7f');
  std::vector<double> list;
  StateArchive of_list(huge);
  BOOST_CHECK_THROW(of_list(list), InputError);
  const std::string huge_matrix(16, '\x7f');
  Eigen::MatrixXd matrix;
  StateArchive of_matrix(huge_matrix);
  BOOST_CHECK_THROW(of_matrix(matrix), InputError);
  BodyTable table;
  const std::string huge_table = huge + std::string(1, '\0');
  StateArchive of_table(huge_table);
  BOOST_CHECK_THROW(of_table(table), InputError);
}

BOOST_AUTO_TEST_CASE(lists_of_the_scene_keep_their_length) {
  StateArchive saved;
  std::vector<Part> two(2), three(3);
  saved.each(two, [&](Part& part) { saved(part); });
  StateArchive archive(saved.bytes());
  BOOST_CHECK_THROW(archive.each(three, [&](Part& part) { archive(part); }), InputError);
}

BOOST_AUTO_TEST_CASE(a_pointer_comes_back_as_a_place) {
  const std::vector<int> own = {1, 2, 3}, other = {4, 5, 6}, shorter = {7};
  for (const int* pointer : {static_cast<const int*>(nullptr), &own[2]}) {
    StateArchive saved;
    saved.place_in(own, pointer);
    const int* back = &other[0];
    StateArchive archive(saved.bytes());
    archive.place_in(other, back);
    BOOST_TEST((back == (pointer ? &other[2] : nullptr)));
    if (!pointer) continue;
    StateArchive again(saved.bytes());
    BOOST_CHECK_THROW(again.place_in(shorter, back), InputError);
  }
}

BOOST_AUTO_TEST_SUITE_END()
