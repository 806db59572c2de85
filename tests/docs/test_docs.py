"""The pages below doc/ are complete: links lead somewhere, techniques and properties are described."""

import json
import os
import re
import struct
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DOC = os.path.join(ROOT, "doc")
GNOMON = os.environ.get("GNOMON", os.path.join(ROOT, "bin", "gnomon"))
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)
MAX_IMAGE_BYTES = 80 * 1024
STORE_SIZE_PX = (1280, 720)  # of the images for Godot's Asset Store, whose thumbnails are 16:9
TIMEOUT_S = 60

sys.path.insert(0, DOC)
import make_classes  # noqa: E402


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def find_pages():
    """Return the paths of README.md and every page below doc/."""
    pages = [os.path.join(ROOT, "README.md")]
    for folder, _, names in os.walk(DOC):
        pages += [os.path.join(folder, name) for name in sorted(names) if name.endswith(".md")]
    return pages


def find_links(path):
    """Return the relative links of a page, without those in code."""
    found = LINK.findall(CODE.sub("", read(path)))
    return [link for link in found if not re.match(r"[a-z]+:", link)]


def make_anchor(heading):
    """Return a heading's anchor as common Markdown renderers make it."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def find_anchors(path):
    return {make_anchor(heading) for heading in re.findall(r"(?m)^#+ (.+)$", read(path))}


def resolve_link(page, link):
    """Return (absolute path, anchor)."""
    target, _, anchor = link.partition("#")
    return os.path.normpath(os.path.join(os.path.dirname(page), target)) if target else page, anchor


def read_jpeg_size(path):
    """Return (width, height) of a JPEG image."""
    with open(path, "rb") as file:
        data = file.read()
    offset = 2  # after the marker that begins the file
    while not 0xC0 <= data[offset + 1] <= 0xC2:  # segments that begin with 0xFF, kind, length; the kinds C0 to C2 have the size
        offset += 2 + struct.unpack_from(">H", data, offset + 2)[0]
    height, width = struct.unpack_from(">HH", data, offset + 5)
    return width, height


def load_techniques():
    """Return the techniques and the mask filters, which have pages of the same kind."""
    found = []
    for command in ("techniques", "filters"):
        result = subprocess.run([GNOMON, command, "--json"], capture_output=True, text=True, timeout=TIMEOUT_S, check=True)
        found += json.loads(result.stdout)
    return found


class LinkTest(unittest.TestCase):
    def test_every_relative_link_leads_to_a_file_and_a_heading(self):
        for page in find_pages():
            for link in find_links(page):
                with self.subTest(page=os.path.relpath(page, ROOT), link=link):
                    target, anchor = resolve_link(page, link)
                    self.assertTrue(os.path.exists(target), "no such file")
                    if anchor:
                        self.assertIn(anchor, find_anchors(target))

    def test_every_page_can_be_reached_from_the_index(self):
        reached, waiting = set(), [os.path.join(DOC, "index.md")]
        while waiting:
            page = waiting.pop()
            if page in reached or not page.endswith(".md") or not os.path.isfile(page):
                continue
            reached.add(page)
            waiting += [resolve_link(page, link)[0] for link in find_links(page)]
        pages = find_pages()[1:]  # without README.md
        missing = [os.path.relpath(page, ROOT) for page in pages if page not in reached]
        self.assertEqual(missing, [])

    def test_every_image_is_used_and_small(self):
        used = {resolve_link(page, link)[0] for page in find_pages() for link in find_links(page)}
        folder = os.path.join(DOC, "images")
        for name in sorted(os.listdir(folder)):
            with self.subTest(image=name):
                path = os.path.join(folder, name)
                self.assertIn(path, used)
                self.assertLessEqual(os.path.getsize(path), MAX_IMAGE_BYTES)


    def test_the_images_for_the_store_have_its_aspect_ratio(self):
        folder = os.path.join(DOC, "images")
        names = [name for name in os.listdir(folder) if name.startswith("godot_store_")]
        self.assertIn("godot_store_thumbnail.jpg", names)
        self.assertGreaterEqual(len(names), 3)
        for name in names:
            with self.subTest(image=name):
                self.assertEqual(read_jpeg_size(os.path.join(folder, name)), STORE_SIZE_PX)


class TechniquePageTest(unittest.TestCase):
    def test_every_technique_has_a_page_that_mentions_each_property(self):
        for technique in load_techniques():
            path = os.path.join(DOC, "techniques", technique["id"] + ".md")
            with self.subTest(technique=technique["id"]):
                self.assertTrue(os.path.isfile(path), "write doc/techniques/%s.md" % technique["id"])
                text = read(path)
                for item in technique["properties"]:
                    self.assertTrue("`%s`" % item["name"] in text, "describe `%s`" % item["name"])

    def test_every_technique_page_has_the_same_parts(self):
        for technique in load_techniques():
            path = os.path.join(DOC, "techniques", technique["id"] + ".md")
            if os.path.isfile(path):
                with self.subTest(technique=technique["id"]):
                    headings = re.findall(r"(?m)^## (.+)$", read(path))
                    required = ["Idea", "Passes and textures", "Parameters", "Known failures", "Measured"]
                    self.assertEqual([name for name in required if name not in headings], [])


class GeneratedPageTest(unittest.TestCase):
    def test_the_pages_of_properties_are_up_to_date(self):
        command = [sys.executable, os.path.join(DOC, "make_classes.py"), "--check"]
        result = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_line_that_is_no_property_is_refused(self):
        heading = make_classes.COMMON_HEADING + "\n"
        with self.assertRaises(SystemExit):
            make_classes.parse_common_properties(heading + "    what is this\n")
        with self.assertRaises(SystemExit):
            make_classes.parse_common_properties("no heading\n")

    def test_a_property_line_is_read_whole(self):
        line = "    light_size = 0.1 (-1 or 0..10 m): Radius (R): of a light.\n"
        found = make_classes.parse_common_properties(make_classes.COMMON_HEADING + "\n" + line)
        self.assertEqual(
            found, [{"name": "light_size", "default": "0.1", "range": "-1 or 0..10 m", "tooltip": "Radius (R): of a light."}]
        )
        line = "    shadow_technique =  (text): Its id.\n"
        found = make_classes.parse_common_properties(make_classes.COMMON_HEADING + "\n" + line)
        self.assertEqual((found[0]["default"], found[0]["range"]), ("", "text"))


class CanaryTest(unittest.TestCase):
    """Tests of this file's own functions and patterns."""

    def test_links_in_code_do_not_count_and_others_do(self):
        self.assertEqual(LINK.findall(CODE.sub("", "`[a](b)` [c](d.md)")), ["d.md"])

    def test_headings_become_anchors(self):
        self.assertEqual(make_anchor("Six views: what `they` hold"), "six-views-what-they-hold")
