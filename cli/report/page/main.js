// SPDX-License-Identifier: Apache-2.0
// The page: colours, all plots, what is in sight.
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
