#!/usr/bin/env python3
"""Writes the tables of letters beside this file from the fonts STIX Two Text and STIX Two Math.

    npm pack @expo-google-fonts/stix-two-text@0.4.2     # STIX Two Text 2.13
    npm pack @expo-google-fonts/stix-two-math@0.4.0     # STIX Two Math 2.12: arrows and signs that the text font lacks
    pip install fonttools==4.68.0
    python3 make.py FOLDER                              # the folder that holds the unpacked fonts, at any depth

The files of @fontsource/stix-two-text hold the same outlines, cut into subsets without superscripts and arrows, and
without the kerning from one subset to another.

A line of regular.txt and italic.txt is one letter: its code point, its advance in thousandths of the size, and its
outline: the data of an SVG path with relative commands (m l h v q z) in whole thousandths, y up; or, for a letter with an
accent, `+CODE,RIGHT,UP` for each outline that it is put together from. Parts that are no letters themselves have numbers
beyond the last code point, 10FFFF.

regular.kern.txt and italic.kern.txt hold the kerning: a line `left CHARACTERS` or `right CHARACTERS` is a class of
letters that kern alike on that side of a pair (they are counted from 0), a line `LEFT RIGHT THOUSANDTHS` moves the right
letter of a pair. CHARACTERS are code points.
"""

import sys
from pathlib import Path

from fontTools.pens.basePen import decomposeQuadraticSegment
from fontTools.pens.recordingPen import RecordingPen
from fontTools.ttLib import TTFont

TEXT = [
    (0x20, 0x7E), (0xA0, 0x17F), (0x192, 0x192), (0x218, 0x21B), (0x2BC, 0x2BC), (0x2C6, 0x2DD),
    (0x300, 0x30C), (0x323, 0x328), (0x370, 0x3FF), (0x400, 0x45F), (0x490, 0x491), (0x1E80, 0x1E85),
    (0x1E9E, 0x1E9E), (0x1EA0, 0x1EF9), (0x2002, 0x200A), (0x2010, 0x201E), (0x2020, 0x2022), (0x2026, 0x2026),
    (0x202F, 0x2030), (0x2032, 0x2034), (0x2039, 0x203A), (0x2044, 0x2044), (0x2070, 0x209C), (0x20AC, 0x20AC),
    (0x2103, 0x2103), (0x210F, 0x210F), (0x2113, 0x2113), (0x2116, 0x2116), (0x2122, 0x2122), (0x2126, 0x2126),
    (0x212B, 0x212B), (0x2153, 0x215E), (0x2212, 0x2212), (0x2215, 0x2215),
]
# For the regular style only; each is an outline of its own there.
MATH = "←↑→↓↔⇒⇔∂∆∇∈∏∑√∝∞∠∥∫∼≃≈≠≡≤≥≪≫⊥⋅"
NO_LETTER = 0x110000


def numbers(values):
    """Numbers with a blank only where one would run into the next."""
    text = ""
    for value in map(str, values):
        text += value if not text or value.startswith("-") else " " + value
    return text


class Outline:
    """The data of an SVG path with relative commands; a command that is repeated is not written again."""

    def __init__(self):
        self.text, self.command = "", ""
        self.at = self.start = (0, 0)

    def add(self, command, values):
        again = command == self.command and command not in "mz"
        written = numbers(values)
        if again and not written.startswith("-"):
            written = " " + written
        self.text += written if again else command + written
        self.command = command

    def move(self, to):
        self.add("m", (to[0] - self.at[0], to[1] - self.at[1]))
        self.at = self.start = to

    def line(self, to):
        dx, dy = to[0] - self.at[0], to[1] - self.at[1]
        if dx and dy:
            self.add("l", (dx, dy))
        elif dx:
            self.add("h", (dx,))
        elif dy:
            self.add("v", (dy,))
        self.at = to

    def curve(self, control, to):
        x, y = self.at
        self.add("q", (control[0] - x, control[1] - y, to[0] - x, to[1] - y))
        self.at = to

    def close(self):
        self.add("z", ())
        self.at = self.start


def whole(point):
    """A point in whole units: half units, which arise between two control points, are rounded up."""
    return (int((point[0] + 0.5) // 1), int((point[1] + 0.5) // 1))


def outline(font, glyph, code_of):
    """The third column of a glyph's line; `code_of` gives the number of a part."""
    pen = RecordingPen()
    font.getGlyphSet()[glyph].draw(pen)
    path, parts = Outline(), []
    for command, points in pen.value:
        if command == "addComponent":
            name, (xx, xy, yx, yy, dx, dy) = points
            if (xx, xy, yx, yy) != (1, 0, 0, 1):
                raise ValueError(f"{glyph}: a part of it is turned or scaled")
            parts.append(f"+{code_of(name):04X},{dx},{dy}")
        elif command == "moveTo":
            path.move(whole(points[0]))
        elif command == "lineTo":
            path.line(whole(points[0]))
        elif command == "qCurveTo" and points[-1] is not None:
            for control, to in decomposeQuadraticSegment(points):
                path.curve(whole(control), whole(to))
        elif command == "closePath":
            path.close()
        else:
            raise ValueError(f"{glyph}: {command}")
    if parts and path.text:
        raise ValueError(f"{glyph}: both parts and an outline")
    return " ".join(parts) or path.text


def kerning(font):
    """The function (left glyph, right glyph) -> thousandths, from the pairs of the feature kern for Latin."""
    table = font["GPOS"].table
    lookups = sorted({i for f in table.FeatureList.FeatureRecord if f.FeatureTag == "kern" for i in f.Feature.LookupListIndex})
    subtables = []
    for index in lookups:
        lookup = []
        for sub in table.LookupList.Lookup[index].SubTable:
            sub = sub.ExtSubTable if sub.LookupType == 9 else sub
            if sub.LookupType != 2:
                raise ValueError(f"kern by a lookup of type {sub.LookupType}")
            lookup.append((sub, {g: i for i, g in enumerate(sub.Coverage.glyphs)}))
        subtables.append(lookup)

    def one(sub, place, right):
        """The shift of a pair, or None where this subtable says nothing of it."""
        if sub.Format == 1:
            for record in sub.PairSet[place].PairValueRecord:
                if record.SecondGlyph == right:
                    return getattr(record.Value1, "XAdvance", 0) or 0
            return None
        first = sub.ClassDef1.classDefs
        second = sub.ClassDef2.classDefs
        left = sub.Coverage.glyphs[place]
        value = sub.Class1Record[first.get(left, 0)].Class2Record[second.get(right, 0)].Value1
        return getattr(value, "XAdvance", 0) or 0

    def pair(left, right):
        total = 0
        for lookup in subtables:
            for sub, places in lookup:
                if left in places:
                    shift = one(sub, places[left], right)
                    if shift is not None:
                        total += shift
                        break
        return total

    return pair


def classes(rows):
    """Letters with equal rows, in the order of their first member; the all-zero row is left out."""
    found = {}
    for letter, row in rows.items():
        if any(row):
            found.setdefault(row, []).append(letter)
    return found


def codes(letters):
    return " ".join(f"{ord(c):04X}" for c in letters)


def lines(font, letters):
    """The lines of these letters of one font, and of the parts that they need, by their numbers."""
    cmap = font.getBestCmap()
    numbers = {cmap[ord(c)]: ord(c) for c in letters}
    todo = [(ord(c), cmap[ord(c)]) for c in letters]

    def code_of(part):
        if part not in numbers:
            numbers[part] = NO_LETTER + sum(n >= NO_LETTER for n in numbers.values())
            todo.append((numbers[part], part))
        return numbers[part]

    found = {}
    while todo:
        code, glyph = todo.pop(0)
        advance, _ = font["hmtx"][glyph]
        found[code] = f"{code:04X} {advance} {outline(font, glyph, code_of)}".rstrip()
    return found


def write_letters(path, text, math):
    cmap = text.getBestCmap()
    letters = [chr(c) for a, b in TEXT for c in range(a, b + 1) if c in cmap]
    found = lines(text, letters)
    if math:
        found |= lines(math, [c for c in MATH if ord(c) not in found])
    path.write_text("".join(f"{line}\n" for _, line in sorted(found.items())), encoding="ascii")
    return sorted(letters)


def write_kerning(path, font, letters):
    cmap, pair = font.getBestCmap(), kerning(font)
    value = {(a, b): pair(cmap[ord(a)], cmap[ord(b)]) for a in letters for b in letters}
    lefts = classes({a: tuple(value[a, b] for b in letters) for a in letters})
    rights = classes({b: tuple(value[a, b] for a in letters) for b in letters})
    with path.open("w", encoding="ascii", newline="\n") as out:
        for name, found in (("left", lefts), ("right", rights)):
            for members in found.values():
                out.write(f"{name} {codes(members)}\n")
        for i, left in enumerate(lefts.values()):
            for j, right in enumerate(rights.values()):
                if shift := value[left[0], right[0]]:
                    out.write(f"{i} {j} {shift}\n")


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: make.py FOLDER (it holds the fonts; see the top of this file)")
    here = Path(__file__).parent

    def font(name):
        found = sorted(Path(sys.argv[1]).rglob(name))
        if not found:
            sys.exit(f"{sys.argv[1]}: no {name} in it")
        return TTFont(found[0])

    math = font("STIXTwoMath_400Regular.ttf")
    for style, name, extra in [
        ("regular", "STIXTwoText_400Regular.ttf", math),
        ("italic", "STIXTwoText_400Regular_Italic.ttf", None),
    ]:
        text = font(name)
        letters = write_letters(here / f"{style}.txt", text, extra)
        write_kerning(here / f"{style}.kern.txt", text, letters)


if __name__ == "__main__":
    main()
