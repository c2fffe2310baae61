# SPDX-License-Identifier: Apache-2.0
"""hemi as a shell sees it: shell_test.py HEMI."""
import json
import os
import pathlib
import pty
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
HEMI = sys.argv.pop(1)


def run(*arguments, **more):
    return subprocess.run([HEMI, *map(str, arguments)], capture_output=True, text=True, check=False, **more)


def commands():
    listed = run("--help").stdout.split("Subcommands:\n")[1].split("\n\n")[0]
    return [line.split()[0] for line in listed.splitlines() if re.match("  [a-z]", line)]


def options(command):
    """Long options by the help text, which CLI11 prints, and completion does not read."""
    own = re.findall(r"^  (?:-\w,)?(--[a-z][a-z0-9-]*)", run(command, "--help").stdout, re.MULTILINE)
    return sorted(set(own))


class Completion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.script = {}
        for shell in ("bash", "zsh", "fish"):
            cls.script[shell] = pathlib.Path(cls.directory.name, shell)
            cls.script[shell].write_text(run("completion", shell).stdout)

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    def bash(self, *words):
        """What bash offers for the last word."""
        quoted = " ".join(f"'{word}'" for word in ("hemi", *words))
        code = (f"source {self.script['bash']}; COMP_WORDS=({quoted}); COMP_CWORD={len(words)}; _hemi; "
                "printf '%s\\n' \"${COMPREPLY[@]}\"; complete -p hemi >&2")
        done = subprocess.run(["bash", "-c", code], capture_output=True, text=True, check=True,
                              cwd=ROOT / "tests/data")
        self.assertIn("-F _hemi hemi", done.stderr)
        return sorted(done.stdout.split())

    def fish(self, line):
        code = f"source {self.script['fish']}; complete -C '{line}'"
        done = subprocess.run(["fish", "--no-config", "-c", code], capture_output=True, text=True, check=True,
                              env=dict(os.environ, HOME=self.directory.name))
        return sorted(entry.split("\t")[0] for entry in done.stdout.splitlines())

    def test_bash_completes_commands_options_words_and_files(self):
        self.assertEqual(self.bash("calib"), ["calibrate"])
        self.assertEqual(self.bash("calibrate", "--held"), ["--heldout"])
        self.assertEqual(self.bash("export", "m.json", "--format", ""), ["c", "mem", "sv"])
        self.assertEqual(self.bash("calibrate", "paper"), ["paper_table1.csv"])
        self.assertEqual(self.bash("run", "-m", "paper"), ["paper_table1.csv"])
        self.assertEqual(self.bash("run", "--window", ""), [])
        self.assertEqual(self.bash("completion", ""), ["bash", "fish", "zsh"])

    def test_bash_and_fish_know_every_command_and_option(self):
        self.assertGreaterEqual(len(commands()), 14)
        self.assertEqual(set(self.bash("")) - {"-h", "--help", "--version"}, set(commands()))
        for command in commands():
            self.assertGreater(len(options(command)), 0, command)
            self.assertEqual(self.bash(command, "--"), options(command), command)
            self.assertEqual(self.fish(f"hemi {command} --"), options(command), command)

    def test_fish_completes(self):
        self.assertEqual(self.fish("hemi calib"), ["calibrate"])
        self.assertEqual(self.fish("hemi export --format "), ["c", "mem", "sv"])

    def test_zsh_takes_its_script(self):
        """In a pseudo-terminal, as zsh completes nowhere else: what Tab makes of a line."""
        setup = (f"fpath=({self.directory.name}/functions $fpath); autoload -Uz compinit; compinit -u -D; "
                 "bindkey '^I' complete-word; PS1='> '\n")
        functions = pathlib.Path(self.directory.name, "functions")
        functions.mkdir()
        (functions / "_hemi").write_text(self.script["zsh"].read_text())
        self.typed(setup, (("hemi calib", "hemi calibrate "), ("hemi export --form", "hemi export --format "),
                           ("hemi report --outp", "hemi report --output ")))

    def typed(self, setup, lines):
        """Types each line and Tab; what then stands there must be the whole with the space behind it."""
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(self.directory.name)
            os.environ.update(TERM="dumb", HOME=self.directory.name)
            os.execvp("zsh", ["zsh", "-f", "-i"])
        seen = ""

        def read_until(part, seconds):
            nonlocal seen
            end = time.monotonic() + seconds
            os.set_blocking(terminal, False)
            while time.monotonic() < end and part not in seen:
                try:
                    seen += os.read(terminal, 4096).decode(errors="replace")
                except BlockingIOError:
                    time.sleep(0.02)
                except OSError:
                    break

        os.write(terminal, (setup + "echo re''ady\n").encode())
        read_until("ready\r\n", 20)
        for line, whole in lines:
            # On a busy machine a line may come before the editor is ready for it: Control-U, and again.
            for _ in range(10):
                seen = ""
                os.write(terminal, b"\x15" + line.encode() + b"\t")
                read_until(whole, 2)
                if whole in seen:
                    break
            self.assertIn(whole, seen)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        os.close(terminal)


class ExitCodes(unittest.TestCase):
    """Those that hemi --help promises; 130: hemi_program_test, Interrupted."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = scratch.name

    def test_they_are_documented(self):
        for place in (run("--help").stdout, (ROOT / "docs/program.md").read_text()):
            for code in ("0", "1", "2", "3", "130"):
                self.assertRegex(place, rf"\b{code}\b")

    def test_good_is_0(self):
        for arguments in (["info"], ["--help"], ["--version"], ["effects", "duffing"]):
            self.assertEqual(run(*arguments).returncode, 0)

    def test_a_misfit_is_1(self):
        table = ROOT / "tests/data/paper_table1.csv"
        self.assertEqual(run("diagnose", table, "-o", self.scratch).returncode, 1)

    def test_bad_input_is_2(self):
        for arguments in ([], ["walk"], ["walk", "--help"], ["run"], ["run", "none.csv"], ["allan", "--prot"], ["simulate", "nowhere"]):
            done = run(*arguments, cwd=self.scratch)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)

    def test_an_internal_error_is_3(self):
        if os.environ.get("HEMI_SANITIZED") == "1":
            self.skipTest("a sanitized program needs terabytes of address space")
        pathlib.Path(self.scratch, "big.toml").write_text('[scenario]\nduration = "5000000 s"\n')
        done = run("simulate", "big.toml", cwd=self.scratch,
                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (250 << 20, 250 << 20)))
        self.assertEqual(done.returncode, 3)
        self.assertIn("internal error", done.stderr)
        self.assertEqual(os.listdir(self.scratch), ["big.toml"])


class Json(unittest.TestCase):
    def test_every_command_has_it(self):
        for command in commands():
            if command != "completion":  # prints a script
                self.assertIn("--json", options(command), command)

    def test_of_the_registers(self):
        with tempfile.TemporaryDirectory() as scratch:
            model = pathlib.Path(scratch, "m.json")
            run("calibrate", ROOT / "tests/data/paper_table1.csv", "-o", model)
            closed = json.loads(run("export", model, "--json").stdout)
            opened = json.loads(run("export", model, "--json", "--open-loop").stdout)
        value = {name: {r["name"]: r["value"] for r in image["registers"]}
                 for name, image in (("closed", closed), ("open", opened))}
        self.assertEqual(len(value["closed"]), 54)
        self.assertEqual((value["closed"]["control"], value["open"]["control"]), (1, 0))
        self.assertEqual(value["closed"]["thermometer_1"], value["open"]["thermometer_1"])

    def test_of_concealed_recordings(self):
        with tempfile.TemporaryDirectory() as scratch:
            said = json.loads(run("prove", "--write-only", "d", "--cases", "1", "--class", "null", "--json",
                                  cwd=scratch).stdout)
            self.assertEqual(said["recordings"], 1)
            self.assertEqual(len(os.listdir(pathlib.Path(scratch, said["truths"]))), 1)


class Doctor(unittest.TestCase):
    def test_says_what_is_missing_and_what_it_would_enable(self):
        with tempfile.TemporaryDirectory() as empty:
            done = run("doctor", "--json", env={"PATH": empty})
        self.assertEqual(done.returncode, 0)
        found = json.loads(done.stdout)
        self.assertGreaterEqual(len(found["tools"]), 8)
        for tool in found["tools"]:
            self.assertFalse(tool["found"])
            self.assertTrue(tool["enables"] and tool["remedy"])
        for version in found["libraries"].values():
            self.assertRegex(version, r"\d+\.\d+")
        self.assertIn("cycles", found["scenarios"])

    def test_finds_a_tool_and_asks_it(self):
        with tempfile.TemporaryDirectory() as directory:
            tool = pathlib.Path(directory, "yosys")
            tool.write_text("#!/bin/sh\necho noise >&2\necho Yosys 99.5\n")
            tool.chmod(0o755)
            path = f"{directory}:/usr/bin:/bin"
            found = {t["name"]: t for t in json.loads(run("doctor", "--json", env={"PATH": path}).stdout)["tools"]}
            text = run("doctor", env={"PATH": path}).stdout
        self.assertEqual(found["yosys"]["path"], str(tool))
        self.assertEqual(found["yosys"]["version"], "Yosys 99.5")
        self.assertRegex(text, r"yosys +found")


class Colour(unittest.TestCase):
    def test_there_is_none_on_a_terminal(self):
        for environment in ({}, {"NO_COLOR": "1"}):
            for arguments in (["info"], ["effects"], ["doctor"], ["--help"], ["walk"]):
                master, slave = pty.openpty()
                child = subprocess.Popen([HEMI, *arguments], stdout=slave, stderr=slave,
                                         env=dict(os.environ, TERM="xterm-256color", **environment))
                os.close(slave)
                seen = b""
                while True:
                    try:
                        part = os.read(master, 65536)
                    except OSError:  # the other end is closed
                        break
                    if not part:
                        break
                    seen += part
                child.wait()
                os.close(master)
                self.assertGreater(len(seen), 20)
                self.assertNotIn(b"\x1b", seen)


if __name__ == "__main__":
    unittest.main()
