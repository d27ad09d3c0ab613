// A chart on paper: the drawing, the page, the table and what is read back of them.
#include "benchmarks/chart/chart_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "benchmarks/chart/chart_page.h"
#include "benchmarks/chart/chart_svg.h"
#include "renderer/image_file.h"
#include "tests/benchmarks/chart_samples.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

using test::contains;
using test::count_of;
using test::TemporaryFolder;

TEST(ChartDrawing, ShowsEveryPointTheFrontTheFloorAndTheBars) {
  const ChartData data = test::sample_chart();
  const std::string svg = chart_svg(data, kMetrics.front());
  EXPECT_EQ(count_of(svg, "<circle class=\"point"), data.points.size());
  EXPECT_EQ(count_of(svg, "<circle class=\"point best"), 8u);
  EXPECT_EQ(count_of(svg, "class=\"front\""), 1u);
  EXPECT_EQ(count_of(svg, "<line class=\"bar\""), 2u) << "quartiles of the dominated two";
  EXPECT_EQ(count_of(svg, "<line class=\"bar best\""), 16u) << "quartiles, and the reference's error";
  EXPECT_TRUE(contains(svg, "the reference&#39;s own error: 0.0001")) << svg;
  EXPECT_TRUE(contains(svg, "1/255"));
  EXPECT_FALSE(contains(svg, "nan") || contains(svg, "inf"));
}

// Errors of 0 have no logarithm, and one point has no span.
TEST(ChartDrawing, BearsWhatHasNoLogarithm) {
  ChartData data = test::sample_chart();
  data.points = {test::charted_point("defaults", "", 1, 0)};
  data.points[0].cpu_seconds = {1};
  data.floor.rmse = 0;
  const std::string svg = chart_svg(data, kMetrics.front());
  EXPECT_EQ(count_of(svg, "<circle"), 1u);
  EXPECT_FALSE(contains(svg, "nan") || contains(svg, "inf")) << svg;
}

TEST(ChartDrawing, NoLabelMeetsAnother) {
  ChartData data = test::sample_chart();
  // A crowd: many settings at nearly one place.
  for (int i = 0; i < 30; ++i)
    data.points.push_back(test::charted_point("crowd", std::to_string(i), 0.09 - 1e-5 * i, 0.21 + 1e-4 * i));
  const std::string svg = chart_svg(data, kMetrics.front());
  struct Label {
    double left, right, baseline;
  };
  std::vector<Label> labels;
  const std::regex label("class=\"label\" text-anchor=\"([a-z]+)\" x=\"([0-9.]+)\" y=\"([0-9.]+)\">([^<]*)<");
  for (std::sregex_iterator match(svg.begin(), svg.end(), label), end; match != end; ++match) {
    const double x = std::stod((*match)[2]), width = 6 * double((*match)[4].length());
    labels.push_back((*match)[1] == "start" ? Label{x, x + width, std::stod((*match)[3])}
                                            : Label{x - width, x, std::stod((*match)[3])});
  }
  EXPECT_GE(labels.size(), 8u);
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(labels[i].left < labels[j].right && labels[j].left < labels[i].right &&
                   std::abs(labels[i].baseline - labels[j].baseline) < 12)
          << i << " and " << j;
}

TEST(ChartPage, HoldsEverythingAndNeedsNoNetwork) {
  const ChartData data = test::sample_chart();
  const std::string page = chart_page(data);
  for (const ChartPoint& point : data.points) EXPECT_TRUE(contains(page, point.command)) << point.command;
  EXPECT_EQ(count_of(page, "<svg class=\"chart\""), 6u);
  EXPECT_EQ(count_of(page, "\"picture\":\"data:image/png;base64,AQI=\""), data.points.size());
  EXPECT_TRUE(contains(page, "A &lt;cone&gt; &amp; more"));
  EXPECT_EQ(count_of(page, "http"), count_of(page, "http://www.w3.org/2000/svg")) << "a name space is no address";
  for (const char* part : {"src=\"", "@import", "fetch(", "<link"}) EXPECT_FALSE(contains(page, part)) << part;
}

TEST(ChartFiles, TableHasALineForEachPoint) {
  const ChartData data = test::sample_chart();
  const std::string csv = chart_csv(data);
  EXPECT_EQ(count_of(csv, "\n"), data.points.size() + 1);
  EXPECT_TRUE(contains(csv, "0,\"defaults\",\"the scene's own\",0,0.5,0.495,0.505,0.25,")) << csv;
  EXPECT_TRUE(contains(csv, "1,\"levels\",\"0\",1,0.1,")) << csv;
}

TEST(ChartFiles, AreReadBackAsTheyWere) {
  const TemporaryFolder folder;
  ChartData data = test::sample_chart();
  data.points[1].errors.distance = std::numeric_limits<double>::quiet_NaN();
  data.points[2].errors.rmse = 0.1 + 0.2;  // takes all digits
  data.points[3].repeats = false;
  EXPECT_FALSE(read_earlier_chart(folder.folder().string()));
  write_chart(folder.folder().string(), data);
  Film film(4, 4, {0, 0, 4, 4}, kChartChannels);
  for (int i = 0; i < 16; ++i)
    film.plane(ChannelGroup::color, 1)[i] = 0.1f * float(i), film.plane(ChannelGroup::depth, 0)[i] = 3;
  film.plane(ChannelGroup::depth, 0)[5] = std::numeric_limits<float>::infinity();
  write_reference(folder.folder().string(), film);
  const auto earlier = read_earlier_chart(folder.folder().string());
  ASSERT_TRUE(earlier);
  EXPECT_TRUE(same_subject(earlier->data, data));
  EXPECT_EQ(chart_csv(earlier->data), chart_csv(data));
  EXPECT_EQ(earlier->data.points[2].errors, data.points[2].errors);
  EXPECT_EQ(earlier->data.points[2].picture, data.points[2].picture);
  EXPECT_FALSE(earlier->data.points[3].repeats);
  EXPECT_EQ(earlier->data.plan, data.plan);
  ASSERT_TRUE(earlier->reference);
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(earlier->reference->plane(ChannelGroup::color, 1)[i], film.plane(ChannelGroup::color, 1)[i]);
    EXPECT_EQ(earlier->reference->plane(ChannelGroup::depth, 0)[i], film.plane(ChannelGroup::depth, 0)[i]);
  }
  // A point without its picture is measured again.
  std::filesystem::remove(folder.folder() / "pictures" / (data.points[4].key + ".png"));
  EXPECT_EQ(read_earlier_chart(folder.folder().string())->data.points.size(), data.points.size() - 1);
}

TEST(ChartFiles, AChartThatIsNoneIsRefused) {
  const TemporaryFolder folder;
  for (const char* text : {"", "[]", "{\"raytree_chart\": 99}", "not JSON"}) {
    folder.write("chart.json", text);
    EXPECT_THROW(read_earlier_chart(folder.folder().string()), Error) << text;
  }
}

TEST(ChartFiles, ChartsOfOtherSubjectsAreTold) {
  const ChartData data = test::sample_chart();
  const auto differs = [&](auto&& change) {
    ChartData other = data;
    change(other);
    return !same_subject(data, other);
  };
  EXPECT_TRUE(differs([](ChartData& d) { d.scene_hash = "1"; }));
  EXPECT_TRUE(differs([](ChartData& d) { d.version = "1"; }));
  EXPECT_TRUE(differs([](ChartData& d) { d.machine = "there"; }));
  EXPECT_TRUE(differs([](ChartData& d) { d.width = 5; }));
  EXPECT_TRUE(differs([](ChartData& d) { d.threads = 1; }));
  EXPECT_FALSE(differs([](ChartData& d) { d.budget_seconds = 9; }));
}

}  // namespace
}  // namespace raytree::benchmarks
