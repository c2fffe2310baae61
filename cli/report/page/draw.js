// SPDX-License-Identifier: Apache-2.0
// Drawn beside uPlot's own lines: stretches, guides, intervals, markers.
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
