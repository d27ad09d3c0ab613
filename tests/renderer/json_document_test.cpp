// JSON text to values with lines: what is JSON and what is not, by a public collection of cases and cases of our own.
#include "renderer/json_document.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "geometry/error.h"
#include "renderer/scene_reader.h"
#include "renderer/suggestion.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

bool is_json(const std::string& text) {
  try {
    JsonDocument::parse(text, "x.json");
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::string parse_refusal(const std::string& text) {
  try {
    JsonDocument::parse(text, "x.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "accepted";
}

TEST(JsonDocument, ValuesKnowTheirLine) {
  const JsonDocument document = JsonDocument::parse(
      "{\n"
      "  \"a\": 1,\n"
      "  \"b\":\n"
      "    -2.5e1\n"
      "  ,\n"
      "  \"c\": [\n"
      "    true, null,\n"
      "    \"x\\ny\"\n"
      "  ],\r\n"
      "\n"
      "  \"a\": {}}\n",
      "x.json");
  const JsonValue root = document.root();
  ASSERT_EQ(root.kind(), JsonKind::object);
  EXPECT_EQ(root.line(), 1);
  EXPECT_EQ(root.size(), 4u);
  std::vector<JsonMember> members;
  root.for_each_member([&](const JsonMember& member) { members.push_back(member); });
  ASSERT_EQ(members.size(), 4u);
  EXPECT_EQ(members[0].key, "a");
  EXPECT_EQ(members[0].line, 2);
  EXPECT_EQ(members[0].value.number(), 1);
  EXPECT_EQ(members[1].line, 3);
  EXPECT_EQ(members[1].value.line(), 4) << "a number at the end of a line";
  EXPECT_EQ(members[1].value.number(), -25);
  EXPECT_EQ(members[2].line, 6);
  EXPECT_EQ(members[2].value.size(), 3u);
  std::vector<std::int64_t> lines;
  members[2].value.for_each_element([&](JsonValue value) { lines.push_back(value.line()); });
  EXPECT_EQ(lines, (std::vector<std::int64_t>{7, 7, 8}));
  EXPECT_EQ(members[3].key, "a") << "duplicates are kept";
  EXPECT_EQ(members[3].line, 11);
  EXPECT_EQ(members[3].value.kind(), JsonKind::object);
  EXPECT_EQ(members[3].value.size(), 0u);
}

TEST(JsonDocument, RefusalsNameFileAndLine) {
  EXPECT_EQ(parse_refusal("{\n\n  \"a\": 1,\n  \"b\" 2\n}").rfind("x.json:4: not valid JSON: ", 0), 0u);
  EXPECT_EQ(parse_refusal("{\n \"a\": [1,\n 2").rfind("x.json:3: not valid JSON: ", 0), 0u);
  EXPECT_EQ(parse_refusal("").rfind("x.json:1: not valid JSON: ", 0), 0u);
  EXPECT_EQ(parse_refusal("[1,\n1e999]").rfind("x.json:2: not valid JSON: number overflow", 0), 0u);
  EXPECT_NE(parse_refusal("// no comments\n{}").find("not valid JSON"), std::string::npos);
}

TEST(JsonDocument, DepthIsLimited) {
  const std::string at_limit = std::string(kMaxJsonDepth, '[') + std::string(kMaxJsonDepth, ']');
  EXPECT_TRUE(is_json(at_limit));
  EXPECT_FALSE(is_json("[" + at_limit + "]"));
  EXPECT_NE(parse_refusal(std::string(100000, '[')).find("nested deeper than 100"), std::string::npos);
}

TEST(JsonDocument, TokensAreLimited) {
  EXPECT_TRUE(is_json("\"" + std::string(kMaxJsonToken - 1, 'x') + "\""));
  EXPECT_NE(
      parse_refusal("[\n\"" + std::string(kMaxJsonToken + 1, 'x') + "\"]").find("x.json:2: a string or number longer"),
      std::string::npos);
  EXPECT_NE(parse_refusal(std::string(kMaxJsonToken + 2, '1')).find("longer than 1 MiB"), std::string::npos);
  EXPECT_NE(parse_refusal(std::string("1\n\0\0", 4)).find("x.json:2: not valid JSON: a byte of value 0"),
            std::string::npos);
  // Escaped quotes end no string; brackets and blanks within one start no token.
  EXPECT_TRUE(is_json("[\"\\\\\", \"a\\\"[ ]\", 1]"));
}

// A tree may take 1.75 times the text and some spare bytes, so that a file made of tiny values is refused, not
// swallowed: a value takes 16 bytes, here of 2 bytes of text.
TEST(JsonDocument, TreesOfTinyValuesAreLimited) {
  std::string text = "[";
  for (int i = 0; i < 1000; ++i) text += "0,\n";
  text += "0]";
  EXPECT_NO_THROW(JsonDocument::parse(text, "x.json", 16'000));
  try {
    JsonDocument::parse(text, "x.json", 0);
    FAIL();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("too many values"), message.npos) << message;
    EXPECT_GT(error.where().line, 100);
  }
}

TEST(JsonDocument, DescribesValuesForMessages) {
  const JsonDocument document =
      JsonDocument::parse(R"(["glass", 12.5, [1, 2], {}, true, null, [], "\u0007a\"b"])", "x.json");
  std::vector<std::string> texts;
  document.root().for_each_element([&](JsonValue value) { texts.push_back(description_of(value)); });
  EXPECT_EQ(texts, (std::vector<std::string>{"\"glass\"", "12.5", "an array of 2", "an object", "true", "null",
                                             "an empty array", "\"\\x07a\\\"b\""}));
  EXPECT_EQ(in_quotes(std::string(100, 'a')), "\"" + std::string(60, 'a') + "...\"");
  EXPECT_EQ(in_quotes(std::string(59, 'a') + "\xC3\xA4z"), "\"" + std::string(59, 'a') + "...\"");
}

TEST(JsonDocument, PublicCasesAreJudgedAsTheirNamesSay) {
  int yes = 0, no = 0, either = 0;
  for (const auto& path : test::test_data_files("malformed/json")) {
    const std::string name = path.filename().string();
    const std::string text = contents(path);
    const bool accepted = is_json(text);
    if (name.starts_with("y_")) {
      EXPECT_TRUE(accepted) << name << ": " << parse_refusal(text);
      ++yes;
    } else if (name.starts_with("n_")) {
      EXPECT_FALSE(accepted) << name;
      ++no;
    } else {
      ++either;
    }
    // None of them is a scene: refused with file and line, whatever it is.
    try {
      read_scene_file(path.string());
      ADD_FAILURE() << name << " read as a scene";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input) << name;
      EXPECT_EQ(error.where().file, path.string());
      EXPECT_GT(error.where().line, 0) << name << ": " << error.what();
    }
  }
  std::fprintf(stderr, "JSON cases: %d to accept, %d to refuse, %d either way\n", yes, no, either);
}

}  // namespace
}  // namespace raytree
