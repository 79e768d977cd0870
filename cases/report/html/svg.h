// The few shapes of SVG that pages drawn without a script are made of. Lengths are pixels.
#pragma once

#include <string>

namespace rigor::inline report {

std::string escaped(const std::string& text);  // for HTML and SVG
std::string svg_text(double x, double y, const std::string& text, const char* anchor = "middle", double turn = 0);
std::string svg_line(double x1, double y1, double x2, double y2, const char* css_class);

// A number from 0 to 1 as a colour, light to dark and the same to every eye.
std::string shade(double share);

// What a page begins with, up to its body's first line.
std::string page_head(const std::string& title);

// Two or three digits: a tick's label.
std::string tick(double value);

}  // namespace rigor::inline report
