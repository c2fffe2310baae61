# SPDX-License-Identifier: Apache-2.0
"""The paper's Table 1: which order of f(T) do the points support?"""

from job import RESULTS, ROOT, columns, hemi_json, plot, write_columns

POINTS = ROOT / "tests" / "data" / "paper_table1.csv"
MODEL = RESULTS / "hrg.model.json"


def residuals(fit, temperature, frequency):
    x = [t - fit["reference_degc"] for t in temperature]
    return [1e3 * (f - sum(c * t**k for k, c in enumerate(fit["coefficients_hz"]))) for t, f in zip(x, frequency)]


def run(report):
    report.section("Settled points: the paper's Table 1 to f(T)")
    chosen = hemi_json("calibrate", POINTS, "-o", MODEL)["frequency"]
    cubic = hemi_json("calibrate", POINTS, "--order", 3)["frequency"]
    rows = [[f"order {fit['order']}", f"{1e3 * fit['max_residual_hz']:.1f}",
             ", ".join(f"{c:+.9g}" for c in fit["coefficients_hz"])] for fit in (cubic, chosen)]
    report.table(["f(T)", "largest residual mHz", "coefficients Hz/degC^k, about 0 degC"], rows)
    report.add("The program's verdict:\n\n    " + chosen["verdict"].strip().replace("\n", "\n    "))
    temperature, frequency = columns(POINTS, "settled_degc", "frequency_hz")
    write_columns(RESULTS / "table1.residuals.csv", settled_degc=temperature,
                  cubic_mhz=residuals(cubic, temperature, frequency), chosen_mhz=residuals(chosen, temperature, frequency))
    plot("table1", chosen=f"order {chosen['order']}")
    report.figure("table1", "What cubic and quartic leave of Table 1")
