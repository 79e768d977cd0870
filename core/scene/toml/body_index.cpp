#include "core/scene/toml/body_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline scene {
namespace {

int read_count(double number, const TomlValue& value) {
  if (!(number >= 1 && number <= kMostCopies) || number != std::floor(number))
    value.refuse(fmt::format("found {}; allowed: whole numbers from 1 to {:.0f}", number, kMostCopies));
  return static_cast<int>(number);
}

Vec3 read_spacing(const TomlValue& value) { return value.is_array() ? value.vector() : Vec3::Constant(value.number()); }

// Uniform from -1 to 1. Written by hand, because the standard's distributions differ between libraries.
double draw(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11) * 0x1p-52 - 1; }

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> first;
  for (const std::string& name : names) {
    if (first.size() < kMost) first.push_back(shown(name));
  }
  return listed(first) + (names.size() > kMost ? fmt::format(" and {} more", names.size() - kMost) : "");
}

template <typename Visit>
void for_each_copy(const BodyArray& array, const Visit& visit) {
  for (int k = 0; k < array.count[2]; ++k) {
    for (int j = 0; j < array.count[1]; ++j) {
      for (int i = 0; i < array.count[0]; ++i) visit(std::array<int, 3>{i, j, k});
    }
  }
}

}  // namespace

std::string BodyArray::name_of(const std::array<int, 3>& at) const {
  std::string name = body;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (count[axis] > 1 || copies() == 1) name += fmt::format("-{}", at[axis] + 1);
    if (copies() == 1) break;
  }
  return name;
}

const Keys& array_keys() {
  static const Keys keys = {"body", "count", "spacing", "jitter", "seed"};
  return keys;
}

BodyArray read_array(const TableReader& row) {
  BodyArray array;
  array.body = row.at("body").text();
  array.where = row.at("body").where();
  const TomlValue count = row.at("count");
  const std::vector<double> numbers = count.numbers({3});
  for (std::size_t axis = 0; axis < 3; ++axis) array.count[axis] = read_count(numbers[axis], count);
  const double copies = numbers[0] * numbers[1] * numbers[2];
  if (copies > kMostCopies) count.refuse(fmt::format("found {:.6g} copies; allowed: {:.0f}", copies, kMostCopies));
  array.spacing = read_spacing(row.at("spacing"));
  if (const auto jitter = row.find("jitter")) array.jitter = jitter->non_negative();
  if (const auto seed = row.find("seed")) {
    array.seed = seed->non_negative();
    if (array.seed != std::floor(array.seed) || array.seed > 0x1p53)
      seed->refuse(fmt::format("found {}; allowed: a whole number", array.seed));
  }
  return array;
}

Vec3 offset_of(const BodyArray& array, const std::array<int, 3>& at) {
  return {at[0] * array.spacing.x(), at[1] * array.spacing.y(), at[2] * array.spacing.z()};
}

std::vector<Body> copies_of(const Body& body, const BodyArray& array) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(array.seed));
  std::vector<Body> copies;
  copies.reserve(static_cast<std::size_t>(array.copies()));
  for_each_copy(array, [&](const std::array<int, 3>& at) {
    Body copy = body;
    copy.name = array.name_of(at);
    copy.position += offset_of(array, at);
    for (int axis = 0; axis < 3; ++axis) copy.position[axis] += array.jitter * draw(engine);
    copies.push_back(std::move(copy));
  });
  return copies;
}

void BodyIndex::add(const std::string& name, int index, const std::string& where) {
  const auto [known, is_new] = index_.try_emplace(name, index, where);
  if (is_new) return;
  throw InputError(
      fmt::format("{}: scene.body.name: there is already a body '{}', at {}; allowed: a name that no other body has",
                  where, shown(name), known->second.second));
}

void BodyIndex::add_array(BodyArray array, const TomlValue& name) {
  const auto [known, is_new] = arrays_.try_emplace(array.body, array);
  if (is_new) return;
  name.refuse(fmt::format("there is already an array of '{}', at {}; allowed: one of each body", shown(array.body),
                          known->second.where));
}

BodyArray* BodyIndex::find_array(const std::string& body) {
  const auto found = arrays_.find(body);
  return found == arrays_.end() ? nullptr : &found->second;
}

void BodyIndex::check_arrays_are_used() const {
  for (const auto& [name, array] : arrays_) {
    if (array.first != kWorld) continue;
    throw InputError(fmt::format("{}: scene.array.body: there is no body '{}'{}; there is: {}", array.where,
                                 shown(name), did_you_mean(name, known(false)), some_of(known(false))));
  }
}

BodyIndex::End BodyIndex::find_end(const TomlValue& value) const {
  const std::string name = value.text();
  End end;
  std::string of_array = name;
  if (!index_.contains(name) && name.size() > 2 && name[name.size() - 2] == '+') {
    const std::size_t axis = std::string("xyz").find(name.back());
    if (axis != std::string::npos && arrays_.contains(name.substr(0, name.size() - 2))) {
      of_array = name.substr(0, name.size() - 2);
      end.step[axis] = 1;
      if (arrays_.at(of_array).count[axis] < 2)
        value.refuse(
            fmt::format("the array of '{}' has one body along {}, which has no next", shown(of_array), name.back()));
    }
  }
  const auto array = arrays_.find(of_array);
  if (array != arrays_.end()) {
    end.array = &array->second;
  } else {
    end.body = find(value, true);
  }
  return end;
}

std::vector<Ends> BodyIndex::ends(const TomlValue& a, const TomlValue& b) const {
  const End end_a = find_end(a), end_b = find_end(b);
  if (!end_a.array && !end_b.array) return {{.a = end_a.body, .b = end_b.body}};
  if (end_a.array && end_b.array && end_a.array != end_b.array) {
    b.refuse(fmt::format("'{}' and '{}' are two arrays; allowed: ends in one array, or one that is a single body",
                         shown(end_a.array->body), shown(end_b.array->body)));
  }
  const BodyArray& array = *(end_a.array ? end_a.array : end_b.array);
  if (end_a.array && end_b.array && end_a.step == end_b.step) {
    b.refuse(
        fmt::format("from each body of the array '{0}' to itself it does nothing; allowed: '{0}+x', '{0}+y' or "
                    "'{0}+z' for the next one",
                    shown(array.body)));
  }
  std::vector<Ends> all;
  for_each_copy(array, [&](const std::array<int, 3>& at) {
    const auto index = [&](const End& end) {
      if (!end.array) return end.body;
      const int i = at[0] + end.step[0], j = at[1] + end.step[1], k = at[2] + end.step[2];
      if (i >= array.count[0] || j >= array.count[1] || k >= array.count[2]) return kWorld - 1;  // there is no next
      return array.first + i + array.count[0] * (j + array.count[1] * k);
    };
    const Ends ends{index(end_a), index(end_b), offset_of(array, at), array.name_of(at).substr(array.body.size())};
    if (ends.a >= kWorld && ends.b >= kWorld) all.push_back(ends);
  });
  return all;
}

int BodyIndex::find(const TomlValue& value, bool world_allowed) const {
  const std::string name = value.text();
  if (name == "world") {
    if (world_allowed) return kWorld;
    value.refuse("found 'world', which is no body; allowed: a body's name");
  }
  const auto found = index_.find(name);
  if (found != index_.end()) return found->second.first;
  if (const auto array = arrays_.find(name); array != arrays_.end()) {
    value.refuse(fmt::format("'{}' is an array of {} bodies; allowed: one of them, '{}' say", shown(name),
                             array->second.copies(), shown(array->second.name_of({0, 0, 0}))));
  }
  value.refuse(fmt::format("there is no body '{}'{}; there is: {}", shown(name),
                           did_you_mean(name, known(world_allowed)), some_of(known(world_allowed))));
}

std::vector<std::string> BodyIndex::known(bool world_allowed) const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : index_) names.push_back(name);
  std::sort(names.begin(), names.end());
  if (world_allowed) names.push_back("world");
  return names;
}

}  // namespace rigor::inline scene
