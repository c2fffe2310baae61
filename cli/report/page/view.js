// SPDX-License-Identifier: Apache-2.0
// What of the samples is in view: tables for uPlot, ranges, and zoom that all plots of one link share.
// uPlot's table: every curve has x of its own, so rows are those of all of them in order; `undefined`
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

// what of y lies over a stretch of x, intervals included, with a margin
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

// zoom: all plots of one link together
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
