#include "core/scene/toml/writing/value_writer.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/toml/table_reader.h"
#include "core/scene/toml/text_offset.h"

namespace rigor::inline scene {
namespace {

struct Step {
  std::string word;  // a key, or a row's name
  bool is_index = false;
  std::size_t index = 0;
};

[[noreturn]] void refuse_form(const std::string& path) {
  throw InputError(
      fmt::format("'{}': found no path of a scene's value; allowed: as scene.gravity[1], "
                  "scene.spring[0].stiffness, scene.body.cube.mass or scene.contact_default.friction",
                  shown(path)));
}

// "body[1].mass" in three steps.
std::vector<Step> steps_of(const std::string& path) {
  std::vector<Step> steps;
  for (std::size_t at = 0; at < path.size();) {
    if (path[at] == '[') {
      const std::size_t end = std::min(path.find(']', at), path.size());
      Step step{"", true};
      const auto [last, error] = std::from_chars(path.data() + at + 1, path.data() + end, step.index);
      if (end == path.size() || error != std::errc() || last != path.data() + end) refuse_form(path);
      steps.push_back(step);
      at = end + 1;
      if (at < path.size() && path[at] != '.' && path[at] != '[') refuse_form(path);
    } else {
      const std::size_t begin = at + (path[at] == '.'), end = std::min(path.find_first_of(".[", begin), path.size());
      if (begin == end) refuse_form(path);
      steps.push_back({path.substr(begin, end - begin)});
      at = end;
    }
  }
  if (steps.size() < 2 || steps.front().word != "scene") refuse_form(path);
  return steps;
}

struct Edit {
  std::size_t begin, end;
  std::string text;
};

class PathWalk {
 public:
  PathWalk(const std::string& text, const std::string& path) : text_(text), path_(path), steps_(steps_of(path)) {}

  Edit edit(const std::string& value) {
    const toml::table root = toml::parse(text_);
    const toml::node* node = &root;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const bool is_last = i + 1 == steps_.size();
      const toml::node* next = node->is_table()   ? in_table(*node->as_table(), steps_[i], is_last)
                               : node->is_array() ? in_array(*node->as_array(), steps_[i])
                                                  : nullptr;
      if (next == nullptr && is_last && node->is_table()) return added(*node->as_table(), steps_[i].word, value);
      if (next == nullptr && is_new_law(i)) return new_law(value);
      if (next == nullptr) refuse("leads no further than a single value");
      node = next;
      walked_ +=
          steps_[i].is_index ? fmt::format("[{}]", steps_[i].index) : (walked_.empty() ? "" : ".") + steps_[i].word;
    }
    const bool is_cubes = is_list_of_a_cube(node);
    if (!is_cubes && (node->is_table() || node->is_array()))
      refuse("is no single value; give the path of a number in it");
    return {offset(node->source().begin), offset(node->source().end), is_cubes ? three_times(value) : value};
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(fmt::format("'{}': {} {}", shown(path_), walked_.empty() ? "the file" : shown(walked_), why));
  }

  // The three equal moments or edges of a cube, which stay equal. Vectors of three equal numbers are no such list.
  bool is_list_of_a_cube(const toml::node* node) const {
    const std::string& key = steps_.back().word;
    const toml::array* list = node->as_array();
    if ((key != "inertia" && key != "size") || !list || list->size() != 3) return false;
    const auto first = list->get(0)->value<double>();
    return first && std::all_of(list->begin(), list->end(),
                                [&](const toml::node& one) { return one.is_number() && one.value<double>() == first; });
  }
  static std::string three_times(const std::string& value) { return fmt::format("[{0}, {0}, {0}]", value); }

  // The one table that a scene does without where all of it is 0.
  bool is_new_law(std::size_t at) const {
    return at == 1 && steps_.size() == 3 && steps_[1].word == "contact_default" && !steps_[2].is_index;
  }
  Edit new_law(const std::string& value) const {
    return {text_.size(), text_.size(), fmt::format("\n[scene.contact_default]\n{} = {}\n", steps_[2].word, value)};
  }

  const toml::node* in_table(const toml::table& table, const Step& step, bool is_last) const {
    if (step.is_index) refuse("is one table, and no array of them");
    const toml::node* found = table.get(step.word);
    if (found || is_last) return found;
    std::vector<std::string> known;
    for (const auto& [key, value] : table) known.emplace_back(key.str());
    if (walked_ == "scene") known.push_back("contact_default");
    if (walked_ == "scene" && step.word == "contact_default") return nullptr;
    refuse(fmt::format("has no '{}'{}; it has: {}", shown(step.word), did_you_mean(step.word, known), listed(known)));
  }

  const toml::node* in_array(const toml::array& array, const Step& step) const {
    if (step.is_index) {
      if (step.index < array.size()) return array.get(step.index);
      refuse(fmt::format("has no number {}; it has {}, counted from 0", step.index, array.size()));
    }
    std::vector<std::string> names;
    for (const toml::node& row : array) {
      const auto name = row.is_table() ? row.as_table()->get_as<std::string>("name") : nullptr;
      if (name && name->get() == step.word) return &row;
      if (name) names.push_back(name->get());
    }
    if (names.empty())
      refuse(fmt::format("has no '{}', for its rows have no names; give their number, as {}[0]", shown(step.word),
                         shown(walked_)));
    refuse(fmt::format("has no '{}'{}; it has: {}", shown(step.word), did_you_mean(step.word, names), listed(names)));
  }

  // Behind the line that begins the table, or behind the brace of one in a line.
  Edit added(const toml::table& table, const std::string& key, const std::string& value) const {
    const std::size_t begin = offset(table.source().begin);
    if (table.is_inline() && begin < text_.size() && text_[begin] == '{')
      return {begin + 1, begin + 1, fmt::format("{} = {}{}", key, value, table.empty() ? "" : ", ")};
    if (table.source().begin.line == 0 || begin >= text_.size() || text_[begin] != '[')
      refuse(fmt::format("has no '{}', and no header that it could be written behind; write it in the file", key));
    const std::size_t end = std::min(text_.find('\n', begin), text_.size());
    return {end, end, fmt::format("\n{} = {}", key, value)};
  }

  std::size_t offset(const toml::source_position& place) const { return offset_of(text_, place.line, place.column); }

  const std::string& text_;
  const std::string& path_;
  std::vector<Step> steps_;
  std::string walked_;  // so far
};

}  // namespace

std::string with_value(const std::string& text, const std::string& path, const std::string& value) {
  const Edit edit = PathWalk(text, path).edit(value);
  std::string changed = text;
  return changed.replace(edit.begin, edit.end - edit.begin, edit.text);
}

}  // namespace rigor::inline scene
