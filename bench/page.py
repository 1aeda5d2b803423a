"""What programs need that write tables into pages of docs/."""

import math


def quantile(values, part):
    """The smallest value that so large a part of all is not above."""
    return sorted(values)[max(math.ceil(part * len(values)), 1) - 1]


def put(page, name, text):
    """Replaces what is between <!-- bench/NAME --> and <!-- /bench/NAME --> in the file."""
    begin, end = f"<!-- bench/{name} -->", f"<!-- /bench/{name} -->"
    with open(page, encoding="utf-8") as file:
        head, rest = file.read().split(begin)
    with open(page, "w", encoding="utf-8") as file:
        file.write(head + begin + text + end + rest.split(end)[1])
