# SPDX-License-Identifier: Apache-2.0
"""The paper's experiment in simulation: seven soaks calibrate, room to -20 degC and cycles are compensated unseen."""

from chamber import AVERAGE_S, bias_stability
from job import ENGINES, RESULTS, ROOT, all_engines, hemi, hemi_json, output

SCENARIOS = ROOT / "scripts" / "scenarios"
MODEL = RESULTS / "paper.model.json"
UNSEEN = {"room_to_minus_20": "room to -20 degC, 5 h", "cycles": "two cycles -20..40 degC, 20 h",
          "constant": "20 degC, 5 h: the floor"}
MARKS = [["the paper, on the run that was fitted", "3.0143", "0.5848", "5.15"],
         ["Micromachines 2025, 16, 357", "", "", "17.5"]]


def simulate():
    for name in ("paper_soaks", *UNSEEN):
        hemi("simulate", SCENARIOS / f"{name}.toml", "-o", RESULTS)


def temperatures(report, calibration):
    soaks = calibration["left_out_soaks"]
    rows = [[f"{soak['case_degc']:.3f}", f"{soak['error_degc']:+.5f}",
             "extrapolated" if soak["extrapolated"] else "inside"] for soak in soaks]
    report.table(["soak degC", "error of T(f) fitted on the other six", ""], rows)


def compensation(report):
    rows = []
    for name, what in UNSEEN.items():
        all_engines(RESULTS / f"{name}.csv", f"paper.{name}", "--model", MODEL)
        done = output(f"paper.{name}", "hls")
        before, after = (bias_stability(done, channel) for channel in ("rate_dph", "compensated_rate_dph"))
        rows.append([what, f"{before:.4f}", f"{after:.4f}", f"{before / after:.1f}"])
    report.table(["run (not seen by the fit)", "before deg/h", "after deg/h", "ratio"], rows + MARKS)


def run(report):
    report.section("The paper's experiment, simulated")
    simulate()
    calibration = hemi_json("calibrate", RESULTS / "paper_soaks.csv", "-o", MODEL)
    thermal = calibration["thermal"]
    report.add("Seven soaks of 5 h, the instrument's nominal physics and noise. Fitted: time constant "
               f"{thermal['time_constant_s']:.2f} s, f(T) of order {calibration['frequency']['order']}; terms of Eq. (21) "
               "that survive: " + " ".join(term["term"] for term in calibration["bias"]["terms"])
               + " (the paper's: 1 f f^2 f^3 df df^2 df^3 f*df).")
    temperatures(report, calibration)
    report.add(f"Compensated by the engines {', '.join(ENGINES)}, which write the same bytes; standard deviation of {AVERAGE_S} s "
               "averages. This instrument leaves out nothing that the model has not: a real one does, and its figures will be worse.")
    compensation(report)
