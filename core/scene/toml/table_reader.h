// A checked view of a TOML file. Every value knows its key and its place, and each read function states the allowed
// values. Anything else throws InputError: "file:line:column: key: found ...; allowed: ...". The views point into their
// TomlFile and must not outlive it. Included by readers only.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"

namespace toml {
inline namespace v3 {
class node;
class table;
}  // namespace v3
}  // namespace toml

namespace rigor::inline scene {

class TableReader;
struct TomlDocument;
using Keys = std::vector<std::string>;

inline constexpr std::size_t kLongestText = 4096;  // bytes of one string; it ends up in messages, tables and file names

struct TextRange {
  std::size_t begin, end;  // bytes
};

// A value, and the name by which messages call it: "scene.body.mass".
class TomlValue {
 public:
  std::string where() const;        // "file:line:column"
  const std::string& path() const;  // of the file
  TextRange range() const;          // of the value in the file's text
  std::string label() const;        // "file:line:column: key", how a message begins
  bool is_text() const;
  bool is_array() const;

  double number() const;                    // finite; a whole number is one too
  double positive() const;                  // > 0
  double non_negative() const;              // >= 0
  double non_negative_or_infinite() const;  // >= 0, inf or the word "infinite"
  double fraction_of_one() const;           // 0..1
  bool flag() const;
  std::vector<double> numbers(std::initializer_list<std::size_t> counts) const;  // an array of as many numbers
  Vec3 vector() const;                                                           // three numbers
  Vec3 direction() const;                                                        // three numbers, made a unit vector
  std::string text() const;                                    // not empty, one line: no control character
  std::string choice(const Keys& known) const;                 // one of these words
  std::vector<TomlValue> items() const;                        // those of an array, at least one; else the value itself
  TableReader table(const Keys& allowed) const;                // with no other keys than these
  std::vector<TableReader> tables(const Keys& allowed) const;  // an array of tables, [[key]]

  [[noreturn]] void refuse(const std::string& fault) const;          // label: fault
  [[noreturn]] void refuse_found(const std::string& allowed) const;  // label: found ...; allowed: ...

 private:
  friend class TableReader;
  friend class TomlFile;
  TomlValue(const TomlDocument& document, const toml::node& node, std::string name)
      : document_(&document), node_(&node), name_(std::move(name)) {}

  const TomlDocument* document_;
  const toml::node* node_;
  std::string name_;
};

class TableReader {
 public:
  // The key must be among those allowed.
  std::optional<TomlValue> find(std::string_view key) const;
  TomlValue at(std::string_view key) const;  // throws if it is missing
  // Restricts the allowed keys, after the type of the table is known: "a sphere".
  void narrow(Keys allowed, const std::string& what);

  const TomlValue& self() const { return self_; }
  bool is_inline() const;  // { key = value } on one line
  [[noreturn]] void refuse(const std::string& fault) const { self_.refuse(fault); }

 private:
  friend class TomlValue;
  using SharedKeys = std::shared_ptr<const Keys>;  // by all rows of an array, of which there may be many
  TableReader(TomlValue self, const toml::table& table, SharedKeys allowed);
  void refuse_others(const std::string& fault) const;
  std::string name_of(std::string_view key) const;

  TomlValue self_;
  const toml::table* table_;
  SharedKeys allowed_;
};

class TomlFile {
 public:
  static TomlFile read(const std::string& path);
  static TomlFile parse(std::string text, const std::string& path);  // the path is for messages

  const std::string& text() const;
  TableReader root(const Keys& allowed) const;

 private:
  std::shared_ptr<const TomlDocument> document_;
};

// A text from a file as a message shows it: control characters written out, cut where it is long.
std::string shown(std::string_view text, std::size_t longest = 80);

}  // namespace rigor::inline scene
