"""A stage of the fast engine has one name: in src/README.md, in its header, among the times of a step, in the stage benchmark,
and in docs/step.dot."""

import re
import unittest

from repository import text_of


def stages_of_readme(text):
    """The numbered list under the heading "Stages": 1. **stream** ..."""
    part = re.search(r"^## .*[Ss]tages.*?(?=^## |\Z)", text, flags=re.S | re.M)
    return re.findall(r"^\d+\. \*\*(\w+)\*\*", part[0], flags=re.M) if part else []


def stages_of_code(text):
    """The list in src/fast/stages.hpp."""
    return re.findall(r'"(\w+)"', re.search(r"stage_names\[\] = \{(.*?)\}", text, flags=re.S)[1])


OF_STEP = {"edges", "margin", "shapes"}  # of either engine


def stages_of_profile(text):
    """The fields of Profile in src/base/counters.hpp that time a stage of the fast engine: those after pairs_ns but OF_STEP."""
    fields = re.findall(r"uint64_t (\w+)_ns\b", re.search(r"struct Profile \{(.*?)\};", text, flags=re.S)[1])
    return [name for name in fields[fields.index("pairs") + 1:] if name not in OF_STEP]


def rows_of_benchmark(text):
    """Names of the rows of bench/stages/stages.cpp: {"name", "element", ...}."""
    return re.findall(r'\{"([^"]+)", "[^"]+",', text)


def stages_of_picture(text):
    """The nodes of docs/step.dot that are stages: lines like `stream [stage`."""
    return re.findall(r"^\s*(\w+) \[class=stage", text, flags=re.M)


def differences(readme, code, profile, benchmark, picture):
    stages = stages_of_readme(readme)
    found = []
    if len(stages) < 2:
        found.append("src/README.md lists no stages")
    if stages_of_code(code) != stages:
        found.append(f"src/fast/stages.hpp has {stages_of_code(code)}, src/README.md {stages}")
    if stages_of_profile(profile) != stages:
        found.append(f"src/base/counters.hpp has {stages_of_profile(profile)}, src/README.md {stages}")
    rows = rows_of_benchmark(benchmark)
    if not set(stages) <= set(rows):
        found.append(f"bench/stages/stages.cpp has the rows {rows}, src/README.md the stages {stages}")
    if stages_of_picture(picture) != stages:
        found.append(f"docs/step.dot has {stages_of_picture(picture)}, src/README.md {stages}")
    return found


class StageNames(unittest.TestCase):
    def test_repository(self):
        found = differences(*(text_of(path) for path in ("src/README.md", "src/fast/stages.hpp", "src/base/counters.hpp",
                                                         "bench/stages/stages.cpp", "docs/step.dot")))
        if found:
            self.fail("\n" + "\n".join(found))

    README = "## Stages of a step\n\n1. **stream** reads\n2. **lookup** asks\n\n## Other\n\n1. **body** is\n"
    CODE = 'inline constexpr const char* stage_names[] = {"stream", "lookup"};\n'
    PROFILE = ("struct Profile {\n uint64_t step_ns = 0;\n uint64_t pairs_ns = 0;\n uint64_t stream_ns = 0; // a\n"
               " uint64_t lookup_ns =\n 0;\n uint64_t edges_ns = 0;\n};\n")
    BENCH = '{"tiles", "tet", t},\n{"stream", "vertex", v,\n[] {}},\n{"sides", "box", b},\n{"lookup", "tet", t},\n'
    PICTURE = "  stream [class=stage]\n  hits [class=data]\n  lookup [class=stage]\n"

    def test_each_difference_is_noticed(self):
        sound = [self.README, self.CODE, self.PROFILE, self.BENCH, self.PICTURE]
        self.assertEqual(differences(*sound), [])
        for place, words in enumerate(["src/base/counters.hpp has", "src/fast/stages.hpp has", "src/base/counters.hpp has",
                                        "bench/stages/stages.cpp", "docs/step.dot"]):
            with self.subTest(words=words):
                changed = list(sound)
                changed[place] = changed[place].replace("lookup", "ask")
                self.assertIn(words, "\n".join(differences(*changed)))
        self.assertIn("lists no stages", "\n".join(differences("", *sound[1:])))


if __name__ == "__main__":
    unittest.main()
