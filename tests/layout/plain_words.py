"""Words and phrases that this project does not use, each with what it says instead. CONTRIBUTING.md says why."""

import re

WORDS = {
    r"dear(er|est|ly)?": "expensive",
    r"(fore(tells?|told|telling))": "predicts",
    r"as ever": "as usual",
    r"(begin|begins|began|begun|start|starts|started) anew": "starts again",
    r"good for nothing": "only used for",
    r"in the mean": "on average",
    r"of (its|their) like": "of the same kind",
    r"worth (its|their|the) while": "pays off",
    r"worth a thought": "negligible",
    r"matter of luck": "random",
    r"mend(s|ed|ing)?": "repair",
    r"(is|are|was|were|be) told": "is determined, is reported",
    r"told (by|from)": "determined by",
}
GAP = r"\s+(?:(?://|\*|#)\s*)?"  # a phrase may run on to the next line of a comment
PATTERN = re.compile(r"\b(?:" + "|".join(words.replace(" ", GAP) for words in WORDS) + r")\b", re.I)


def found_in(text):
    """(line, phrase, what to say) for each word or phrase of the list."""
    for match in PATTERN.finditer(text):
        phrase = " ".join(re.sub(r"\s(?://|\*|#)\s", " ", match[0]).split())
        say = next(say for words, say in WORDS.items() if re.fullmatch(words, phrase, flags=re.I))
        yield text.count("\n", 0, match.start()) + 1, phrase, say


HEADLESS = re.compile(r'([^"]*)(?://|/\*)\s*(Of|The same|As)\b')


def headless_in(text):
    """(line, word, what to say) for each comment that begins in the middle of a sentence."""
    lines = text.split("\n")
    for number, (line, before) in enumerate(zip(lines, ["", *lines]), 1):
        match = HEADLESS.match(line)
        goes_on = match and not match[1].strip() and before.lstrip().startswith("//")
        if match and not goes_on:
            yield number, match[2], "begin with a noun or a verb"
