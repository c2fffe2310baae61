# SPDX-License-Identifier: Apache-2.0
"""A ringing resonator from raw samples: frequency, drift, amplitude, quality factor."""

import math
import pathlib

from job import ENGINES, EXAMPLES, RECORDINGS, RESULTS, all_engines, columns, output, plot, run as run_program, short, \
    write_columns

DEBIAN_BELL = pathlib.Path("/usr/share/sonic-pi/samples/perc_bell.flac")
FROM_S, TO_S = 0.5, 2.5


def capture():
    """Path, what it is, start frequency [Hz]."""
    for path in (DEBIAN_BELL, RECORDINGS / "bell.wav"):
        if path.exists():
            return path, "a real struck bell, 44.1 kS/s (sonic-pi-samples, perc_bell, CC0)", 3621
    path = RESULTS / "ring_down.raw.csv"
    run_program(EXAMPLES, "capture", "--seconds", 3, "--damping-s", 0.9, "--offset-hz", -0.5, "--drift-hz-per-s", 0.08,
                "-o", path)
    return path, "a synthetic ring-down, 100 kS/s: no recording of a bell is at hand", 4425


def smooth(time, values, width_s):
    """Moving average with a raised cosine of `width_s`: nothing left of the beat between the two partials."""
    period = (time[-1] - time[0]) / (len(time) - 1)
    half = round(width_s / period / 2)
    weights = [1 + math.cos(math.pi * k / (half + 1)) for k in range(-half, half + 1)]
    total = sum(weights)
    return [sum(w * v for w, v in zip(weights, values[i - half:i + half + 1])) / total if half <= i < len(values) - half
            else float("nan") for i in range(len(values))]


def run(report):
    path, what, start_hz = capture()
    report.section("Raw capture: a ringing resonator")
    summaries = all_engines(path, "bell", "--frequency", start_hz, "--from", FROM_S, "--to", TO_S, ideal=True)
    report.add(f"`{short(path)}`: {what}; figures from {FROM_S} s to {TO_S} s. The files of the engines "
               f"{', '.join(ENGINES)} are the same bytes.")
    rows = []
    for engine, s in summaries.items():
        quality = f"{s['quality_factor']:.0f} +- {s['quality_factor_error']:.0f}" if "quality_factor" in s else "-"
        rows.append([engine, f"{s['frequency_hz']:.6f}", f"{s['start_hz']:.4f}", f"{s['end_hz']:.4f}",
                     f"{s['drift_ppm']:+.2f}", f"{s['amplitude'][0]:.6f}", f"{s['amplitude'][1]:.6f}", quality,
                     f"{100 * s['locked_share']:.1f}"])
    report.table(["engine", "frequency Hz", "start Hz", "end Hz", "drift ppm", "amplitude, start", "end",
                  "quality factor", "locked %"], rows)
    time, frequency, amplitude = columns(output("bell", "hls"), "time_s", "frequency_hz", "amplitude")
    write_columns(RESULTS / "bell.smooth.csv", time_s=time, frequency_hz=frequency,
                  smooth_frequency_hz=smooth(time, frequency, 0.5), amplitude=amplitude)
    plot("bell", centre_hz=round(summaries["hls"]["frequency_hz"]))
    report.figure("bell", "Frequency and amplitude of the bell")
