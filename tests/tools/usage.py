"""What vox says about its own use: words it does not know, progress, the manual page and the completions."""

import os
import re
import shlex
import shutil
import subprocess
import time
import unittest

from command_line import TETS, TWO_TETS, msh
from vox import TOOL, Files, run

COMMANDS = ["demo", "info", "check", "suggest", "collide", "replay", "sweep", "resolve", "tetrahedralize", "generate"]


class Usage(Files):
    def setUp(self):
        super().setUp()
        self.mesh = self.write("two.msh", msh(TWO_TETS[:5], TETS))

    def generated(self, what):
        done = run("generate", what)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return done.stdout.decode("ascii")

    def options(self, command):
        """The long options that --help shows, with the words that each accepts."""
        text = run(command, "--help").stdout.decode()
        found = re.findall(r"^  (?:-\w,)?(--[a-z-]+)(?: ([\w-]+(?:\|[\w-]+)+))?", text, re.M)
        self.assertIn("--help", dict(found))
        return {option: choices.split("|") if choices else [] for option, choices in found}

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
        self.assertEqual(done.stderr.decode().splitlines()[0], f"vox: reading {self.mesh}, 1 kB")
        self.assertEqual(done.stdout, run("info", self.mesh).stdout)
        done = run("info", "--", self.mesh, "--progress")  # a file of that name
        self.assertNotIn(b"reading", done.stderr)
        done = run("collide", self.mesh, "--self", "--progress")
        self.assertIn(b"vox: first step\n", done.stderr)  # later ones only after a second each

    @unittest.skipUnless(hasattr(os, "mkfifo"), "no pipes with names here")
    def test_progress_of_reading(self):
        # From a pipe the file comes when the first line is more than a second old, so that the next one is due.
        count = 40000
        points = [(i, i % 2, i % 3) for i in range(count)]
        text = msh(points, [(i, i + 1, i + 2, i + 3) for i in range(1, count - 3)])
        pipe = self.path("pipe.msh")
        os.mkfifo(pipe)
        with subprocess.Popen([TOOL, "info", pipe, "--progress"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE) as vox:
            with open(pipe, "w", encoding="ascii") as file:
                time.sleep(1.1)
                file.write(text)
            shown = vox.communicate(timeout=600)[1].decode().splitlines()
        self.assertEqual(vox.returncode, 0)
        self.assertEqual(shown[0], f"vox: reading {pipe}: 0 %")
        self.assertIn(shown[1], [f"vox: reading {pipe}: {percent} %" for percent in range(1, 50)])

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

    def check_syntax(self, shell, text):
        if shutil.which(shell):
            checked = subprocess.run([shell, "-n"], input=text.encode(), capture_output=True)
            self.assertEqual((checked.returncode, checked.stderr), (0, b""))

    @unittest.skipUnless(shutil.which("bash"), "no bash here")
    def test_bash_completes(self):
        text = self.generated("bash")
        self.check_syntax("bash", text)
        # The last word is to be completed.
        expected = [(["coll"], ["collide"]), (["help", ""], COMMANDS), (["generate", "z"], ["zsh"]),
                    ([""], [*COMMANDS, "help", "-h", "--help", "--version"]),
                    (["info", "some-file"], [])]  # left to bash
        for command in COMMANDS:
            options = self.options(command)
            expected.append(([command, "--"], list(options)))
            for option, choices in options.items():
                expected.append(([command, "a", option], [o for o in options if o.startswith(option)]))
                if choices:
                    expected.append(([command, "a", option, ""], choices))
                    expected.append(([command, "a", option, choices[-1][:-1]], choices[-1:]))
        # Calls the function that is registered for vox, as bash does.
        script = text + "how=$(complete -p vox); how=${how#*-F }\n"
        for words, _ in expected:
            script += f"COMP_WORDS=(vox {shlex.join(words)}); COMP_CWORD={len(words)}; COMPREPLY=(); ${{how%% *}}\n"
            script += "echo ${COMPREPLY[@]}\n"
        done = subprocess.run(["bash", "-c", script], capture_output=True, check=True)
        self.assertEqual(done.stderr, b"")
        replies = done.stdout.decode().splitlines()
        self.assertEqual(len(replies), len(expected))
        for (words, answer), reply in zip(expected, replies):
            self.assertEqual(reply.split(), answer, words)

    def test_zsh_completions(self):
        text = self.generated("zsh")
        self.check_syntax("zsh", text)
        self.assertEqual(re.findall(r"^  '(\w+):", text, re.M), [*COMMANDS, "help"])
        for command in COMMANDS:
            part = re.search(rf"^{command}\)\n  _arguments(.*?)\n  ;;\n", text, re.M | re.S).group(1)
            found = {option: action.split() for option, action in
                     re.findall(r"^    '(--[a-z-]+)\[.*?(?<!\\)\](?::.*:\((.*)\))?", part, re.M)}
            self.assertEqual(found, self.options(command))

    def test_fish_completions(self):
        text = self.generated("fish")
        self.check_syntax("fish", text)
        commands, options = [], {command: {} for command in COMMANDS}
        for line in text.splitlines()[1:]:
            words = shlex.split(line)
            self.assertEqual(words[:4], ["complete", "-c", "vox", "-n"])
            values = {word: words[i + 1] for i, word in enumerate(words[:-1]) if re.fullmatch("-[lad]", word)}
            seen, _, command = words[4].partition(" ")
            if "-l" not in values:
                if seen == "__fish_use_subcommand":
                    commands.append(values["-a"])
            elif seen == "__fish_seen_subcommand_from":
                self.assertEqual("-f" in words, "-a" in values)  # words to choose from, and no files
                options[command]["--" + values["-l"]] = values.get("-a", "").split()
        self.assertEqual(commands, [*COMMANDS, "help"])
        for command in COMMANDS:
            self.assertEqual(options[command], self.options(command))

    def test_closed_output(self):
        if os.path.exists("/dev/full"):
            with open("/dev/full", "w") as full:
                done = subprocess.run([TOOL, "generate", "man"], stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, 1)


if __name__ == "__main__":
    unittest.main()
