# SPDX-License-Identifier: BSD-3-Clause
"""Checks the links of a built site: check_links.py FOLDER [--external]

Every link and picture must lead to a file of the folder, and every #fragment to an id on its page. With --external, addresses
on the network are asked for, too."""
import sys
import urllib.error
import urllib.parse
import urllib.request
from html.parser import HTMLParser
from pathlib import Path


class Page(HTMLParser):
    """The ids and the links of a page."""

    def __init__(self, path):
        super().__init__()
        self.ids, self.links = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if value is None:
                continue
            if name == "id" or (tag == "a" and name == "name"):
                self.ids.add(value)
            elif name in ("href", "src"):
                self.links.append((self.getpos()[0], value))


def find_faults(folder):
    """What is wrong, a line each; and the addresses on the network with a page that has them."""
    pages = {path.resolve(): Page(path) for path in sorted(folder.rglob("*.html"))}
    faults, external = [], {}
    for path, page in pages.items():
        for line, link in page.links:
            parts = urllib.parse.urlsplit(link)
            here = f"{path.relative_to(folder.resolve())}:{line}"
            if parts.scheme in ("http", "https"):
                external.setdefault(urllib.parse.urldefrag(link)[0], here)
                continue
            if parts.scheme or parts.netloc:
                continue
            target = path
            if parts.path:
                target = (path.parent / urllib.parse.unquote(parts.path)).resolve()
                if target.is_dir():
                    target /= "index.html"
            if not target.is_file():
                faults.append(f"{here}: {link} leads to no file")
            elif parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].ids:
                faults.append(f"{here}: {link} leads to no place on its page")
    return len(pages), sum(len(page.links) for page in pages.values()), faults, external


def ask(address):
    """None, or why the address cannot be had."""
    request = urllib.request.Request(address, headers={"User-Agent": "Mozilla/5.0 (check of links)"})
    try:
        with urllib.request.urlopen(request, timeout=20):
            return None
    except (urllib.error.URLError, OSError) as error:
        return str(error)


def main():
    folder = Path(sys.argv[1])
    pages, links, faults, external = find_faults(folder)
    if "--external" in sys.argv:
        for address, here in external.items():
            why = ask(address)
            if why is not None:
                faults.append(f"{here}: {address}: {why}")
    for fault in faults:
        print(fault, file=sys.stderr)
    asked = "asked for" if "--external" in sys.argv else "not asked for"
    print(f"{pages} pages, {links} links, {len(external)} of other sites {asked}: {len(faults)} lead nowhere")
    return 1 if faults or pages == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
