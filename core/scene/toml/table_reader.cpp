#include "core/scene/toml/table_reader.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/base/unit_vector.h"
#include "core/scene/toml/file_reader.h"
#include "core/scene/toml/library_limits.h"
#include "core/scene/toml/text_offset.h"

namespace rigor::inline scene {

struct TomlDocument {
  std::string path;
  std::string text;
  toml::table root;
};

namespace {

std::string place(const std::string& path, const toml::source_position& position) {
  return fmt::format("{}:{}:{}", path, std::max<unsigned>(position.line, 1), std::max<unsigned>(position.column, 1));
}

std::string described(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("a string, '{}'", shown(text->get()));
  if (const auto* whole = node.as_integer()) return fmt::format("{}", whole->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return fmt::format("a boolean, {}", flag->get());
  if (const auto* array = node.as_array()) {
    return fmt::format("an array of {} {}", array->size(), array->size() == 1 ? "value" : "values");
  }
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::optional<double> number_in(const toml::node& node) {
  if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
  if (const auto* number = node.as_floating_point()) return number->get();
  return std::nullopt;
}

// C0, DEL and, in UTF-8, C1.
bool is_control(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  return byte(at) < 0x20 || byte(at) == 0x7f || (byte(at) == 0xc2 && byte(at + 1) >= 0x80 && byte(at + 1) < 0xa0);
}

bool has_control(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_control(text, i)) return true;
  }
  return false;
}

std::string counts_listed(std::initializer_list<std::size_t> counts) {
  std::string words;
  for (const std::size_t count : counts) words += fmt::format("{}{}", words.empty() ? "" : " or ", count);
  return words;
}

}  // namespace

std::string shown(std::string_view text, std::size_t longest) {
  std::size_t end = std::min(text.size(), longest);
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  std::string out;
  for (std::size_t i = 0; i < end; ++i) {
    if (!is_control(text, i)) {
      out += text[i];
      continue;
    }
    const bool of_two_bytes = static_cast<unsigned char>(text[i]) == 0xc2;
    out += fmt::format("\\u{:04x}", static_cast<unsigned char>(text[of_two_bytes ? ++i : i]));
  }
  return end < text.size() ? out + "..." : out;
}

const std::string& TomlValue::path() const { return document_->path; }
std::string TomlValue::where() const { return place(document_->path, node_->source().begin); }

TextRange TomlValue::range() const {
  const auto offset = [&](const toml::source_position& at) { return offset_of(document_->text, at.line, at.column); };
  return {offset(node_->source().begin), offset(node_->source().end)};
}

std::string TomlValue::label() const { return name_.empty() ? where() : fmt::format("{}: {}", where(), name_); }

void TomlValue::refuse(const std::string& fault) const { throw InputError(fmt::format("{}: {}", label(), fault)); }

void TomlValue::refuse_found(const std::string& allowed) const {
  refuse(fmt::format("found {}; allowed: {}", described(*node_), allowed));
}

bool TomlValue::is_text() const { return node_->is_string(); }
bool TomlValue::is_array() const { return node_->is_array(); }

double TomlValue::number() const {
  const auto value = number_in(*node_);
  if (!value || !std::isfinite(*value)) refuse_found("a finite number");
  return *value;
}

double TomlValue::positive() const {
  const auto value = number_in(*node_);
  if (!value || !std::isfinite(*value) || *value <= 0) refuse_found("a finite number greater than 0");
  return *value;
}

double TomlValue::non_negative() const {
  const auto value = number_in(*node_);
  if (!value || !std::isfinite(*value) || *value < 0) refuse_found("a finite number, 0 or greater");
  return *value;
}

double TomlValue::non_negative_or_infinite() const {
  if (const auto* text = node_->as_string(); text && text->get() == "infinite") return HUGE_VAL;
  const auto value = number_in(*node_);
  if (!value || std::isnan(*value) || *value < 0) refuse_found("a number, 0 or greater, or inf");
  return *value;
}

double TomlValue::fraction_of_one() const {
  const auto value = number_in(*node_);
  if (!value || !(*value >= 0 && *value <= 1)) refuse_found("a number from 0 to 1");
  return *value;
}

bool TomlValue::flag() const {
  if (!node_->is_boolean()) refuse_found("true or false");
  return node_->as_boolean()->get();
}

std::vector<double> TomlValue::numbers(std::initializer_list<std::size_t> counts) const {
  const auto* array = node_->as_array();
  if (!array || std::find(counts.begin(), counts.end(), array->size()) == counts.end()) {
    refuse_found(fmt::format("an array of {} numbers", counts_listed(counts)));
  }
  std::vector<double> values;
  for (const toml::node& item : *array) {
    const auto value = number_in(item);
    if (!value || !std::isfinite(*value)) items()[values.size()].refuse_found("a finite number");
    values.push_back(*value);
  }
  return values;
}

Vec3 TomlValue::vector() const {
  const auto values = numbers({3});
  return {values[0], values[1], values[2]};
}

Vec3 TomlValue::direction() const {
  const auto unit = unit_vector(vector());
  if (!unit) refuse("found [0, 0, 0], which points nowhere; allowed: a vector of any other length");
  return *unit;
}

std::string TomlValue::text() const {
  const auto* value = node_->as_string();
  if (!value) refuse_found("a string");
  const std::string& text = value->get();
  if (text.empty()) refuse("found an empty string; allowed: a string of at least one character");
  if (text.size() > kLongestText) {
    refuse(fmt::format("found a string of {} bytes; allowed: at most {}", text.size(), kLongestText));
  }
  if (has_control(text)) {
    refuse(fmt::format("found a control character in '{}'; allowed: a string on one line, without any", shown(text)));
  }
  return text;
}

std::string TomlValue::choice(const Keys& known) const {
  if (!is_text()) refuse_found(fmt::format("one of the strings {}", listed(known)));
  const std::string word = text();
  if (std::find(known.begin(), known.end(), word) != known.end()) return word;
  refuse(fmt::format("found '{}'{}; allowed: {}", shown(word), did_you_mean(word, known), listed(known)));
}

std::vector<TomlValue> TomlValue::items() const {
  const auto* array = node_->as_array();
  if (!array) return {*this};
  if (array->empty()) refuse("found an empty array; allowed: one with at least one value");
  std::vector<TomlValue> values;
  for (const toml::node& item : *array) {
    values.push_back(TomlValue(*document_, item, fmt::format("{}[{}]", name_, values.size())));
  }
  return values;
}

TableReader TomlValue::table(const Keys& allowed) const {
  const auto* table = node_->as_table();
  if (!table) refuse_found(fmt::format("a table with the keys {}", listed(allowed)));
  return TableReader(*this, *table, std::make_shared<const Keys>(allowed));
}

std::vector<TableReader> TomlValue::tables(const Keys& allowed) const {
  const auto* array = node_->as_array();
  if (!array) refuse_found(fmt::format("an array of tables, each begun by [[{}]]", name_));
  const auto keys = std::make_shared<const Keys>(allowed);
  std::vector<TableReader> readers;
  readers.reserve(array->size());
  for (const toml::node& item : *array) {
    const TomlValue value(*document_, item, name_);
    if (!item.is_table()) value.refuse_found(fmt::format("a table with the keys {}", listed(allowed)));
    readers.push_back(TableReader(value, *item.as_table(), keys));
  }
  return readers;
}

TableReader::TableReader(TomlValue self, const toml::table& table, SharedKeys allowed)
    : self_(std::move(self)), table_(&table), allowed_(std::move(allowed)) {
  refuse_others("unknown key");
}

void TableReader::narrow(Keys allowed, const std::string& what) {
  allowed_ = std::make_shared<const Keys>(std::move(allowed));
  refuse_others(fmt::format("{} has no such key", what));
}

// Refuses the first key in the file that is not allowed; the table holds them in alphabetical order.
void TableReader::refuse_others(const std::string& fault) const {
  const toml::key* unknown = nullptr;
  for (const auto& [key, value] : *table_) {
    if (std::find(allowed_->begin(), allowed_->end(), key.str()) != allowed_->end()) continue;
    if (!unknown || key.source().begin < unknown->source().begin) unknown = &key;
  }
  if (!unknown) return;
  throw InputError(fmt::format("{}: {}: {}{}; allowed: {}", place(self_.document_->path, unknown->source().begin),
                               name_of(shown(unknown->str())), fault, did_you_mean(unknown->str(), *allowed_),
                               listed(*allowed_)));
}

bool TableReader::is_inline() const { return table_->is_inline(); }

std::string TableReader::name_of(std::string_view key) const {
  return self_.name_.empty() ? std::string(key) : fmt::format("{}.{}", self_.name_, key);
}

std::optional<TomlValue> TableReader::find(std::string_view key) const {
  assert(std::find(allowed_->begin(), allowed_->end(), key) != allowed_->end() && "a key is allowed before it is read");
  const toml::node* node = table_->get(key);
  if (!node) return std::nullopt;
  return TomlValue(*self_.document_, *node, name_of(key));
}

TomlValue TableReader::at(std::string_view key) const {
  if (auto value = find(key)) return *value;
  throw InputError(fmt::format("{}: {}: missing, it must be given", self_.where(), name_of(key)));
}

TomlFile TomlFile::parse(std::string text, const std::string& path) {
  if (const auto fault = beyond_library(text)) {
    throw InputError(fmt::format("{}:{}:{}: {}", path, fault->line, fault->column, fault->what));
  }
  TomlFile file;
  try {
    toml::table root = toml::parse(text);
    file.document_ = std::make_shared<const TomlDocument>(TomlDocument{path, std::move(text), std::move(root)});
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}: is not TOML: {}", place(path, error.source().begin), shown(error.description(), 300)));
  }
  return file;
}

TomlFile TomlFile::read(const std::string& path) { return parse(read_text_file(path), path); }

const std::string& TomlFile::text() const { return document_->text; }

TableReader TomlFile::root(const Keys& allowed) const {
  return TomlValue(*document_, document_->root, "").table(allowed);
}

}  // namespace rigor::inline scene
