#include "benchmarks/report_page.h"

#include <gtest/gtest.h>

namespace raytree::benchmarks {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  std::vector<std::byte> bytes;
  for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
  return bytes;
}

TEST(ReportPage, EscapesWhatHtmlWouldRead) {
  EXPECT_EQ(escaped_html("a < b && \"c\" > 'd'"), "a &lt; b &amp;&amp; &quot;c&quot; &gt; &#39;d&#39;");
}

// RFC 4648, section 10.
TEST(ReportPage, EncodesBytesAsRfc4648Does) {
  const auto encoded = [](std::string_view text) { return data_address("text/plain", bytes_of(text)); };
  EXPECT_EQ(encoded(""), "data:text/plain;base64,");
  EXPECT_EQ(encoded("f"), "data:text/plain;base64,Zg==");
  EXPECT_EQ(encoded("fo"), "data:text/plain;base64,Zm8=");
  EXPECT_EQ(encoded("foo"), "data:text/plain;base64,Zm9v");
  EXPECT_EQ(encoded("foobar"), "data:text/plain;base64,Zm9vYmFy");
}

TEST(ReportPage, JsonCannotEndItsScript) {
  EXPECT_EQ(script_json(R"({"a": "</script><!--"})"), R"({"a": "\u003c/script>\u003c!--"})");
}

TEST(ReportPage, HoldsAllPartsAndNeedsNoNetwork) {
  const std::string page = report_page({"A & B", "under it", ".x { color: red; }", "<p>body</p>", "let a = 1;"});
  for (const char* part : {"<title>A &amp; B</title>", "under it", ".x { color: red; }", "<p>body</p>", "let a = 1;"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_NE(page.find(escaped_html(machine_line())), std::string::npos);
  for (const char* address : {"http:", "https:", "src=\"//"}) EXPECT_EQ(page.find(address), std::string::npos);
}

}  // namespace
}  // namespace raytree::benchmarks
