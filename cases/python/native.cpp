// rigor._native: what is too slow in Python. Reads the CSV of a trajectory into one structured array of NumPy.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <charconv>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace py = pybind11;

namespace rigor::python {
namespace {

// One table of CSV as `rigor` writes it: the second column is a body's name, perhaps in quotes, the others are numbers.
class CsvTable {
 public:
  explicit CsvTable(std::string_view text) : text_(text) {
    const std::string_view header = line();
    for (std::size_t at = 0; at <= header.size();) {
      const std::size_t end = std::min(header.find(',', at), header.size());
      columns_.emplace_back(header.substr(at, end - at));
      at = end + 1;
    }
    if (columns_.size() < 3 || columns_[0] != "time" || columns_[1] != "body")
      throw py::value_error("no table of states: its first line does not begin with time,body");
    start_ = at_;
    while (at_ < text_.size()) {
      name_of(line());
      widest_ = std::max(widest_, name_.size());
      ++rows_;
    }
  }

  py::array array() {
    const std::size_t width = widest_ + widest_ % 2;  // numbers then stay aligned
    py::list fields;
    for (const std::string& column : columns_)
      fields.append(py::make_tuple(column, column == "body" ? "<U" + std::to_string(width) : std::string("<f8")));
    py::array array(py::dtype::from_args(fields), std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows_)});
    fill(static_cast<char*>(array.mutable_data()), width);
    return array;
  }

 private:
  std::string_view line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view found = text_.substr(at_, end - at_);
    at_ = end + 1;
    return found;
  }

  // Sets name_ and returns what follows it.
  std::string_view name_of(std::string_view row) {
    std::size_t at = row.find(',');
    if (at == std::string_view::npos) fault("has one column");
    name_.clear();
    const bool is_quoted = ++at < row.size() && row[at] == '"';
    std::string bytes;
    if (is_quoted) {
      for (++at; at < row.size(); ++at) {
        if (row[at] == '"' && (at + 1 == row.size() || row[++at] != '"')) break;
        bytes += row[at];
      }
    } else {
      const std::size_t end = std::min(row.find(',', at), row.size());
      bytes = row.substr(at, end - at), at = end;
    }
    decode(bytes);
    return at < row.size() ? row.substr(at + 1) : std::string_view();
  }

  void decode(const std::string& bytes) {
    bool is_ascii = true;
    for (const char c : bytes) is_ascii &= static_cast<unsigned char>(c) < 0x80;
    if (is_ascii) {
      for (const char c : bytes) name_ += static_cast<char32_t>(c);
      return;
    }
    const auto text = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace"));
    for (py::ssize_t i = 0; i < PyUnicode_GetLength(text.ptr()); ++i) name_ += PyUnicode_ReadChar(text.ptr(), i);
  }

  double number(std::string_view& rest) {
    double value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc()) fault("has no number where one is due");
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    if (!rest.empty() && rest.front() == ',') rest.remove_prefix(1);
    return value;
  }

  void fill(char* to, std::size_t width) {
    at_ = start_;
    for (row_ = 0; row_ < rows_; ++row_) {
      const std::string_view whole = line();
      std::string_view first = whole, rest = name_of(whole);
      const double time = number(first);
      std::memcpy(to, &time, sizeof time), to += sizeof time;
      name_.resize(width, U'\0');
      std::memcpy(to, name_.data(), width * sizeof(char32_t)), to += width * sizeof(char32_t);
      for (std::size_t c = 2; c < columns_.size(); ++c) {
        const double value = number(rest);
        std::memcpy(to, &value, sizeof value), to += sizeof value;
      }
      if (!rest.empty()) fault("has too many columns");
    }
  }

  [[noreturn]] void fault(const char* what) const {
    throw py::value_error("row " + std::to_string(row_ + 1) + " of the table " + what);
  }

  std::string_view text_;
  std::vector<std::string> columns_;
  std::u32string name_;  // of the current row
  std::size_t at_ = 0, start_ = 0, rows_ = 0, widest_ = 2, row_ = 0;
};

py::array read_states(const py::buffer& bytes) {
  const py::buffer_info info = bytes.request();
  return CsvTable({static_cast<const char*>(info.ptr), static_cast<std::size_t>(info.size * info.itemsize)}).array();
}

}  // namespace
}  // namespace rigor::python

PYBIND11_MODULE(_native, module) {
  module.doc() = "What is too slow in Python.";
  module.def("read_states", &rigor::python::read_states, py::arg("bytes"),
             "The CSV of a trajectory, as bytes, as a structured array: time, body, px, ... wz and what follows.");
}
