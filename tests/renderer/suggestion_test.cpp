// The name that a misspelled word most likely meant.
#include "renderer/suggestion.h"

#include <gtest/gtest.h>

namespace raytree {
namespace {

TEST(Suggestion, FindsTheNearestNameOrNone) {
  const std::vector<std::string> names{"diffuse", "ambient", "color", "xz"};
  EXPECT_EQ(closest_name("colour", names), "color");
  EXPECT_EQ(closest_name("Difuse", names), "diffuse");
  EXPECT_EQ(closest_name("abmient", names), "ambient");
  EXPECT_EQ(closest_name("zx", names), "xz");
  EXPECT_EQ(closest_name("specular", names), std::nullopt);
  EXPECT_EQ(closest_name("", names), std::nullopt);
  EXPECT_EQ(closest_name(std::string(1'000'000, 'x'), names), std::nullopt);
}

}  // namespace
}  // namespace raytree
