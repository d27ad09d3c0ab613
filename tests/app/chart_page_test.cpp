// The page of a chart in a headless browser: what a click shows, and the comparison of two pictures.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

/// First of the names that the shell finds; empty: none.
std::string browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (std::system((std::string("command -v ") + name + " >/dev/null 2>&1").c_str()) == 0) return name;
  return "";
}

std::string decoded_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string decoded;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) break;
    bits = bits << 6 | static_cast<unsigned>(digit);
    count += 6;
    if (count >= 8) decoded += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return decoded;
}

/// The page with `body`, JavaScript that runs once it is loaded and returns an object (it may await). What it returned;
/// null and a failure where it returned nothing.
Json page_result(const TemporaryFolder& folder, const std::string& chromium, const std::string& body) {
  const std::string script =
      "<script>addEventListener('load', async () => {\n"
      "const pause = () => new Promise(done => setTimeout(done, 300));\n"
      "let result;\ntry { result = await (async () => {" +
      body +
      "})(); } catch (error) { result = { error: String(error) }; }\n"
      "document.body.innerHTML = '<pre id=\"result\"></pre>';\n"
      "document.getElementById('result').textContent = 'RESULT' + btoa(JSON.stringify(result)) + 'END';\n"
      "});</script>";
  const std::string page = folder.write("page.html", file_text(folder.path("chart") + "/chart.html") + script);
  const std::string dump = folder.path("dump.html");
  const std::string line = "HOME=" + folder.folder().string() + " timeout 60 " + chromium +
                           " --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --window-size=1300,2400 "
                           "--virtual-time-budget=8000 --user-data-dir=" +
                           folder.path("profile") + " --dump-dom file://" + page + " >" + dump + " 2>/dev/null";
  if (std::system(line.c_str()) != 0) {
    ADD_FAILURE() << line;
    return {};
  }
  const std::string text = file_text(dump);
  // The page's script, which says the word too, is gone with the rest of the body.
  const std::size_t last = text.find("RESULT");
  if (last == std::string::npos) {
    ADD_FAILURE() << text.substr(0, 400);
    return {};
  }
  return Json::parse(decoded_base64(text.substr(last + 6)));
}

class ChartPage : public testing::Test {
 protected:
  void SetUp() override {
    chromium_ = browser();
    if (chromium_.empty()) {
      ASSERT_EQ(std::getenv("RAYTREE_NEEDS_BROWSER"), nullptr) << "no chromium; install the package chromium";
      std::fprintf(stderr, "LEFT OUT: no chromium to open the page with; install the package chromium\n");
      GTEST_SKIP() << "no chromium";
    }
    const ProgramResult result =
        run_program({"chart", "cone", "-o", folder_.path("chart"), "--size", "36x24", "--budget", "1s"});
    ASSERT_EQ(result.status, 0) << result.err;
    chart_ = Json::parse(file_text(folder_.path("chart") + "/chart.json"));
  }

  Json result_of(const std::string& body) const { return page_result(folder_, chromium_, body); }

  const TemporaryFolder folder_;
  std::string chromium_;
  Json chart_;
};

// The point is one that nothing covers where it is drawn.
TEST_F(ChartPage, AClickShowsTheCommandOfThePoint) {
  const Json result = result_of(R"JS(
  const svg = [...document.querySelectorAll("svg.chart")].find(e => e.style.display !== "none");
  svg.scrollIntoView();
  let clicked = -1;
  for (const point of [...svg.querySelectorAll("circle.point")].reverse()) {
    const box = point.getBoundingClientRect();
    const at = [box.left + box.width / 2, box.top + box.height / 2];
    const target = document.elementFromPoint(...at);
    if (target !== point || point.dataset.point === "0") continue;
    target.dispatchEvent(new MouseEvent("click", { bubbles: true, clientX: at[0], clientY: at[1] }));
    clicked = Number(point.dataset.point);
    break;
  }
  const shown = () => document.getElementById("command").textContent;
  const other = [...svg.querySelectorAll("circle.point")].find(e => Number(e.dataset.point) !== clicked);
  other.dispatchEvent(new MouseEvent("mouseenter"));
  const hovered = { point: Number(other.dataset.point), command: shown() };
  other.dispatchEvent(new MouseEvent("mouseleave"));
  hovered.after = shown();
  const column = [...document.querySelectorAll("#table th")].findIndex(e => e.textContent === "RMSE");
  const rows = () => [...document.querySelectorAll("#table tbody tr")].map(r => Number(r.cells[column].dataset.value));
  document.querySelectorAll("#table th")[column].click();
  const sorted = rows().every((v, i, all) => i === 0 || all[i - 1] <= v);
  await pause();
  const canvas = document.getElementById("canvas-a");
  const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  document.querySelectorAll("#table th")[column].click();
  const turned = rows().every((v, i, all) => i === 0 || all[i - 1] >= v);
  return { clicked, hovered, turned, command: document.getElementById("command").textContent, rows: rows().length, sorted,
    a: document.getElementById("picture-a").value, drawn: data.some((v, i) => i % 4 !== 3 && v > 0),
    map: document.getElementById("map-words").textContent };
)JS");
  ASSERT_GT(result["clicked"], 0) << result;
  const Json& point = chart_["points"][result["clicked"].get<std::size_t>()];
  EXPECT_EQ(result["command"], point["command"]);
  EXPECT_EQ(result["hovered"]["command"], chart_["points"][result["hovered"]["point"].get<std::size_t>()]["command"]);
  EXPECT_EQ(result["hovered"]["after"], point["command"]) << "the chosen one's again";
  EXPECT_EQ(result["turned"], true) << "by falling RMSE after a second click";
  EXPECT_EQ(result["a"], std::to_string(result["clicked"].get<int>())) << "its picture is the one looked at";
  EXPECT_EQ(result["rows"], chart_["points"].size());
  EXPECT_EQ(result["sorted"], true) << "by RMSE after a click on the column's head";
  EXPECT_EQ(result["drawn"], true);
  EXPECT_TRUE(contains(result["map"], "of the pixels differ by more than 1")) << result;
}

/// Picks the two settings whose pictures differ most, by RMSE, and says of a view (left, top, scale) which share of
/// each canvas shows it: A and B their own pictures' pixels, the map black where they are equal and lit where they are
/// not.
constexpr const char* kComparison = R"JS(
  const by = id => document.getElementById(id);
  const choice = (id, value) => { by(id).value = value; by(id).dispatchEvent(new Event("input", { bubbles: true })); };
  const read = source => new Promise(done => {
    const img = new Image();
    img.onload = () => {
      const canvas = document.createElement("canvas");
      canvas.width = img.naturalWidth, canvas.height = img.naturalHeight;
      canvas.getContext("2d").drawImage(img, 0, 0);
      done(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height));
    };
    img.src = source;
  });
  const worst = points.map((p, i) => i).sort((i, j) => Number(points[j].errors[0]) - Number(points[i].errors[0]));
  const a = worst[0], b = worst[worst.length - 1];
  const pictures_of = [await read(points[a].picture), await read(points[b].picture)];
  const shares = (left, top, scale) => ["canvas-a", "canvas-b", "canvas-error"].map((id, k) => {
    const canvas = by(id), fit = canvas.width / chart.width * scale;
    const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    let same = 0, all = 0;
    for (let y = 3; y < canvas.height; y += 7)
      for (let x = 3; x < canvas.width; x += 7) {
        const across = left + (x + .5) / fit, down = top + (y + .5) / fit;
        if ([across, down].some(v => Math.abs(v - Math.round(v)) < .1)) continue;
        const at = 4 * (Math.floor(down) * chart.width + Math.floor(across));
        const seen = [0, 1, 2].map(c => data[4 * (y * canvas.width + x) + c]);
        const colors = pictures_of.map(p => [0, 1, 2].map(c => p.data[at + c]));
        const off = Math.max(...[0, 1, 2].map(c => Math.abs(colors[0][c] - colors[1][c])));
        const sum = seen[0] + seen[1] + seen[2];
        same += k < 2 ? colors[k].every((v, c) => v === seen[c]) : off === 0 ? sum <= 4 : sum > 4;
        ++all;
      }
    return same / all;
  });
  choice("picture-a", a);
  choice("picture-b", b);
  await pause();
  const box = id => by(id).getBoundingClientRect();
  const event_at = (id, across, down) => ({ bubbles: true, cancelable: true, pointerId: 1, button: 0, buttons: 1,
    clientX: box(id).left + across * box(id).width, clientY: box(id).top + down * box(id).height });
)JS";

TEST_F(ChartPage, TwoPicturesAndTheirErrorMoveTogether) {
  const Json result = result_of(std::string(kComparison) + R"JS(
  const result = { whole: shares(0, 0, 1), names: [by("picture-a"), by("picture-b")].map(e => e.selectedOptions[0].text) };
  // A wheel over A, a quarter in from the left and halfway down: what is under the pointer stays there.
  const turned = new WheelEvent("wheel", { ...event_at("canvas-a", 1 / 4, 1 / 2), deltaY: -500 });
  by("canvas-a").dispatchEvent(turned);
  result.kept = turned.defaultPrevented;
  const scale = Math.E, left = chart.width / 4 * (1 - 1 / scale), top = chart.height / 2 * (1 - 1 / scale);
  await pause();
  result.zoomed = shares(left, top, scale);
  result.elsewhere = shares(0, 0, scale);
  // Dragged by the picture's tenth to the left, on B.
  const dragged = (type, across, down) => by("canvas-b").dispatchEvent(new PointerEvent(type, event_at("canvas-b", across, down)));
  dragged("pointerdown", .5, .5);
  dragged("pointermove", .45, .5);
  dragged("pointermove", .4, .5);
  dragged("pointerup", .4, .5);
  dragged("pointermove", .1, .1);
  await pause();
  result.panned = shares(left + chart.width / 10 / scale, top, scale);
  by("canvas-error").dispatchEvent(new MouseEvent("dblclick", { bubbles: true }));
  await pause();
  result.reset = shares(0, 0, 1);
  result.map = by("map-words").textContent;
  const light = () => {
    const canvas = by("canvas-error");
    return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.reduce((s, v, i) => i % 4 === 3 ? s : s + v, 0);
  };
  const dim = light();
  choice("gain", 7);
  await pause();
  result.brighter = light() > dim;
  by("swap").click();
  await pause();
  result.swapped = [by("name-a"), by("name-b")].map(e => e.textContent);
  return result;
)JS");
  ASSERT_FALSE(result.contains("error")) << result;
  EXPECT_NE(result["names"][0], result["names"][1]);
  EXPECT_EQ(result["kept"], true) << "the page does not scroll under the wheel";
  // Pixels of a canvas near the border of two of the picture's are left out: either may show.
  for (const char* view : {"whole", "zoomed", "panned", "reset"})
    for (const Json& share : result[view]) EXPECT_EQ(share, 1) << view << " " << result;
  for (const std::size_t pane : {0u, 1u}) EXPECT_LT(result["elsewhere"][pane], 0.9) << "the view can be told";
  EXPECT_TRUE(contains(result["map"], "of the pixels differ by more than 1")) << result;
  EXPECT_EQ(result["brighter"], true) << "error times 128 in place of 16";
  EXPECT_EQ(result["swapped"][0], result["names"][1]);
  EXPECT_EQ(result["swapped"][1], result["names"][0]);
}

}  // namespace
}  // namespace raytree::test
