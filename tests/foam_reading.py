"""Files of OpenFOAM's syntax, read for tests: entries by name, lists as lists."""

import re

TOKEN = re.compile(r'"[^"]*"|[{}();]|[^\s{}();"]+')


def parsed(text):
    """The entries of a dictionary, or the list of a file that holds one."""
    plain = re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.DOTALL)
    tokens = TOKEN.findall(plain)
    found, rest = _block(tokens, 0)
    assert rest == len(tokens), tokens[rest : rest + 5]
    return found


def _block(tokens, at):
    entries = {}
    while at < len(tokens) and tokens[at] != "}":
        key, at = tokens[at], at + 1
        assert key not in "{}();", (key, tokens[at : at + 5])
        if key.startswith("#"):
            entries[key], at = tokens[at], at + 1
            continue
        if tokens[at] == "{":
            entries[key], at = _block(tokens, at + 1)
            assert tokens[at] == "}"
            at += 1
            continue
        values = []
        while tokens[at] != ";":
            value, at = _value(tokens, at)
            values.append(value)
        entries[key] = values[0] if len(values) == 1 else values
        at += 1
    return entries, at


def _value(tokens, at):
    if tokens[at] == "(":
        at += 1
        members = []
        while tokens[at] != ")":
            if tokens[at] == "{":
                member, at = _block(tokens, at + 1)
                at += 1
            else:
                member, at = _value(tokens, at)
            members.append(member)
        return members, at + 1
    assert tokens[at] not in "{});", tokens[at : at + 5]
    return _word(tokens[at]), at + 1


def _word(token):
    try:
        return float(token)
    except ValueError:
        return token.strip('"')


def rows(path):
    """The rows of a file that holds bare lists of numbers, one a line."""
    return [
        [float(word) for word in line.strip().strip("()").split()]
        for line in path.read_text().splitlines()
        if line.startswith("(")
    ]
