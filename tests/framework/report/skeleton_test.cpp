#include "framework/report/skeleton.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "framework/report/assets.hpp"
#include "framework/report/response_panels.hpp"

namespace twinmap {
namespace {

using Json = nlohmann::ordered_json;

Panel makeEstimates() {
  return {
      "estimates",
      {{"name", "k"}, {"label", "k [N/m]"}, {"title", "error of k"}, {"column", "error_k"}, {"color", "red"}},
      {{"lower", 80.0},
       {"upper", 120.0},
       {"parameters", std::vector<Texts>{{{"each", "k"}, {"each_label", "k [N/m]"}},
                                         {{"each", "d"}, {"each_label", "d"}}}}}};
}

TEST(Skeleton, TextsAndValuesStandInEveryPlaceOfTheirs) {
  const Json spec = makeSpec(makeEstimates());
  for (const int layer : {1, 2}) {
    const Json& x = spec["layer"][layer]["encoding"]["x"];
    EXPECT_EQ(x["field"], "true_k");
    EXPECT_EQ(x["title"], "true k [N/m]");
    EXPECT_EQ(x["scale"]["domain"], Json::array({80, 120}));
  }
  EXPECT_EQ(spec["layer"][1]["transform"][0]["calculate"], "datum['error_k'] - 2 * datum['stddev_k']");
  EXPECT_EQ(spec["layer"][0]["data"]["values"][1], (Json{{"x", 120}, {"y", 1}}));  // y keeps its example
}

TEST(Skeleton, APartStandsOnceForEachOfItsTexts) {
  const Json tooltip = makeSpec(makeEstimates())["layer"][2]["encoding"]["tooltip"];
  ASSERT_EQ(tooltip.size(), 6u);
  EXPECT_EQ(tooltip[0]["field"], "sample");
  EXPECT_EQ(tooltip[1]["title"], "true k [N/m]");
  EXPECT_EQ(tooltip[2]["field"], "true_d");
  EXPECT_EQ(tooltip[3]["field"], "inferred_k");
}

TEST(Skeleton, AValueMayBeNullOrAListOfTexts) {
  const Json spec =
      makeSpec({"error-curves", {}, {{"series_title", nullptr}, {"series", std::vector<std::string>{"a"}}}});
  const Json& dash = spec["layer"][1]["encoding"]["strokeDash"];
  EXPECT_TRUE(dash["title"].is_null());
  EXPECT_EQ(dash["scale"]["domain"], Json::array({"a"}));
}

TEST(Skeleton, PartsThatAPanelLacksAreGoneWhateverTheirOrder) {
  const ResponseData data{"replay", "y", "m"};
  const Json whole = makeSpec(makeResponsePanel(data, {true, true}));
  EXPECT_EQ(whole["layer"].size(), 4u);
  EXPECT_EQ(whole["layer"][3]["encoding"]["tooltip"].size(), 6u);
  EXPECT_TRUE(whole["layer"][3].contains("params"));
  const Json bare = makeSpec(makeResponsePanel(data));
  ASSERT_EQ(bare["layer"].size(), 3u);
  EXPECT_EQ(bare["layer"][2]["encoding"]["tooltip"].size(), 4u);
  EXPECT_FALSE(bare["layer"][2].contains("params"));
  EXPECT_EQ(bare["transform"], Json::array());
}

TEST(Skeleton, WhatATextHoldsIsNotReplacedAgain) {
  const Panel panel{"pit", {{"name", "{color}"}, {"color", "{name}"}}};
  const Json spec = makeSpec(panel);
  EXPECT_EQ(spec["title"], "{color}");
  EXPECT_EQ(spec["layer"][0]["mark"]["color"], "{name}");
  EXPECT_EQ(describePanel(panel), "Histogram of the probability integral transform of {color}");
}

TEST(Skeleton, ExamplesOfDataStayBehind) {
  const Json skeletons = Json::parse(getFigureSkeletons());
  for (const auto& [name, skeleton] : skeletons.items()) {
    const Json spec = makeSpec({name});
    EXPECT_TRUE(skeleton.contains("datasets") && skeleton["usermeta"].contains("slots")) << name;
    EXPECT_FALSE(spec.contains("datasets") || spec.contains("usermeta")) << name;
  }
}

TEST(SkeletonDeathTest, ASlotThatDoesNotExistIsABug) {
  EXPECT_DEATH(makeSpec({"pit", {}, {{"lowest", 1.0}}}), "slots.contains");
  EXPECT_DEATH(makeSpec({"pits"}), "skeletons.contains");
}

}  // namespace
}  // namespace twinmap
