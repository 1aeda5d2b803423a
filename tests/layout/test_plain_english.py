"""Comments and documents do not use the words of plain_words.py. The public headers: tests/abi/test_header.py."""

import re
import unittest

import plain_words
from repository import files, text_of

# They list the words themselves.
EXCEPT = {"CONTRIBUTING.md"}

# Where comments have a head. Still to be done, since 2026-11-28; nothing is to be added.
WITH_HEADS = ("src", "tools", "scenes", "bench", "tests/support")
WITHOUT_HEADS = ("bench/", *(f"src/{name}/" for name in "mesh reference fast depth cell_size surface grid io".split()))


def comments_of(text):
    """The text with everything blank that is no comment, so that lines keep their numbers."""
    kept = []
    for match in re.finditer(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/|\n|.', text, flags=re.S):
        kept.append(match[0] if match[0].startswith(("//", "/*", "\n")) else " ")
    return "".join(kept)


def faults():
    found = []
    for path in files(".cpp", ".hpp", under="src"):
        found += [(path, *fault) for fault in plain_words.found_in(comments_of(text_of(path)))]
    for path in (path for under in WITH_HEADS for path in files(".cpp", ".hpp", ".h", ".c", under=under)):
        if not path.startswith(WITHOUT_HEADS):
            found += [(path, *fault) for fault in plain_words.headless_in(text_of(path))]
    for path in files(".md"):
        if path not in EXCEPT:
            found += [(path, *fault) for fault in plain_words.found_in(text_of(path))]
    return [f"{path}:{line}: \"{phrase}\": say \"{say}\"" for path, line, phrase, say in found]


class PlainEnglish(unittest.TestCase):
    def test_repository(self):
        found = faults()
        if found:
            self.fail("\n" + "\n".join(found))

    def test_each_word_is_noticed(self):
        for words in ["a visit is dear", "the processor foretells it", "in the\n// mean over boxes", "as ever",
                      "to be mended", "whether it is\n * told by counts", "worth its while", "of its like"]:
            with self.subTest(words=words):
                self.assertEqual(len(list(plain_words.found_in(words))), 1)
        for words in ["the mean of the edges", "a linear map", "to amend", "whoever", "as everybody knows", "told you so"]:
            with self.subTest(words=words):
                self.assertEqual(list(plain_words.found_in(words)), [])

    def test_comments_without_head(self):
        text = "// Of one.\nint x; // The same.\n// As well.\n// The sum\n// As y.\nint As; // of z\nputs(\"// Of\");\n/* As */\n"
        self.assertEqual([line for line, *_ in plain_words.headless_in(text)], [1, 2, 3, 8])

    def test_only_comments_are_read(self):
        text = comments_of('int dear = 1; // fine\nputs("dear // dear"); /* too\n dear */ int x;\n')
        self.assertEqual([line for line, *_ in plain_words.found_in(text)], [3])


if __name__ == "__main__":
    unittest.main()
