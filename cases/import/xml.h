// Reads the XML of robots' files. Each element knows its line. Words that nobody asks for are named. Document types,
// and so entities, and attributes given twice are refused.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/link_model.h"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace rigor::inline imports {

// The words that an element may hold. `left_out`: words of the format that no scene can say, and why.
struct XmlKnown {
  std::vector<std::string> attributes, elements;
  std::vector<std::pair<std::string, Reason>> left_out = {};
};

class XmlElement {
 public:
  XmlElement(const tinyxml2::XMLElement* element, const std::string* file) : element_(element), file_(file) {}

  std::string name() const;
  std::string where() const;                                // "file:line"
  std::string place() const;                                // "file:line: link 'arm'", for parts that are left out
  [[noreturn]] void refuse(const std::string& what) const;  // InputError: "file:line: <link>: what"

  std::optional<std::string> find(const std::string& attribute) const;
  std::string at(const std::string& attribute) const;
  std::string name_attribute() const;  // `name`, without control characters
  std::optional<double> find_number(const std::string& attribute) const;
  double number(const std::string& attribute) const;
  std::vector<double> find_numbers(const std::string& attribute, std::size_t count) const;  // empty if not there

  std::string text() const;  // without the white space around it
  double number_of_text() const;
  bool flag_of_text() const;
  std::vector<double> numbers_of_text(std::size_t count) const;

  std::vector<XmlElement> children() const;
  std::vector<XmlElement> children(const std::string& name) const;
  std::optional<XmlElement> child(const std::string& name) const;  // refuses a second one
  XmlElement only(const std::string& name) const;

  std::vector<std::pair<std::string, std::string>> attributes() const;

  // Adds unknown words to left_out. Refuses one that is close to a known word.
  void check(const XmlKnown& known, LeftOut& left_out) const;

 private:
  double one_number(const std::string& text, const std::string& what) const;
  std::vector<double> numbers(const std::string& text, std::size_t count, const std::string& what) const;
  std::string described() const;  // "link 'arm'", or for an element without name "link 'arm': <limit>"
  bool check_word(const std::string& word, const std::string& place, const std::string& what,
                  const std::vector<std::string>& words, const XmlKnown& known, LeftOut& left_out) const;

  const tinyxml2::XMLElement* element_;
  const std::string* file_;
};

inline constexpr std::size_t kLargestModel = std::size_t{16} << 20;  // bytes; in memory it is thirty times as large

class XmlFile {
 public:
  // Throws InputError with file and line.
  explicit XmlFile(const std::string& path);
  ~XmlFile();
  XmlFile(const XmlFile&) = delete;
  XmlFile& operator=(const XmlFile&) = delete;

  XmlElement root() const;
  std::size_t size() const { return size_; }  // bytes
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::size_t size_ = 0;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
};

}  // namespace rigor::inline imports
