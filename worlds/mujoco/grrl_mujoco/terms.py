"""Relational terms: from a text such as D(lb, R(l1, l2)) to links and joints.

The grammar is that of lib/include/grrl/structure/term.h without actions. A joint connects the link
written last in its first argument with the link written first in each further one. Any identifier may
be a link's name; R, P, D and L are relations and links only before a parenthesis.
"""

import re
from dataclasses import dataclass, field

MAX_LINKS = 16
MAX_DEPTH = 64  # of nested relations
BACKGROUND = "lb"

_WORD = re.compile(r"[A-Za-z0-9_]+")
_NUMBERED = re.compile(r"[lfv][0-9]+")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_PROPERTY = re.compile(r"[a-z][A-Za-z0-9_]*|_")
LONGEST_NAME = 15


class TermError(ValueError):
    """A text that is not a structure. `column` counts from 1; `text` has no position."""

    def __init__(self, column: int, text: str):
        super().__init__(f"1:{column}: {text}")
        self.column = column
        self.text = text


@dataclass
class Structure:
    """Links by name in order of appearance, with their properties; joints (type, a, b) by name."""

    links: dict = field(default_factory=dict)
    joints: list = field(default_factory=list)

    def add_link(self, name: str, properties, column: int) -> None:
        if name not in self.links and len(self.links) == MAX_LINKS:
            raise TermError(column, f"link {name} is one more than the {MAX_LINKS} of a structure")
        known = self.links.setdefault(name, ())
        if properties and known and known != properties:
            raise TermError(column, f"link {name} is given two sets of properties")
        if properties:
            self.links[name] = properties

    def add_joint(self, kind: str, a: str, b: str, column: int) -> None:
        if a == b:
            raise TermError(column, f"link {a} is joined to itself")
        if any({a, b} == {c, d} for _, c, d in self.joints):
            raise TermError(column, f"link {a} is joined twice to {b}")
        for name in (a, b):
            self.add_link(name, (), column)
        self.joints.append((kind, a, b))


class _Parser:
    """Recursive descent; every method returns the links written first and last in what it read."""

    def __init__(self, text: str):
        self.text = text
        self.at = 0
        self.structure = Structure()

    def skip_space(self) -> None:
        while self.at < len(self.text) and self.text[self.at] in " \t\r\n\v\f":
            self.at += 1

    def found(self) -> str:
        word = _WORD.match(self.text, self.at)
        if word:
            return f"'{word.group()[:24]}'"
        return repr(self.text[self.at]) if self.at < len(self.text) else "the end of the text"

    def fail(self, expected: str):
        raise TermError(self.at + 1, f"expected {expected}, found {self.found()}")

    def accept(self, character: str) -> bool:
        self.skip_space()
        if not self.text.startswith(character, self.at):
            return False
        self.at += 1
        return True

    def word(self) -> str:
        self.skip_space()
        match = _WORD.match(self.text, self.at)
        return match.group() if match else ""

    def conjunction(self, depth: int):
        first, last = self.operand(depth)
        while self.accept("&"):
            _, last = self.operand(depth)
        return first, last

    def operand(self, depth: int):
        word = self.word()
        is_head = self.text[self.at + len(word):].lstrip(" \t\r\n\v\f").startswith("(")
        if is_head and word in ("R", "P", "D"):
            return self.relation(word, depth)
        if is_head and word == "L":
            return self.link()
        return self.take_name(word, (), "a link or one of R, P, D")

    def take_name(self, word: str, properties, expected: str):
        if not _NAME.fullmatch(word) or len(word) > LONGEST_NAME:
            self.fail(expected)
        name = f"{word[0]}{int(word[1:])}" if _NUMBERED.fullmatch(word) else word
        column = self.at + 1
        self.at += len(word)
        if name != BACKGROUND:  # a link only if a joint refers to it
            self.structure.add_link(name, properties, column)
        elif properties:
            raise TermError(column, "link lb is the background, without properties")
        return name, name

    def link(self):
        self.at += 1
        if not self.accept("("):
            self.fail("'(' after L")
        properties = []
        while True:
            word = self.word()
            rest = self.text[self.at + len(word):].lstrip(" \t\r\n\v\f")
            if not rest.startswith(","):
                ends = self.take_name(word, tuple(properties), "a property or the name of a link")
                if not self.accept(")"):
                    self.fail("')' after the name of a link")
                return ends
            if not _PROPERTY.fullmatch(word) or _NUMBERED.fullmatch(word) or word == BACKGROUND:
                self.fail("a property")
            properties.append(word)
            self.at += len(word)
            self.accept(",")

    def relation(self, kind: str, depth: int):
        begin = self.at
        self.at += 1
        if depth == MAX_DEPTH:
            raise TermError(begin + 1, "relations nest too deeply")
        if not self.accept("("):
            self.fail("'(' after the letter of a relation")
        arguments = [self.conjunction(depth + 1)]
        while self.accept(","):
            arguments.append(self.conjunction(depth + 1))
        if len(arguments) < 2 or not self.accept(")"):
            self.fail("',' and a further argument" if len(arguments) < 2 else "',', ')' or '&'")
        if kind != "D":
            for first, _ in arguments[1:]:
                self.structure.add_joint(kind, arguments[0][1], first, begin + 1)
        return arguments[0][0], arguments[-1][1]


def parse_term(text: str) -> Structure:
    """The structure of a term; TermError says what is wrong and where."""
    parser = _Parser(text)
    parser.conjunction(0)
    parser.skip_space()
    if parser.at < len(text):
        parser.fail("'&' or the end of the text")
    return parser.structure
