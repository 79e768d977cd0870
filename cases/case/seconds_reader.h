// A number of seconds in a case file, or a fraction of one in quotes.
#pragma once

#include <fmt/format.h>

#include "cases/case/case.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline cases {

inline StepSize read_seconds(const TomlValue& value) {
  if (value.is_text()) return parse_step_size(value.text(), value.label());
  const double seconds = value.positive();
  return {seconds, fmt::format("{}", seconds)};
}

}  // namespace rigor::inline cases
