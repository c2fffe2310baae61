// SPDX-License-Identifier: Apache-2.0
// One plot: axes, buttons, keys, fingers, legend.
const axis = (plot, name) => ({
  scale: name,
  label: plot.spec[name].title,
  labelSize: 20, labelGap: name === "x" ? 0 : 4, labelFont: `13px ${plot.font}`, font: `12px ${plot.font}`,
  gap: 5, size: name === "x" ? 24 : (u, values) => Math.max(54, 16 + 7 * Math.max(0, ...(values || []).map(v => (v || "").length))),
  space: name === "x" ? 90 : plot.spec.y.log ? 14 : 34,
  stroke: () => ink.ink, grid: { stroke: () => ink.grid, width: 1 }, ticks: { show: false },
  border: { show: true, stroke: () => ink.soft, width: 1 },
  values: plot.spec[name].log ? logLabels(name) : linearLabels,
  ...(plot.spec[name].log ? { splits: logSplits(name), filter: (u, splits) => splits } : {}),
});
const size = plot => ({ width: Math.max(200, plot.area.clientWidth), height: Number(plot.figure.dataset.height) + (plot.spec.link ? 0 : innerWidth < 640 ? -80 : 0) });
const create = plot => {
  const { spec, area } = plot;
  const live = document.createElement("div");
  live.className = "live";
  live.tabIndex = 0;
  live.setAttribute("role", "group");
  live.setAttribute("aria-label", `${spec.title}: plot; plus and minus zoom, arrow keys move, 0 shows the whole`);
  plot.tip = document.createElement("div");
  plot.tip.className = "tip";
  plot.tip.hidden = true;
  area.append(live, plot.tip);
  const only = type => type === "mousemove" || type === "mouseleave";
  plot.u = new uPlot({
    ...size(plot), legend: { show: false }, padding: [8, 14, 0, 0],
    scales: {
      x: { time: false, auto: false, distr: spec.x.log ? 3 : 1, range: (u, a, b) => [a, b] },
      y: { auto: false, distr: spec.y.log ? 3 : 1, range: (u, a, b) => [a, b] },
    },
    axes: [axis(plot, "x"), axis(plot, "y")],
    series: [{}, ...spec.series.map((s, k) => ({
      label: s.name, scale: "y", stroke: () => ink.series[k % 6], width: 1.3, dash: dashes[k % 6],
      points: { show: false }, ...(s.dots ? { paths: () => null } : {}),
    }))],
    cursor: {
      y: false, points: { show: false }, drag: { x: true, y: false, setScale: false },
      bind: { dblclick: () => () => { zoom(plot, ...whole(plot)); return null; } },
      ...(spec.link ? { sync: { key: spec.link, setSeries: false, scales: ["x", null], filters: { pub: only, sub: only } } } : {}),
    },
    hooks: {
      drawClear: [drawUnder(plot)], drawSeries: [drawSeries(plot)], setCursor: [showTip(plot)],
      setSelect: [u => {
        if (u.select.width > 3) zoom(plot, u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x"));
        u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
      }],
    },
  }, table(spec.series, spec.y.log), live);
  plot.live = live;
  area.classList.add("drawn");
  listen(plot);
};
const tools = plot => {
  const buttons = document.createElement("span");
  buttons.className = "tools";
  for (const [text, name, act] of [
    ["+", "zoom in", () => scaled(plot, 0.5, 0.5)], ["−", "zoom out", () => scaled(plot, 2, 0.5)],
    ["‹", "earlier", () => shifted(plot, -0.25)], ["›", "later", () => shifted(plot, 0.25)],
    ["whole", "show the whole", () => zoom(plot, ...whole(plot))]]) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    button.title = name;
    button.setAttribute("aria-label", name);
    button.addEventListener("click", act);
    buttons.append(button);
  }
  plot.figure.querySelector("figcaption").append(buttons);
};
const listen = plot => {
  const { live, u } = plot;
  u.over.addEventListener("mouseenter", () => { plot.hovered = true; });
  u.over.addEventListener("mouseleave", () => { plot.hovered = false; plot.tip.hidden = true; });
  const keys = {
    "+": () => scaled(plot, 0.5, 0.5), "=": () => scaled(plot, 0.5, 0.5), "-": () => scaled(plot, 2, 0.5), "0": () => zoom(plot, ...whole(plot)),
    ArrowLeft: () => shifted(plot, -0.25), ArrowRight: () => shifted(plot, 0.25), Escape: () => zoom(plot, ...whole(plot)),
  };
  live.addEventListener("keydown", event => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  live.addEventListener("wheel", event => {
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    const box = u.over.getBoundingClientRect();
    scaled(plot, Math.exp(event.deltaY * 0.01), (event.clientX - box.left) / box.width);
  }, { passive: false });
  // One finger reads and moves along, two fingers zoom; up and down stays the page's.
  const fingers = new Map();
  live.addEventListener("pointerdown", event => { if (event.pointerType === "touch") fingers.set(event.pointerId, event.clientX); });
  live.addEventListener("pointermove", event => {
    if (!fingers.has(event.pointerId)) return;
    const box = u.over.getBoundingClientRect(), places = [...fingers.values()];
    const before = fingers.get(event.pointerId);
    fingers.set(event.pointerId, event.clientX);
    if (places.length === 1) { shifted(plot, (before - event.clientX) / box.width); return; }
    const [a, b] = fingers.values(), spread = Math.abs(a - b), was = Math.abs(places[0] - places[1]);
    if (spread > 5 && was > 5) scaled(plot, was / spread, ((a + b) / 2 - box.left) / box.width);
  });
  for (const end of ["pointerup", "pointercancel"]) live.addEventListener(end, event => fingers.delete(event.pointerId));
  plot.figure.querySelectorAll(".legend button").forEach(button => button.addEventListener("click", () => {
    const index = Number(button.dataset.series) + 1, shown = !u.series[index].show;
    button.setAttribute("aria-pressed", String(shown));
    u.setSeries(index, { show: shown });
    show(plot, ...range(plot));
  }));
};
