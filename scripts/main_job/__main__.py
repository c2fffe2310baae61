# SPDX-License-Identifier: Apache-2.0
"""The main job: real and synthetic recordings through all engines, figures and plots into results/."""

import sys

import bell
import chamber
import mems
import paper
import table1
from job import JobError, RESULTS, Report


def main():
    RESULTS.mkdir(exist_ok=True)
    report = Report()
    try:
        for step in (bell, table1, chamber, paper, mems):
            step.run(report)
        report.write()
    except JobError as error:
        print(f"scripts/run: FAILED: {error}", file=sys.stderr)
        return 1
    print(f"Results: {RESULTS}/summary.md, with the plots (*.svg) and every engine's output (*.csv) beside it")
    return 0


if __name__ == "__main__":
    sys.exit(main())
