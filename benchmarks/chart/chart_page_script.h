// What chart.html does when it is looked at. `chart` holds the data (see chart_page.cpp).
#pragma once

namespace raytree::benchmarks {

inline constexpr const char* kChartScript = R"JS(
"use strict";
const byId = id => document.getElementById(id);
const points = chart.points;
const pictures = [...points.map((p, i) => ({ name: p.name, source: p.picture })), { name: "the reference", source: chart.reference }];
let chosen = chart.start;

/* ---- the point looked at ---- */
function figures(p) {
  const rows = [["processor time", p.cpu], ["wall time", p.wall], ["rays", p.rays], ["memory", p.memory],
    ...chart.metrics.map((m, i) => [m.label, p.errors[i]])];
  return rows.map(([name, value]) => `<tr><td class="quiet">${name}</td><td class="number">${value}</td></tr>`).join("");
}
function show(i) {
  const p = points[i];
  byId("point-name").textContent = p.name;
  byId("command").textContent = p.command;
  byId("figures").innerHTML = figures(p);
  byId("picture").src = p.picture;
}
function mark(i) {
  document.querySelectorAll(".point.chosen").forEach(e => e.classList.remove("chosen"));
  document.querySelectorAll(`.point[data-point="${i}"]`).forEach(e => e.classList.add("chosen"));
  document.querySelectorAll("#table tr.chosen").forEach(e => e.classList.remove("chosen"));
  const row = document.querySelector(`#table tr[data-point="${i}"]`);
  if (row) row.classList.add("chosen");
}
function choose(i) {
  chosen = i;
  show(i);
  mark(i);
  byId("picture-a").value = i;
  draw();
}
document.addEventListener("click", event => {
  const at = event.target.closest("[data-point]");
  if (at) choose(Number(at.dataset.point));
});
document.querySelectorAll("circle.point").forEach(e => {
  e.addEventListener("mouseenter", () => show(Number(e.dataset.point)));
  e.addEventListener("mouseleave", () => show(chosen));
});
byId("copy").addEventListener("click", async () => {
  const text = byId("command").textContent;
  try { await navigator.clipboard.writeText(text); } catch (refused) {
    const range = document.createRange();
    range.selectNodeContents(byId("command"));
    getSelection().removeAllRanges();
    getSelection().addRange(range);
    document.execCommand("copy");
  }
  byId("copy").textContent = "copied";
  setTimeout(() => { byId("copy").textContent = "copy"; }, 1200);
});

/* ---- which error is charted ---- */
function chart_metric(key) {
  document.querySelectorAll("svg.chart").forEach(e => { e.style.display = e.dataset.metric === key ? "" : "none"; });
  document.querySelectorAll("#metrics button").forEach(e => e.setAttribute("aria-pressed", e.dataset.key === key));
}
byId("metrics").addEventListener("click", event => { if (event.target.dataset.key) chart_metric(event.target.dataset.key); });
chart_metric(chart.metrics[0].key);

/* ---- two pictures and what tells them apart ---- */
const panes = ["canvas-a", "canvas-b", "canvas-error"].map(byId);
const view = { x: 0, y: 0, scale: 1 };
const loaded = new Map();
for (const id of ["picture-a", "picture-b"])
  pictures.forEach((p, i) => byId(id).add(new Option(p.name, i)));
byId("picture-b").value = points.length;
function image(i) {
  if (!loaded.has(i)) loaded.set(i, new Promise(done => {
    const img = new Image();
    img.onload = () => done(img);
    img.src = pictures[i].source;
  }));
  return loaded.get(i);
}
function pixels(img) {
  const canvas = document.createElement("canvas");
  canvas.width = img.naturalWidth;
  canvas.height = img.naturalHeight;
  const context = canvas.getContext("2d");
  context.drawImage(img, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height);
}
/* Black, violet, red, yellow, white as the difference grows. */
function heat(t) {
  const stops = [[0, 0, 4], [87, 16, 110], [188, 55, 84], [249, 142, 9], [252, 255, 164]];
  const at = Math.min(1, t) * 4, i = Math.min(3, Math.floor(at)), f = at - i;
  return stops[i].map((v, c) => v + (stops[i + 1][c] - v) * f);
}
async function error_map(a, b, gain) {
  const pa = pixels(a), pb = pixels(b), out = new ImageData(pa.width, pa.height);
  let off = 0;
  for (let i = 0; i < pa.data.length; i += 4) {
    let d = 0;
    for (let c = 0; c < 3; ++c) d = Math.max(d, Math.abs(pa.data[i + c] - pb.data[i + c]));
    if (d > 1) ++off;
    const rgb = heat(d / 255 * gain);
    out.data.set([rgb[0], rgb[1], rgb[2], 255], i);
  }
  const canvas = document.createElement("canvas");
  canvas.width = pa.width;
  canvas.height = pa.height;
  canvas.getContext("2d").putImageData(out, 0, 0);
  byId("map-words").textContent =
    `white: off by ${Math.round(255 / gain)} of 255 or more; ${(100 * off / (pa.width * pa.height)).toFixed(2)} % of the pixels differ by more than 1`;
  return canvas;
}
let shown = [null, null, null], drawn_for = "";
async function draw() {
  const a = Number(byId("picture-a").value), b = Number(byId("picture-b").value), gain = 2 ** Number(byId("gain").value);
  const wanted = [a, b, gain].join();
  byId("name-a").textContent = pictures[a].name;
  byId("name-b").textContent = pictures[b].name;
  if (wanted !== drawn_for) {
    const [pa, pb] = await Promise.all([image(a), image(b)]);
    shown = [pa, pb, await error_map(pa, pb, gain)];
    drawn_for = wanted;
  }
  paint();
}
function paint() {
  panes.forEach((canvas, k) => {
    if (!shown[k]) return;
    const ratio = devicePixelRatio || 1, width = canvas.clientWidth;
    const height = Math.round(width * chart.height / chart.width);
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    canvas.style.height = height + "px";
    const context = canvas.getContext("2d"), fit = canvas.width / chart.width * view.scale;
    context.imageSmoothingEnabled = fit < 1;
    context.drawImage(shown[k], -view.x * fit, -view.y * fit, chart.width * fit, chart.height * fit);
  });
}
function keep_inside() {
  view.scale = Math.min(40, Math.max(1, view.scale));
  view.x = Math.min(chart.width * (1 - 1 / view.scale), Math.max(0, view.x));
  view.y = Math.min(chart.height * (1 - 1 / view.scale), Math.max(0, view.y));
}
for (const canvas of panes) {
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    const box = canvas.getBoundingClientRect(), per = chart.width / box.width;
    const x = (event.clientX - box.left) * per, y = (event.clientY - box.top) * per;
    const before = view.scale;
    view.scale *= Math.exp(-event.deltaY * 0.002);
    view.scale = Math.min(40, Math.max(1, view.scale));
    view.x += x / before - x / view.scale;
    view.y += y / before - y / view.scale;
    keep_inside();
    paint();
  }, { passive: false });
  let from = null;
  canvas.addEventListener("pointerdown", event => { from = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", event => {
    if (!from) return;
    const per = chart.width / canvas.clientWidth / view.scale;
    view.x -= (event.clientX - from[0]) * per;
    view.y -= (event.clientY - from[1]) * per;
    from = [event.clientX, event.clientY];
    keep_inside();
    paint();
  });
  canvas.addEventListener("pointerup", () => { from = null; });
  canvas.addEventListener("dblclick", () => { Object.assign(view, { x: 0, y: 0, scale: 1 }); paint(); });
}
for (const id of ["picture-a", "picture-b", "gain"]) byId(id).addEventListener("input", draw);
byId("swap").addEventListener("click", () => {
  const a = byId("picture-a").value;
  byId("picture-a").value = byId("picture-b").value;
  byId("picture-b").value = a;
  draw();
});
addEventListener("resize", paint);

/* ---- the table ---- */
let sorted_by = -1, rising = true;
document.querySelectorAll("#table th").forEach((head, column) => head.addEventListener("click", () => {
  rising = sorted_by === column ? !rising : true;
  sorted_by = column;
  const body = document.querySelector("#table tbody");
  const value = row => {
    const text = row.cells[column].dataset.value ?? row.cells[column].textContent;
    const number = Number(text);
    return text === "" || Number.isNaN(number) ? text : number;
  };
  const rows = [...body.rows].sort((a, b) => {
    const p = value(a), q = value(b);
    const order = typeof p === "number" && typeof q === "number" ? p - q : String(p).localeCompare(String(q));
    return rising ? order : -order;
  });
  body.append(...rows);
  document.querySelectorAll("#table th").forEach(h => h.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", rising ? "ascending" : "descending");
}));

if (points.length) choose(chosen);
)JS";

}  // namespace raytree::benchmarks
