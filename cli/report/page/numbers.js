// SPDX-License-Identifier: Apache-2.0
// Numbers at the axes and under the pointer.
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
