// SPDX-License-Identifier: Apache-2.0
// Brings the page's plots to life: zoom on linked axes, exact values under the pointer, curves on and off.
"use strict";
(() => {
  const root = document.documentElement;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const plots = [];
  const style = name => getComputedStyle(root).getPropertyValue(name).trim();
  let ink = {};
  const readColours = () => {
    ink = { soft: style("--soft"), ink: style("--ink"), grid: style("--grid"), shade: style("--shade"), quiet: style("--quiet"), attention: style("--attention") };
    ink.series = [0, 1, 2, 3, 4, 5].map(i => style("--s" + i));
  };
  const dashes = [[], [7, 3], [2, 3], [9, 3, 2, 3], [12, 5], [4, 2, 1, 2]];

  const doubles = text => {
    if (!text) return null;
    const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
    return new Float64Array(bytes.buffer);
  };

  // First index with x[i] >= value.
  const lowerBound = (x, value) => {
    let low = 0, high = x.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (x[middle] < value) low = middle + 1; else high = middle;
    }
    return low;
  };

  // ---- numbers
  const superscript = n => String(n).replace(/./g, c => c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]);
  const minus = text => text.replace(/^-/, "−");
  const powers = value => {
    const [mantissa, exponent] = value.toExponential(3).split("e").map(Number);
    return (mantissa === 1 ? "" : minus(String(mantissa)) + "·") + "10" + superscript(exponent);
  };
  const linearLabels = (u, splits, axis, space, step) => {
    const largest = Math.max(...splits.map(Math.abs));
    // As many as the step has: 0.2 has one, 2.5 too.
    const first = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), inUnits = step * 10 ** first;
    const digits = Math.abs(inUnits - Math.round(inUnits)) > 1e-6 ? first + 1 : first;
    const plain = largest < 1e6 && (digits <= 7 || largest >= 1);
    return splits.map(v => v === 0 ? "0" : plain ? minus(v.toFixed(Math.min(digits, 15))) : powers(v));
  };
  const logLabels = axis => (u, splits) => {
    const { min, max } = u.scales[axis];
    const few = Math.log10(max / min) < 2;
    const every = Math.max(1, Math.floor(Math.log10(max / min) / 8));
    return splits.map(v => {
      const exponent = Math.floor(Math.log10(v) + 1e-9), mantissa = Math.round(v / 10 ** exponent);
      if (!((mantissa === 1 && exponent % every === 0) || (few && (mantissa === 2 || mantissa === 5)))) return "";
      return exponent >= -3 && exponent <= 4 ? String(Number(v.toPrecision(6))) : powers(Number(v.toPrecision(6)));
    });
  };
  const logSplits = axis => u => {
    const { min, max } = u.scales[axis], splits = [];
    for (let e = Math.floor(Math.log10(min)); e <= Math.ceil(Math.log10(max)); ++e)
      for (let m = 1; m <= 9; ++m) {
        const v = Number(m + "e" + e);
        if (v >= min && v <= max) splits.push(v);
      }
    return splits;
  };
  const quantity = (value, unit) => minus(String(value)) + (unit && unit !== "1" ? " " + unit : "");

  // ---- uPlot's table: every curve has x of its own, so rows are those of all of them in order; `undefined`
  // is passed over, null breaks the line.
  const table = (series, logY) => {
    const at = series.map(() => 0);
    const rows = series.reduce((n, s) => n + s.x.length, 0);
    const columns = [new Float64Array(rows), ...series.map(() => new Array(rows))];
    for (let row = 0; row < rows; ++row) {
      let next = -1;
      for (let k = 0; k < series.length; ++k)
        if (at[k] < series[k].x.length && (next < 0 || series[k].x[at[k]] < series[next].x[at[next]])) next = k;
      const i = at[next]++, y = series[next].y[i];
      columns[0][row] = series[next].x[i];
      columns[next + 1][row] = Number.isNaN(y) || (logY && !(y > 0)) ? null : y;
    }
    return columns;
  };

  // ---- what of y lies over a stretch of x, intervals included, with a margin
  const yRange = (plot, min, max) => {
    const log = plot.spec.y.log;
    let low = Infinity, high = -Infinity;
    const take = v => { if (v < low && (!log || v > 0)) low = v; if (v > high) high = v; };
    plot.spec.series.forEach((s, k) => {
      if (!plot.u.series[k + 1].show) return;
      const first = Math.max(0, lowerBound(s.x, min) - 1), end = Math.min(s.x.length, lowerBound(s.x, max) + 1);
      for (let i = first; i < end; ++i) {
        take(s.y[i]);
        if (s.lower) { take(s.lower[i]); take(s.upper[i]); }
      }
    });
    if (!(low <= high)) return log ? [0.1, 1] : [0, 1];
    if (log) {
      const factor = Math.max((high / low) ** 0.06, 1.1);
      return [low / factor, high * factor];
    }
    const least = 1e-13 * Math.max(Math.abs(low), Math.abs(high));
    const margin = high - low > least ? 0.06 * (high - low) : low === 0 ? 1 : Math.max(0.01 * Math.abs(low), least);
    return [low - margin, high + margin];
  };
  // Plots out of sight follow one by one, when nothing else is to be done.
  const waiting = new Set();
  const show = (plot, from, to) => {
    waiting.delete(plot);
    const [min, max] = yRange(plot, from, to);
    plot.u.batch(() => {
      plot.u.setScale("x", { min: from, max: to });
      plot.u.setScale("y", { min, max });
    });
  };

  const drawWaiting = () => {
    const [plot] = waiting;
    if (!plot) return;
    waiting.delete(plot);
    show(plot, ...plot.view);
    if (waiting.size > 0) setTimeout(drawWaiting);
  };
  const later = plot => {
    if (waiting.size === 0) requestAnimationFrame(() => setTimeout(drawWaiting));
    waiting.add(plot);
  };

  // ---- zoom: all plots of one link together
  const group = plot => plot.spec.link ? plots.filter(p => p.spec.link === plot.spec.link) : [plot];
  const whole = plot => {
    const extents = group(plot).map(p => p.spec.extent);
    return [Math.min(...extents.map(e => e[0])), Math.max(...extents.map(e => e[1]))];
  };
  const zoom = (plot, from, to) => {
    const [low, high] = whole(plot);
    const least = plot.spec.x.log ? 0 : (high - low) * 1e-9;
    if (!(to - from > least)) return;
    from = Math.max(from, low);
    to = Math.min(to, high);
    if (!(to > from)) return;
    for (const p of group(plot)) {
      p.view = [from, to];
      showCommand(p, from, to);
      if (p.inView || p === plot) show(p, from, to); else later(p);
    }
  };
  const range = plot => plot.view;
  // By a factor about a place (share of the width), and along by a share; on log axes in their own measure.
  const scaled = (plot, factor, about) => {
    const f = plot.spec.x.log ? Math.log : v => v, g = plot.spec.x.log ? Math.exp : v => v;
    const [a, b] = range(plot).map(f), c = a + (b - a) * about;
    const [low, high] = whole(plot).map(f);
    zoom(plot, g(Math.max(low, c + (a - c) * factor)), g(Math.min(high, c + (b - c) * factor)));
  };
  const shifted = (plot, share) => {
    const f = plot.spec.x.log ? Math.log : v => v, g = plot.spec.x.log ? Math.exp : v => v;
    const [a, b] = range(plot).map(f), [low, high] = whole(plot).map(f);
    const by = Math.min(Math.max((b - a) * share, low - a), high - b);
    zoom(plot, g(a + by), g(b + by));
  };
  const showCommand = (plot, from, to) => {
    const code = plot.figure.querySelector(".stretch code");
    if (!code) return;
    const digits = Math.max(0, 3 - Math.floor(Math.log10(to - from)));
    const text = v => String(Number(v.toFixed(Math.min(digits, 12))));
    code.textContent = plot.spec.command.replace("{from}", text(from)).replace("{to}", text(to));
  };

  // ---- drawing beside uPlot's own lines
  const marker = (path, shape, x, y, r) => {
    switch (shape % 6) {
      case 0: path.moveTo(x + r, y); path.arc(x, y, r, 0, 7); break;
      case 1: path.rect(x - r, y - r, 2 * r, 2 * r); break;
      case 2: path.moveTo(x, y - 1.3 * r); path.lineTo(x + 1.2 * r, y + 0.8 * r); path.lineTo(x - 1.2 * r, y + 0.8 * r); path.closePath(); break;
      case 3: path.moveTo(x, y - 1.3 * r); path.lineTo(x + 1.3 * r, y); path.lineTo(x, y + 1.3 * r); path.lineTo(x - 1.3 * r, y); path.closePath(); break;
      case 4: path.moveTo(x, y + 1.3 * r); path.lineTo(x + 1.2 * r, y - 0.8 * r); path.lineTo(x - 1.2 * r, y - 0.8 * r); path.closePath(); break;
      default: path.rect(x - 1.2 * r, y - 0.35 * r, 2.4 * r, 0.7 * r); path.rect(x - 0.35 * r, y - 1.2 * r, 0.7 * r, 2.4 * r);
    }
  };
  const clipped = (u, draw) => {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    draw(ctx, bbox);
    ctx.restore();
  };
  const drawUnder = plot => u => clipped(u, (ctx, box) => {
    const px = devicePixelRatio;
    ctx.font = `${12 * px}px ${getComputedStyle(document.body).fontFamily}`;
    for (const s of plot.spec.shades) {
      const a = Math.max(box.left, u.valToPos(s.from, "x", true)), b = Math.min(box.left + box.width, u.valToPos(s.to, "x", true));
      if (b < box.left || a > box.left + box.width) continue;
      ctx.fillStyle = s.quiet ? ink.quiet : ink.shade;
      ctx.fillRect(a, box.top, Math.max(px, b - a), box.height);
      ctx.strokeStyle = s.quiet ? ink.soft : ink.attention;
      ctx.lineWidth = 0.75 * px;
      ctx.setLineDash([px, 3 * px]);
      ctx.strokeRect(a, box.top, Math.max(px, b - a), box.height);
      if (s.label && ctx.measureText(s.label).width < b - a - 8 * px) {
        ctx.fillStyle = s.quiet ? ink.soft : ink.attention;
        ctx.textAlign = "left";
        ctx.textBaseline = "top";
        ctx.fillText(s.label, a + 5 * px, box.top + 4 * px);
      }
    }
    ctx.setLineDash([7, 3, 1, 3].map(d => d * px));
    ctx.strokeStyle = ctx.fillStyle = ink.soft;
    ctx.lineWidth = px;
    for (const g of plot.spec.guides) {
      const [x0, x1] = g.x.map(v => u.valToPos(v, "x", true)), [y0, y1] = g.y.map(v => u.valToPos(v, "y", true));
      ctx.beginPath();
      ctx.moveTo(x0, y0);
      ctx.lineTo(x1, y1);
      ctx.stroke();
      ctx.textAlign = "right";
      ctx.textBaseline = "bottom";
      // The name stands where the line leaves the plot, to the right or below.
      const bottom = box.top + box.height - 4 * px;
      const leaves = y1 > bottom ? x0 + (bottom - y0) * (x1 - x0) / (y1 - y0) : x1;
      const x = Math.min(leaves, box.left + box.width) - 4 * px;
      const y = x1 === x0 ? y1 : y0 + (y1 - y0) * (x - x0) / (x1 - x0);
      ctx.fillText(g.name, x, Math.max(y - 3 * px, box.top + 16 * px));
    }
  });
  const drawSeries = plot => (u, index) => {
    const s = plot.spec.series[index - 1];
    if (!u.series[index].show) return;
    clipped(u, (ctx, box) => {
      const px = devicePixelRatio, { min, max } = u.scales.x;
      const first = lowerBound(s.x, min), end = Math.min(s.x.length, lowerBound(s.x, max) + 1);
      const path = new Path2D();
      ctx.fillStyle = ctx.strokeStyle = ink.series[(index - 1) % 6];
      if (s.lower) {
        ctx.lineWidth = 1.1 * px;
        ctx.beginPath();
        for (let i = first; i < end; ++i) {
          const x = u.valToPos(s.x[i], "x", true), a = u.valToPos(s.lower[i], "y", true), b = u.valToPos(s.upper[i], "y", true);
          ctx.moveTo(x, a); ctx.lineTo(x, b);
          for (const y of [a, b]) { ctx.moveTo(x - 4 * px, y); ctx.lineTo(x + 4 * px, y); }
        }
        ctx.stroke();
      }
      // A curve that shares its plot carries a marker now and then, each curve at other places; one with intervals
      // has few points, and a marker at each.
      const every = s.dots || s.lower ? 0 : 120 * px;
      let next = box.left + every * (0.25 + 0.17 * (index - 1));
      if (every > 0 && plot.spec.series.length < 2) return;
      for (let i = first; i < end; ++i) {
        if (Number.isNaN(s.y[i])) continue;
        const x = u.valToPos(s.x[i], "x", true);
        if (every > 0 && x < next) continue;
        next = Math.max(next + every, x);
        marker(path, index - 1, x, u.valToPos(s.y[i], "y", true), (s.dots && end - first > 500 ? 1.8 : 3.1) * px);
      }
      ctx.fill(path);
    });
  };

  // ---- exact values under the pointer: of the samples within two pixels, the smallest and the largest
  const readings = (plot, left) => {
    const u = plot.u, a = u.posToVal(left - 2, "x"), b = u.posToVal(left + 2, "x"), lines = [];
    plot.spec.series.forEach((s, k) => {
      if (!u.series[k + 1].show || s.x.length === 0) return;
      let low = -1, high = -1;
      for (let i = lowerBound(s.x, a); i < s.x.length && s.x[i] <= b; ++i) {
        if (Number.isNaN(s.y[i])) continue;
        if (low < 0 || s.y[i] < s.y[low]) low = i;
        if (high < 0 || s.y[i] > s.y[high]) high = i;
      }
      if (low < 0) {
        const c = u.posToVal(left, "x"), after = Math.min(lowerBound(s.x, c), s.x.length - 1), before = Math.max(0, after - 1);
        low = high = Math.abs(s.x[after] - c) < Math.abs(s.x[before] - c) ? after : before;
        if (Number.isNaN(s.y[low])) return;
      }
      for (const i of new Set(s.y[low] === s.y[high] ? [low] : [high, low]))
        lines.push({ name: s.name, x: s.x[i], y: s.y[i], kind: low === high ? "" : i === low ? "smallest " : "largest ", series: s, index: i });
    });
    return lines;
  };
  const showTip = plot => u => {
    const { left, top } = u.cursor;
    // Plots that share the axis show the pointer's line, and the one under the pointer the values.
    if (left < 0 || !plot.hovered) { plot.tip.hidden = true; return; }
    const lines = readings(plot, left);
    plot.tip.replaceChildren();
    for (const line of lines) {
      const row = document.createElement("div"), value = document.createElement("b");
      value.textContent = quantity(line.y, plot.spec.y.unit);
      row.append(line.name + " " + line.kind, value, " at " + quantity(line.x, plot.spec.x.unit));
      if (line.series.lower)
        row.append(", from " + quantity(line.series.lower[line.index]) + " to " + quantity(line.series.upper[line.index]));
      plot.tip.append(row);
    }
    plot.tip.hidden = lines.length === 0;
    if (plot.tip.hidden) return;
    const area = plot.figure.querySelector(".area").getBoundingClientRect(), over = u.over.getBoundingClientRect();
    const x = over.left - area.left + left, width = plot.tip.offsetWidth;
    plot.tip.style.left = Math.max(0, Math.min(x + 14 + width < area.width ? x + 14 : x - 14 - width, area.width - width)) + "px";
    plot.tip.style.top = over.top - area.top + Math.max(0, top) + 14 + "px";
  };

  // ---- one plot
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

  // ---- the page
  const shownDark = () => root.dataset.theme ? root.dataset.theme === "dark" : dark.matches;
  const recolour = () => {
    theme.textContent = shownDark() ? "Light" : "Dark";
    readColours();
    for (const plot of plots) plot.u.redraw(false, true);
  };
  const theme = document.getElementById("theme");
  theme.hidden = false;
  theme.addEventListener("click", () => { root.dataset.theme = shownDark() ? "light" : "dark"; recolour(); });
  dark.addEventListener("change", recolour);
  readColours();
  theme.textContent = shownDark() ? "Light" : "Dark";
  const font = getComputedStyle(document.body).fontFamily;
  for (const figure of document.querySelectorAll("figure.plot")) {
    const spec = JSON.parse(figure.querySelector("script").textContent);
    for (const s of spec.series)
      for (const key of ["x", "y", "lower", "upper"]) s[key] = doubles(s[key]);
    const plot = { figure, spec, font, area: figure.querySelector(".area"), hovered: false };
    tools(plot);
    plots.push(plot);
  }
  for (const plot of plots) create(plot);
  const sight = new IntersectionObserver(changes => {
    for (const change of changes) {
      const plot = plots.find(p => p.figure === change.target);
      plot.inView = change.isIntersecting;
      if (plot.inView && waiting.delete(plot)) show(plot, ...plot.view);
    }
  });
  for (const plot of plots) {
    plot.view = whole(plot);
    show(plot, ...plot.view);
    sight.observe(plot.figure);
  }
  new ResizeObserver(() => { for (const plot of plots) if (plot.area.clientWidth > 0) plot.u.setSize(size(plot)); }).observe(document.querySelector("main"));
  // For tests and for the curious: the plots as they are.
  window.hemiPlots = plots;
  performance.mark("plots");
})();
