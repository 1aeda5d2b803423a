"""Anchors of headings as GitHub makes them, so that a link holds there and on the site. tests/layout/test_links.py has the
same rule."""

import re


def slug(text, separator):
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", separator)
