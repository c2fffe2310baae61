# SPDX-License-Identifier: Apache-2.0
"""Real chamber recordings of a three-axis MEMS gyro: calibrated on the first 60 %, scored on the rest."""

import json
import math

from job import ENGINES, RECORDINGS, RESULTS, all_engines, averages, columns, hemi_json, output, plot, write_columns

AXES = "xyz"
FITTED_SHARE = 0.6
AVERAGE_ROWS = 20
DPH_PER_DEG_S = 3600.0
# A straight line, so that a cubic in f is a cubic in temperature; the recording's span fits the core's +-64 Hz.
STAND_IN = RESULTS / "mems.stand_in.model.json"
STAND_IN_MODEL = {"format": "hemi-model/1",
                  "frequency": {"reference_degc": 20.0, "coefficients_hz": [4425.0, 1.0], "calibrated_degc": [-25.0, 80.0]}}


def recording(axis):
    return RECORDINGS / f"mems-gyro-chamber-{axis}.csv"


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def deg_s(dph):
    return f"{dph / DPH_PER_DEG_S:.4f}"


def compensate(axis):
    """Row of the table: scatter about the fitted part's mean before, what is left after, on either part."""
    rows = len(columns(recording(axis), "time_s")[0])
    split = int(FITTED_SHARE * rows)
    name, model = f"mems.{axis}", RESULTS / f"mems.{axis}.model.json"
    hemi_json("calibrate", recording(axis), "--base", STAND_IN, "--to", split, "--blocks", 0, "-o", model)
    all_engines(recording(axis), name, "--model", model)
    time, rate, corrected = columns(output(name, "hls"), "time_s", "rate_dph", "compensated_rate_dph")
    mean = sum(rate[:split]) / split
    before = [r - mean for r in rate]
    write_columns(RESULTS / f"{name}.averages.csv", row=averages(time, AVERAGE_ROWS),
                  before_deg_s=[v / DPH_PER_DEG_S for v in averages(before, AVERAGE_ROWS)],
                  after_deg_s=[v / DPH_PER_DEG_S for v in averages(corrected, AVERAGE_ROWS)])
    return split, [axis, deg_s(rms(before[:split])), deg_s(rms(corrected[:split])), deg_s(rms(before[split:])),
                   deg_s(rms(corrected[split:]))]


def verdict(scores):
    worse = [axis for axis, s in scores.items() if s["stepwise"]["held_out_rms_dph"] > s["cubic"]["held_out_rms_dph"]]
    if not worse:
        return "Held out, Eq. (21) is better than the plain cubic on every axis."
    return f"Held out, Eq. (21) is WORSE than the plain cubic on {', '.join(worse)}."


def extrapolation_verdict(rows):
    worse = [row[0] for row in rows if float(row[4]) > float(row[3])]
    return f"On the unseen part compensation makes it WORSE on {', '.join(worse)}." if worse else \
        "On the unseen part compensation helps on every axis."


def run(report):
    report.section("Real chamber recordings of a MEMS gyro")
    if not all(recording(axis).exists() for axis in AXES):
        report.add("Skipped: the recordings are no part of the source. HEMI_SHARED names the folder that holds "
                   "recordings/real/mems-gyro-chamber-{x,y,z}.csv.")
        return
    STAND_IN.write_text(json.dumps(STAND_IN_MODEL, indent=2) + "\n")
    report.add("No frequency is in them: f = 4425 Hz + 1 Hz/degC of the thermometer stands in for it. The time "
               f"stamps are not credible: time counts samples. The engines {', '.join(ENGINES)} write the same bytes. "
               "The first 60 % are fitted; the rest is unseen and leads to 74 degC where the fit has seen 51. rms in deg/s:")
    parts = [compensate(axis) for axis in AXES]
    report.table(["axis", "before, first 60 %", "after", "before, rest", "after"], [row for _, row in parts])
    report.add(extrapolation_verdict([row for _, row in parts]))
    scores = {axis: hemi_json("calibrate", recording(axis), "--base", STAND_IN)["scores"] for axis in AXES}
    report.add("The whole recording, in sample and on 8 contiguous blocks held out, rms in deg/s:")
    report.table(["axis", "Eq. (21) stepwise, in sample", "held out", "plain cubic, in sample", "held out"],
                 [[axis] + [deg_s(s[model][key]) for model in ("stepwise", "cubic")
                            for key in ("in_sample_rms_dph", "held_out_rms_dph")] for axis, s in scores.items()])
    report.add(verdict(scores))
    plot("mems", split=parts[0][0])
    report.figure("mems", "Rate of the MEMS gyro before and after compensation")
