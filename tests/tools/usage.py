"""What vox says about its own use: words it does not know, progress, the manual page and the completions."""

import os
import re
import shutil
import subprocess
import unittest

from command_line import TETS, TWO_TETS, msh
from vox import TOOL, Files, run

COMMANDS = ["demo", "info", "suggest", "collide", "replay", "sweep", "tetrahedralize", "generate"]


class Usage(Files):
    def setUp(self):
        super().setUp()
        self.mesh = self.write("two.msh", msh(TWO_TETS[:5], TETS))

    def generated(self, what):
        done = run("generate", what)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return done.stdout.decode("ascii")

    def options(self, command):
        """The long options that --help shows."""
        return set(re.findall(r"^  (?:-\w,)?(--[a-z-]+)", run(command, "--help").stdout.decode(), re.M))

    def test_words_that_are_not_known(self):
        for arguments, words in (
            (["colide"], "no command 'colide', did you mean 'collide'"),
            (["collied", self.mesh], "no command 'collied', did you mean 'collide'"),
            (["help", "swep"], "no command 'swep', did you mean 'sweep'"),
            (["xyzzy"], "no command 'xyzzy'\n"),
            (["--versoin"], "unexpected option '--versoin', did you mean '--version'"),
            (["collide", self.mesh, "--slef"], "unexpected option '--slef', did you mean '--self'"),
            (["collide", self.mesh, self.mesh, "third"], "unexpected argument 'third'\n"),
        ):
            done = run(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, b""))
            self.assertIn(words, done.stderr.decode())

    def test_numbers_in_words(self):
        done = run("collide", self.mesh, self.mesh, "--limit", -1)
        self.assertIn("--limit: expected a whole number from 0 to 18446744073709551615, found -1", done.stderr.decode())
        done = run("collide", self.mesh, self.mesh, "--repeat", 0)
        self.assertIn("expected a whole number from 1 to 1000000, found 0", done.stderr.decode())
        done = run("collide", self.mesh, self.mesh, "--scale", 0)
        self.assertIn("expected a number other than 0, found 0", done.stderr.decode())

    def test_help(self):
        self.assertEqual(run("help").stdout, run("--help").stdout)
        for command in COMMANDS:
            done = run("help", command)
            self.assertEqual((done.returncode, done.stdout), (0, run(command, "--help").stdout))

    def test_progress(self):
        self.assertEqual(run("info", self.mesh).stderr, b"")
        done = run("info", self.mesh, "--progress")
        self.assertEqual(done.stderr.decode(), f"vox: reading {self.mesh}, 1 kB\n")
        self.assertEqual(done.stdout, run("info", self.mesh).stdout)
        done = run("info", "--", self.mesh, "--progress")  # a file of that name
        self.assertNotIn(b"reading", done.stderr)
        done = run("collide", self.mesh, "--self", "--progress")
        self.assertIn(b"vox: first step\n", done.stderr)  # later ones only after a second each

    def test_manual_page_has_all_options(self):
        page = self.generated("man").replace("\\-", "-")
        for command in COMMANDS:
            part = page[page.index(f".SS vox {command}\n"):].split("\n.SS ")[0]
            options = self.options(command)
            self.assertIn("--help", options)
            for option in options:
                self.assertIn(option, part)
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-ww", "-Tascii"], input=self.generated("man").encode(),
                                  capture_output=True)
            self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_completions_have_all_options(self):
        for shell in "bash", "zsh", "fish":
            text = self.generated(shell)
            for command in COMMANDS:
                self.assertIn(command, text)
                for option in self.options(command):
                    self.assertIn(option[2:] if shell == "fish" else option, text)
            if shutil.which(shell):
                checked = subprocess.run([shell, "-n"], input=text.encode(), capture_output=True)
                self.assertEqual((checked.returncode, checked.stderr), (0, b""))

    @unittest.skipUnless(shutil.which("bash"), "no bash here")
    def test_bash_completes(self):
        def complete(*words):
            script = (self.generated("bash") + f"COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}; _vox; "
                      "printf '%s\\n' \"${COMPREPLY[@]}\"")
            return subprocess.run(["bash", "-c", script], capture_output=True, check=True).stdout.decode().split()
        self.assertEqual(complete("vox", "coll"), ["collide"])
        self.assertEqual(complete("vox", "help", "inf"), ["info"])
        self.assertEqual(complete("vox", "collide", "--no-d"), ["--no-depth"])
        self.assertEqual(complete("vox", "collide", "a", "--engine", "f"), ["fast"])
        self.assertEqual(complete("vox", "generate", "z"), ["zsh"])
        self.assertEqual(complete("vox", "info", "some-file"), [])  # left to bash

    def test_closed_output(self):
        if os.path.exists("/dev/full"):
            with open("/dev/full", "w") as full:
                done = subprocess.run([TOOL, "generate", "man"], stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, 1)


if __name__ == "__main__":
    unittest.main()
