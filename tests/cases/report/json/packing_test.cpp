#include "cases/report/json/packing.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/cases/report/html/unpacking.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_json_packing)

BOOST_AUTO_TEST_CASE(base64_writes_the_vectors_of_rfc_4648) {
  const std::pair<const char*, const char*> rows[] = {{"", ""},
                                                      {"f", "Zg=="},
                                                      {"fo", "Zm8="},
                                                      {"foo", "Zm9v"},
                                                      {"foob", "Zm9vYg=="},
                                                      {"fooba", "Zm9vYmE="},
                                                      {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : rows) BOOST_TEST(base64(plain) == coded);
  BOOST_TEST(base64(std::string("\xff\xfe\x00", 3)) == "//4A");
}

BOOST_AUTO_TEST_CASE(what_was_packed_comes_out_again) {
  std::string bytes;
  for (int i = 0; i < 5000; ++i) bytes += static_cast<char>(i * i / 7);
  BOOST_TEST(inflated(from_base64(base64(deflated(bytes)))) == bytes);
  BOOST_TEST(inflated(deflated("")) == "");
}

BOOST_AUTO_TEST_CASE(numbers_and_differences_are_little_endian) {
  Bytes bytes;
  bytes.add_u8(1), bytes.add_u16(0x0203), bytes.add_u32(0x04050607);
  bytes.add_f32(1.5f), bytes.add_f64(-2);
  bytes.add_differences({5, 4, 0, 65535});
  Unpacking in(bytes.data());
  BOOST_TEST(in.u8() == 1);
  BOOST_TEST(in.u16() == 0x0203);
  BOOST_TEST(in.u32() == 0x04050607u);
  BOOST_TEST(in.f32() == 1.5f);
  BOOST_TEST(in.f64() == -2.0);
  const auto values = in.differences(4);
  BOOST_TEST((values == std::vector<std::uint16_t>{5, 4, 0, 65535}));
  BOOST_TEST(in.is_at_end());
}

BOOST_AUTO_TEST_CASE(half_of_a_float_is_right_to_an_eighth_bit) {
  for (const double value : {1.0, -3.7, 1e-12, 123456.0, 0.0305, -2e30}) {
    // 8 bits of mantissa, the leading one included: half a unit of the last is 2^-9.
    BOOST_TEST(std::abs(from_half(half_of_float(value)) - value) <= std::ldexp(std::abs(value), -8));
  }
  BOOST_TEST(from_half(half_of_float(0)) == 0.0);
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300})
    BOOST_TEST(std::isnan(from_half(half_of_float(value))));
}

BOOST_AUTO_TEST_SUITE_END()
