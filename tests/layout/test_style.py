"""Pages for users are short and plain: words, stand-ins for nouns, long sentences and figures are counted, and each count may only
fall (docs/style.md). Evidence, the pages of bindings and the comments of public headers have no stand-ins and no long sentences, either."""

import re
import unittest

from repository import files, text_of

# Pages that are read by maintainers, or looked things up in.
INSIDE = {"docs/abi.md", "docs/cost-models.md", "docs/depth-method.md", "docs/engine.md", "docs/grid-counts.md",
          "docs/for-maintainers.md", "docs/renamed.md", "docs/style.md"}
REFERENCE = {"docs/command-line.md", "docs/file-formats.md", "docs/install.md", "docs/limits.md"}
MOST_LINES_OF_README = 130
MOST_WORDS = 1500  # of a page
MOST_WORDS_IN_ALL = 23600
LONG = 35  # words of a sentence
# Per 1,000 words of all pages for users. When the pages get better, the test asks for a lower ceiling.
CEILINGS = {"stand-ins for nouns": 0, "long sentences": 0, "figures": 9.3}
SLACK = .9


def user_pages():
    return ["README.md", *(path for path in files(".md", under="docs")
                           if not path.startswith(("docs/evidence/", "docs/site/")) and path not in INSIDE | REFERENCE)]


def comments_of(text):
    """The comments of a header as paragraphs and lists, without programs and tables, which are indented by four more than text."""
    for pattern, words in ((r"^ \* (?: {4}){1,3}\S.*", ""), (r"^ \* {3}(?=\S)", "* "), (r"^(?: \*)? *", "")):
        text = re.sub(pattern, words, text, flags=re.M)
    return "\n\n".join(re.findall(r"/\*(.*?)\*/", text, flags=re.S))


def other_texts():
    """{path: prose} of what is read beside the pages for users."""
    pages = files(".md", under="docs/evidence") + files("README.md", under="bindings")
    return {path: text_of(path) for path in pages} | {path: comments_of(text_of(path)) for path in files(".h", under="include/vox")}


def words_of(text):
    """Without code, remarks and addresses of links."""
    text = re.sub(r"^```.*?^```|<!--.*?-->", "", text, flags=re.S | re.M)
    return re.findall(r"[\w'’-]+", re.sub(r"\]\([^)]*\)", "]", text))


def prose_of(text):
    """Sentences of paragraphs and lists; no headings, tables, code."""
    text = re.sub(r"^```.*?^```|<!--.*?-->|^#.*?$|^\|.*?$|^    .*?$|`[^`\n]*`|!\[.*?\]\(.*?\)", " code ", text, flags=re.S | re.M)
    text = re.sub(r"\]\([^)]*\)", "]", text)
    paragraphs = re.split(r"\n\s*\n|^\s*(?:[*-]|\d+\.) ", text, flags=re.M)
    return [sentence for part in paragraphs for sentence in re.split(r"(?<=[.!?:])\s+", part) if sentence.strip()]


def is_long(sentence):
    return len(re.sub(r"\bcode\s+(?=code\b)", "", sentence).split()) > LONG  # rows of a table are one word


def counts_of(texts):
    """Per 1,000 words of prose."""
    sentences = [sentence for text in texts for sentence in prose_of(text)]
    prose = " ".join(sentences)
    words = len(prose.split()) / 1000
    return {
        "stand-ins for nouns": len(re.findall(r"\b(?:that|those) of\b|\bthe one\b", prose, flags=re.I)) / words,
        "long sentences": sum(is_long(sentence) for sentence in sentences) / words,
        "figures": len(re.findall(r"(?<![\w.-])\d[\d.,]*", prose)) / words,
    }


class Style(unittest.TestCase):
    def test_length(self):
        lengths = {path: len(words_of(text_of(path))) for path in user_pages()}
        self.assertEqual({path: n for path, n in lengths.items() if n > MOST_WORDS}, {})
        self.assertLessEqual(sum(lengths.values()), MOST_WORDS_IN_ALL)
        self.assertLessEqual(text_of("README.md").count("\n"), MOST_LINES_OF_README)

    def test_counts_only_fall(self):
        for name, count in counts_of([text_of(path) for path in user_pages()]).items():
            with self.subTest(name):
                self.assertLessEqual(count, CEILINGS[name])
                self.assertGreaterEqual(count, SLACK * CEILINGS[name], f"well done: lower the ceiling to {count:.2f}")

    def test_other_texts(self):
        texts = other_texts()
        self.assertGreater(len(texts), 20)
        found = {path: counts_of([text]) for path, text in texts.items()}
        for name in ("stand-ins for nouns", "long sentences"):
            self.assertEqual({path: round(counts[name], 2) for path, counts in found.items() if counts[name]}, {}, name)

    def test_languages_say_how_to_get_them(self):
        """Until a package is published, the page of a language says so, and which lines build it."""
        for language in ("csharp", "js", "mujoco", "python", "rust/voxtet", "rust/voxtet-sys"):
            self.assertIn("Nothing is published yet", text_of(f"bindings/{language}/README.md"), language)

    def test_each_is_noticed(self):
        plain = "The grid finds the contacts. " * 100
        for name, worse in {"stand-ins for nouns": "It is that of the grid. ", "long sentences": "so " * 40 + ". ", "figures": "It takes 12 ms. "}.items():
            self.assertEqual(counts_of([plain])[name], 0)
            self.assertGreater(counts_of([plain + worse])[name], 0)
        header = "/* " + plain + "\n *     for (those of " + "a " * 40 + "\n */\nint those_of; /* so */"
        self.assertEqual(counts_of([comments_of(header)])["stand-ins for nouns"] + counts_of([comments_of(header)])["long sentences"], 0)
        self.assertGreater(counts_of([comments_of(header + "/* those of " + "a " * 40 + "*/")])["long sentences"], 0)
        self.assertEqual(counts_of([plain + "\n```c\nthe one 12\n```\n| 12 | those of |\n`12`"])["figures"], 0)


if __name__ == "__main__":
    unittest.main()
