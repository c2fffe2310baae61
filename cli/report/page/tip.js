// SPDX-License-Identifier: Apache-2.0
// Exact values under the pointer.
// exact values under the pointer: of the samples within two pixels, the smallest and the largest
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
