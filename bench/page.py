"""Text that programs write into pages of docs/, between two marks there."""


def put(page, name, text):
    """Replaces what is between <!-- bench/NAME --> and <!-- /bench/NAME --> in the file."""
    begin, end = f"<!-- bench/{name} -->", f"<!-- /bench/{name} -->"
    with open(page, encoding="utf-8") as file:
        head, rest = file.read().split(begin)
    with open(page, "w", encoding="utf-8") as file:
        file.write(head + begin + text + end + rest.split(end)[1])
