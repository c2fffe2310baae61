// SPDX-License-Identifier: Apache-2.0
// Colours, samples as the page holds them, and where to find one.
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
