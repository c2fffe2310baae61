# SPDX-License-Identifier: Apache-2.0
"""scripts/doc_commands finds what it is there to find: doc_commands_test.py BUILD_DIRECTORY."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = sys.argv.pop(1)


class DocCommands(unittest.TestCase):
    def run_on(self, text):
        with tempfile.TemporaryDirectory() as directory:
            page = pathlib.Path(directory, "page.md")
            page.write_text(text)
            run = subprocess.run([ROOT / "scripts/doc_commands", "--build", BUILD, page], capture_output=True,
                                 text=True, check=False)
        return run.returncode, run.stdout + run.stderr

    def right(self, text, *parts):
        code, output = self.run_on(text)
        self.assertEqual(code, 0, output)
        for part in parts:
            self.assertIn(part, output)

    def wrong(self, text, *parts):
        code, output = self.run_on(text)
        self.assertEqual(code, 1, output)
        for part in parts:
            self.assertIn(part, output)

    def test_a_right_page_passes(self):
        self.right("Text\n\n    $ echo a b\n    a b\n\n```\n$ echo c; exit 3\nc\n[exit 3]\n```\n",
                   "2 commands run, 0 not run, 0 wrong")

    def test_a_command_of_several_lines(self):
        self.right("    $ cat <<END\n    > a\n    >  b\n    > END\n    a\n     b\n")
        self.right("    $ echo a \\\n        b\n    a b\n")

    def test_a_changed_figure_of_a_real_page_fails(self):
        page = (ROOT / "docs/effects.md").read_text()
        self.right(page)
        self.assertEqual(page.count("R += 15.041 deg/h"), 1)
        self.wrong(page.replace("R += 15.041 deg/h", "R += 15.042 deg/h"), "hemi effects earth_rate", "15.041")

    def test_a_line_missing_or_too_many_fails(self):
        self.wrong("    $ printf 'a\\nb\\n'\n    a\n", "page.md:1")
        self.wrong("    $ echo a\n    a\n    b\n")
        self.right("    $ printf 'a\\nb\\nc\\n'\n    ...\n    c\n")
        self.wrong("    $ printf 'a\\nb\\nc\\n'\n    ...\n    b\n")

    def test_exit_codes(self):
        self.wrong("    $ hemi effects nonsense\n", "exit code 2, not 0")
        self.right("    $ hemi effects nonsense\n    hemi: ...\n    [exit 2]\n")
        self.wrong("    $ true\n    [exit 1]\n", "exit code 0, not 1")

    def test_figures_are_exact_but_where_the_page_says_otherwise(self):
        self.wrong("    $ echo 'rate 1.01 deg/h'\n    rate 1 deg/h\n")
        self.right("<!-- figures within 2 % -->\n\n    $ echo 'rate 1.01 deg/h'\n    rate 1 deg/h\n")
        self.wrong("<!-- figures within 2 % -->\n\n    $ echo 'rate 1.03 deg/h'\n    rate 1 deg/h\n")
        self.wrong("<!-- figures within 2 % -->\n\n    $ echo 'rate 1 deg/h'\n    angle 1 deg/h\n")

    def test_an_unmarked_command_fails_and_a_marked_one_is_listed(self):
        self.wrong("    hemi info\n", "neither run")
        self.wrong("```\nscripts/test\n```\n", "neither run")
        self.right("<!-- not run: needs a board -->\n\n    hemi run --port /dev/ttyUSB1\n",
                   "not run: page.md:3: hemi run --port /dev/ttyUSB1", "needs a board")

    def test_a_mark_holds_for_one_block(self):
        self.wrong("<!-- not run: minutes -->\n\n    hemi prove\n\nThen\n\n    hemi info\n", "line 7")
        self.wrong("<!-- not run: minutes -->\n\nNo block.\n", "stands before no block")

    def test_what_is_named_must_exist(self):
        self.right("`hemi run --port` and `scripts/test --quick` and `hemi COMMAND --help`\n")
        self.wrong("`hemi run --prot`\n", "hemi run has no option --prot")
        self.wrong("`hemi walk`\n", "hemi has no command 'walk'")
        self.wrong("`scripts/tset`\n", "there is no scripts/tset")
        self.wrong("<!-- not run: a synopsis -->\n\n    hemi run --prot X\n", "has no option --prot")

    def test_setup_runs_and_commands_share_a_directory(self):
        self.right("<!-- setup: echo 5 > five -->\n\n    $ cat five\n    5\n\nText\n\n    $ cat five five\n    5\n    5\n")

    def test_the_page_ends_what_it_left_in_the_background(self):
        with tempfile.NamedTemporaryFile("r") as pid:
            self.right(f"    $ sleep 1000 & echo $! > {pid.name}\n    $ kill -0 $(cat {pid.name})\n")
            state = pathlib.Path("/proc", pid.read().strip(), "stat")
            # Dead, whether or not its new parent has taken notice.
            self.assertTrue(not state.exists() or state.read_text().split()[2] == "Z")


if __name__ == "__main__":
    unittest.main()
